"""Competitors against truths that they can reach, and their parts against the renderer and against integrals."""

from __future__ import annotations

import convex_head
import drjit as dr
import mitsuba as mi
import numpy as np
import pytest

import unshade
from unshade._native import read_exr
from unshade.errors import SolveError
from unshade.methods import binary_patterns, flash_only, light_stage, method, path_traced, sh_lambert
from unshade.methods.harmonics import harmonics, irradiance
from unshade.methods.laboratory import Laboratory
from unshade.methods.skin_lobes import everywhere, normal_between
from unshade.methods.texel_samples import sample_texels
from unshade.render.skin_bsdf import F0
from unshade.render.truth_scene import captured_scene


@pytest.fixture(scope="module")
def smooth(tmp_path_factory: pytest.TempPathFactory) -> unshade.Capture:
    """Colours alone on a convex head, in even light."""
    folder = tmp_path_factory.mktemp("smooth")
    scene = convex_head.write_scene(folder, size=64, samples=128, views=3, specular=0.028, waves=0)
    return unshade.synth(scene, folder / "capture")


@pytest.fixture(scope="module")
def wavy(tmp_path_factory: pytest.TempPathFactory) -> unshade.Capture:
    """Normals that the mesh lacks, in small noisy pictures."""
    folder = tmp_path_factory.mktemp("wavy")
    return unshade.synth(convex_head.write_scene(folder, size=64, samples=32, views=4), folder / "capture")


def quality(capture: unshade.Capture, maps: unshade.Maps, subject: str, metric: str, scale: str = "none") -> float:
    value = unshade.score(capture, maps).value(
        subject=subject, metric=metric, scale=scale, label=None, region="coverage-e5"
    )
    assert value is not None
    return value


def laboratory(capture: unshade.Capture) -> Laboratory:
    return Laboratory(captured_scene(capture.path), lambda *_: None)


def test_harmonics_are_orthonormal_and_shade_as_the_cosine_integral_says() -> None:
    random = np.random.default_rng(0)
    towards = random.normal(size=(100_000, 3))
    towards /= np.linalg.norm(towards, axis=1, keepdims=True)
    basis = harmonics(towards, 4)
    np.testing.assert_allclose(4 * np.pi * basis.T @ basis / len(basis), np.eye(25), atol=0.03)
    normal = towards[0]
    shaded = 4 * (basis * (towards @ normal).clip(0)[:, None]).mean(0)
    np.testing.assert_allclose(irradiance(normal, 4), shaded, atol=0.01)


def test_highlights_in_light_from_everywhere_are_those_of_the_renderers_material() -> None:
    grey = {"type": "rgb", "value": [0.0, 0.0, 0.0]}
    skin = mi.load_dict({"type": "skin", "diffuse": grey, "specular": {"type": "uniform", "value": F0}})
    context = mi.BSDFContext()
    random = np.random.default_rng(1)
    count = 200_000
    numbers = [mi.Float(row) for row in random.random((3, count), dtype=np.float32)]
    for cosine in (0.95, 0.7, 0.4):
        si = dr.zeros(mi.SurfaceInteraction3f)
        view = np.array([np.sqrt(1 - cosine**2), 0, cosine])
        si.wi, si.n, si.sh_frame = (
            mi.Vector3f(*map(float, view)),
            mi.Normal3f(0, 0, 1),
            mi.Frame3f(mi.Vector3f(0, 0, 1)),
        )
        sample, weight = skin.sample(context, si, numbers[0], mi.Point2f(numbers[1], numbers[2]))
        weight = np.broadcast_to(np.array(weight)[0], count)
        np.testing.assert_allclose(everywhere(np.array(cosine)), weight.mean(), rtol=0.02)
        mean = (np.array(sample.wo) * weight).sum(1)
        found = normal_between(view, mean / np.linalg.norm(mean))
        assert np.degrees(np.arccos(found[2])) < 0.5, cosine


def test_a_texel_is_found_where_the_views_show_it(smooth: unshade.Capture) -> None:
    texels = sample_texels(smooth, 32)
    positions = [np.nan_to_num(smooth.gbuffer(name)["positions"]) for name in smooth.train]
    seen = texels.weights > 0
    assert 0.5 < texels.seen.mean() < 1
    error = np.linalg.norm(texels.colours(positions) - texels.points, axis=-1)[seen]
    assert np.median(error) < 5e-4 and error.max() < 5e-3


@pytest.mark.heavy
def test_the_light_stage_reaches_an_opaque_truth(wavy: unshade.Capture) -> None:
    """Half of the normals within 1 degree, and the albedo within 45 dB."""
    maps = light_stage.recover(wavy, laboratory(wavy), texture_size=64, shadows=False, samples=512)
    assert quality(wavy, maps, "diffuse_albedo", "psnr_srgb") > 45
    assert quality(wavy, maps, "diffuse_normal", "normal_median_deg") < 1
    assert quality(wavy, maps, "specular_normal", "normal_median_deg") < 1
    assert quality(wavy, maps, "mesh_specular_normal", "normal_median_deg") > 4
    assert quality(wavy, maps, "specular_albedo", "rmse") < 0.003


@pytest.mark.heavy
def test_binary_patterns_part_the_layers_of_coloured_skin(wavy: unshade.Capture) -> None:
    """Separates the layers without polarisers."""
    maps = binary_patterns.recover(wavy, laboratory(wavy), texture_size=64, samples=256)
    assert quality(wavy, maps, "diffuse_albedo", "psnr_srgb") > 41
    assert quality(wavy, maps, "diffuse_normal", "normal_median_deg") < 1
    assert quality(wavy, maps, "mesh_diffuse_normal", "normal_median_deg") > 4
    assert quality(wavy, maps, "specular_albedo", "rmse") < 0.005


def test_a_known_flash_gives_the_albedo_as_it_is(smooth: unshade.Capture) -> None:
    maps = flash_only.recover(smooth, laboratory(smooth), texture_size=64)
    assert quality(smooth, maps, "diffuse_albedo", "psnr_srgb") > 33
    assert quality(smooth, maps, "specular_albedo", "rmse") < 0.01


@pytest.mark.heavy
def test_path_tracing_reproduces_a_truth_of_its_own_model(smooth: unshade.Capture) -> None:
    fit = path_traced.fit(smooth, texture_size=64, samples=16, basis_steps=10, free_steps=60)
    assert quality(smooth, fit.maps, "diffuse_albedo", "psnr_srgb", "global") > 33
    assert fit.light.shape == (16, 32, 3) and 0.8 < np.percentile(smooth.shading(fit.light), 99) < 1.2
    for (sensor, picture, mask), name in zip(fit.views, smooth.train):
        inside = np.array(mask)[..., 0] > 0
        again = np.array(mi.render(fit.scene, fit.params, sensor=sensor, spp=512, seed=99))
        error = (again - np.array(picture))[inside]
        _, noise = read_exr(
            smooth.path / "truth" / "layers" / f"{name}.exr", ["variance.R", "variance.G", "variance.B"]
        )
        assert np.sqrt((error**2).mean()) < 2 * np.sqrt(noise[inside].mean())


@pytest.mark.parametrize("shadows", [False, True])
def test_even_light_is_found_and_divided_out(smooth: unshade.Capture, shadows: bool) -> None:
    """The remaining error is that of highlights, which the model lacks."""
    maps, light = sh_lambert.recover(smooth, texture_size=64, shadows=shadows)
    assert quality(smooth, maps, "diffuse_albedo", "psnr_srgb", "global") > 25
    # As all lights here, it shades a white front with 1 at most.
    assert light.shape == (16, 32, 3) and 0.8 < np.percentile(smooth.shading(light, texture_size=64), 99) < 1.3


def test_unknown_settings_are_named() -> None:
    assert method("sh-lambert", {"order": 3}) is sh_lambert.recover
    with pytest.raises(SolveError, match="sh-lambert: unknown setting 'ordre'; there are order, shadows, texture_size"):
        method("sh-lambert", {"ordre": 3})

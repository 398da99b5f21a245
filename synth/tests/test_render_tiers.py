"""Subsurface tiers against what is known of a half space, and against each other's exact limits."""

import dataclasses
import sys
import weakref
from pathlib import Path

import drjit as dr
import igl
import mitsuba as mi
import numpy as np
import pytest
import render_toy

sys.path.append(str(Path(__file__).resolve().parents[1] / "bench"))
import half_space

from unshade.camera.camera import Camera, look_at
from unshade.errors import SceneError
from unshade.face import Chart
from unshade.render import lights, tiers
from unshade.render.scene import ChartMaps, HeadScene
from unshade.render.split import LambertLight
from unshade.render.tiers import body, gather, irradiance, profile, surface
from unshade.render.tiers.surface import Mesh, SkinPoints
from unshade.render.tiers.walk import walk
from unshade.scene_file import Render
from unshade.scene_file.render import SKIN1_MM, parse_render

FACE = render_toy.toy_face()
TRUTH = ChartMaps.truth(FACE)
CAMERA = Camera("000", 24, 24, 48.0, look_at(np.array([0.2, 0.1, 0.45]), np.zeros(3)), True)
RENDER = Render(24, 24, samples=16, depth=4, tier="diffusion")


@pytest.fixture(autouse=True)
def coarse(monkeypatch):
    """Fewer points on the chart, for speed."""
    monkeypatch.setattr(surface, "TEXEL", 2.5e-3)


def toy_head(maps=TRUTH):
    return HeadScene(FACE.chart, FACE.parts, maps)


def draw(head, lit, render=RENDER, seed=1, **options):
    return tiers.render_tier(head, lit, CAMERA.sensor(render.samples), render, seed, **options)


@pytest.mark.parametrize("albedo", [0.15, 0.4, 0.7])
def test_profile_is_that_of_photons_in_the_mediums_half_space(albedo):
    alpha = float(profile.single_scattering(albedo))
    distance, weight = half_space.searchlight(alpha, 60_000, 1)
    assert weight.sum() == pytest.approx(half_space.diffuse_albedo(alpha), abs=0.005)
    d = profile.scale_radius(1.0, albedo)
    for r in (0.5, 1.0, 2.0, 4.0):
        # Christensen and Burley state errors of their fit of a few percent.
        assert weight[distance < r].sum() / weight.sum() == pytest.approx(float(profile.within(r, d)), abs=0.025)


@pytest.mark.parametrize("albedo", [0.05, 0.2, 0.5, 0.9])
def test_medium_shows_the_albedo_asked_for(albedo):
    alpha = float(profile.single_scattering(albedo))
    assert half_space.diffuse_albedo(alpha) == pytest.approx(albedo, rel=0.03)


def test_profile_integrates_to_one():
    edges = np.geomspace(1e-6, 60, 200_001)
    r = (edges[1:] + edges[:-1]) / 2
    rings = profile.density(r, 1.3) * 2 * np.pi * r * np.diff(edges)
    assert rings.sum() == pytest.approx(1, abs=1e-4)
    assert rings[r < 2].sum() == pytest.approx(float(profile.within(2.0, 1.3)), abs=1e-4)
    assert float(profile.within(profile.REACH, 1.0)) == pytest.approx(0.99, abs=0.001)


class EvenAlbedo:
    def __init__(self, value):
        self.value = value

    def albedo(self, p):
        return mi.Color3f(*self.value)


@pytest.mark.parametrize("way", LambertLight)
def test_walks_in_a_slab_are_chandrasekhars(way):
    """Even light, sampled in each way, on a slab a hundred free paths thick."""
    block = mi.load_dict(
        {"type": "cube", "to_world": mi.ScalarTransform4f().scale([0.2, 0.05, 0.2]).translate([0, -1, 0])}
    )
    scene = mi.load_dict({"type": "scene", "block": block, "light": {"type": "constant", "radiance": 1.0}})
    albedo = (0.2, 0.45, 0.7)
    lanes = 60_000
    sampler = mi.load_dict({"type": "independent"})
    sampler.seed(3, lanes)
    for mu in (1.0, 0.3):
        across = float(np.sqrt(1 - mu * mu))
        ray = mi.Ray3f(mi.Point3f(-0.1 * across, 0.1 * mu, 0), mi.Vector3f(across, -mu, 0))
        si = scene.ray_intersect(ray, dr.full(mi.Bool, True, lanes))
        extinction = [dr.opaque(mi.Float, 1000.0)] * 3
        found = np.array(
            walk(scene, mi.ShapePtr(block), EvenAlbedo(albedo), extinction, sampler, si, ray.d, si.is_valid(), way)
        )
        error = found.std(1) / np.sqrt(lanes)
        exact = [half_space.radiance_under_even_light(float(profile.single_scattering(a)), mu)[0] for a in albedo]
        assert (error < 0.006).all()
        assert (np.abs(found.mean(1) - exact) < 4 * error + 1e-4).all(), (found.mean(1), exact)


def plane(edge=0.04, steps=9):
    """A flat chart of ``edge`` metres, facing +Z."""
    u, v = (a.ravel() for a in np.meshgrid(*[np.linspace(0, 1, steps)] * 2))
    corner = (np.arange(steps - 1)[:, None] * steps + np.arange(steps - 1)).ravel()
    a, b, c, d = corner, corner + 1, corner + steps, corner + steps + 1
    triangles = np.concatenate([np.stack([a, b, d], 1), np.stack([a, d, c], 1)]).astype(np.uint32)
    positions = np.stack([(u - 0.5) * edge, (v - 0.5) * edge, 0 * u], 1).astype(np.float32)
    normals = np.repeat([[0, 0, 1]], len(u), 0).astype(np.float32)
    return Chart(positions, normals, np.stack([u, v], 1).astype(np.float32), triangles)


def test_light_on_one_texel_spreads_as_the_profile(monkeypatch):
    monkeypatch.setattr(surface, "TEXEL", 0.5e-3)
    head = HeadScene(plane(), [], ChartMaps(np.full((2, 2, 3), 0.5, np.float32)))
    points = SkinPoints.of(head)
    assert points.areas.sum() == pytest.approx(0.04**2, rel=1e-4)
    albedo = points.albedo(head)
    spot = np.linalg.norm(points.positions, axis=1).argmin()
    light = np.zeros((len(albedo), 1, 3), np.float32)
    light[spot] = 1
    path = np.array([2e-3, 1e-3, 1e-3])
    blurred = gather.blur(light, points, albedo, path, np.ones(len(albedo), bool))
    r = np.linalg.norm(points.positions - points.positions[spot], axis=1)
    middle = np.linalg.norm(points.positions, axis=1) < 0.003
    # Flat skin needs no scaling: what the reach leaves out, and what the texels do.
    assert (np.abs(blurred.raw_sum[middle] - 1) < 0.05).all()
    for c in range(3):
        d = profile.scale_radius(path[c], 0.5)
        ring = (r > 1e-3) & (r < 6 * d)
        expected = profile.density(r[ring], d) * points.areas[spot]
        assert blurred.irradiance[ring, 0, c] == pytest.approx(expected / blurred.raw_sum[ring, c], rel=1e-3)
        # Nothing is lost: the rings sum to one.
        assert blurred.irradiance[:, 0, c].sum() == pytest.approx(1, abs=0.03)


def test_even_irradiance_stays_even_on_a_curved_head():
    head = toy_head()
    points = SkinPoints.of(head)
    light = np.full((len(points.positions), 2, 3), 0.7, np.float32)
    blurred = gather.blur(light, points, points.albedo(head), np.array(SKIN1_MM) * 1e-3, np.ones(len(light), bool))
    assert blurred.irradiance == pytest.approx(light, rel=1e-5)


def test_white_furnace():
    """A plane in even light shows its albedo; a white head neither makes nor loses light."""
    white = ChartMaps(np.ones((2, 2, 3), np.float32))
    flat = HeadScene(plane(), [], white)
    points = SkinPoints.of(flat)
    found = irradiance.bake(flat.lit(lights.Dome(1.0)), points, bakes=4, samples=4, depth=4, seed=1)
    assert found == pytest.approx(np.full_like(found, np.pi), rel=1e-5)
    matte = [part for part in FACE.parts if part.uv is None]
    grey = [dataclasses.replace(part, diffuse=np.ones_like(part.diffuse), specular=0 * part.specular) for part in matte]
    head = HeadScene(FACE.chart, grey, white)
    points = SkinPoints.of(head)
    found = irradiance.bake(head.lit(lights.Dome(1.0)), points, bakes=4, samples=16, depth=40, seed=1)
    front = points.positions[:, 2] > 0.02
    assert found[front].mean() / np.pi == pytest.approx(1, abs=0.02)


@pytest.mark.parametrize("tier", ["diffusion", "volume"])
def test_equal_seeds_give_equal_bytes_and_the_opaque_highlights(tier):
    render = dataclasses.replace(RENDER, tier=tier)
    pictures = []
    for _ in range(2):
        head = toy_head()
        pictures.append(draw(head, head.lit(lights.studio().scaled(8.0)), render))
    first, again = pictures
    for layer in ("diffuse", "specular", "variance"):
        assert (getattr(first, layer) == getattr(again, layer)).all()
    opaque = draw(head, head.lit(lights.studio().scaled(8.0)), dataclasses.replace(render, tier="opaque"))
    assert (first.specular == opaque.specular).all()
    assert (first.diffuse != opaque.diffuse).any()
    assert (first.total == first.diffuse + first.specular).all()
    assert (first.diffuse[0, 0] == 0).all()


def test_long_blur_keeps_the_light_and_short_blur_the_picture():
    """With a vanishing path the profile is a point: the opaque picture comes back."""
    head = toy_head()
    lit = head.lit(lights.studio().scaled(8.0))
    tiny, opaque = (
        draw(head, lit, dataclasses.replace(RENDER, samples=64, tier=tier, subsurface_mm=(1e-3,) * 3))
        for tier in ("diffusion", "opaque")
    )
    variance = (tiny.variance + opaque.variance).sum()
    difference = (tiny.total - opaque.total).sum()
    # Texels of 2.5 mm round the edges of shadows; over the picture that must cancel.
    assert abs(difference) < 4 * np.sqrt(variance) + 0.01 * opaque.total.sum()


def test_views_share_a_bake_until_the_albedo_changes(monkeypatch):
    bakes = []
    monkeypatch.setattr(irradiance, "bake", lambda *a, kept=irradiance.bake, **k: bakes.append(1) or kept(*a, **k))
    head = toy_head()
    lit = head.lit(lights.studio().scaled(8.0))
    first = draw(head, lit, seed=1)
    draw(head, lit, seed=2)
    assert len(bakes) == 1
    half = TRUTH.diffuse_albedo / 2
    head.set_diffuse_albedo(half)
    changed = draw(head, lit, seed=1)
    assert len(bakes) == 2
    fresh = toy_head(dataclasses.replace(TRUTH, diffuse_albedo=half))
    expected = draw(fresh, fresh.lit(lights.studio().scaled(8.0)), seed=1)
    assert (changed.total == expected.total).all() and (changed.total != first.total).any()
    gone = weakref.ref(lit)
    del lit
    assert gone() is None


def test_variance_counts_the_noise_of_the_bake():
    """Close to the skin, where a pixel is smaller than a texel and the bake makes all the noise."""
    camera = Camera("close", 16, 16, 400.0, look_at(np.array([0.1, 0.05, 0.45]), np.array([0.02, -0.05, 0.08])), True)
    head = toy_head(dataclasses.replace(TRUTH, specular_albedo=None))
    lit = head.lit(lights.studio().scaled(8.0))
    own, shared = (
        [tiers.render_tier(head, lit, camera.sensor(16), RENDER, seed, shared_seed=seed * own) for seed in range(8)]
        for own in (1, 0)
    )
    measured, alike = (np.stack([run.total for run in runs]).var(0, ddof=1).mean() for runs in (own, shared))
    assert np.mean([run.variance.mean() for run in own]) == pytest.approx(measured, rel=0.25)
    # Pictures that share a bake do not show it among each other, but state it none the less.
    assert alike < 0.5 * measured
    assert np.mean([run.variance.mean() for run in shared]) == pytest.approx(measured, rel=0.35)


def box(drop=(), flip=()):
    vertices = np.array(np.meshgrid([0, 1], [0, 1], [0, 1])).reshape(3, -1).T.astype(np.float32)
    from scipy.spatial import ConvexHull

    hull = ConvexHull(vertices)
    triangles = hull.simplices.copy()
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    inward = (np.cross(b - a, c - a) * hull.equations[:, :3]).sum(1) < 0
    triangles[inward] = triangles[inward][:, ::-1]
    for k in flip:
        triangles[k] = triangles[k][::-1]
    return vertices, np.delete(triangles, list(drop), 0)


def enclosed(closed):
    a, b, c = (closed.vertices[closed.triangles[:, k]].astype(float) for k in range(3))
    return (a * np.cross(b, c)).sum() / 6


def test_parts_are_welded_and_open_rims_capped():
    vertices, triangles = box()
    halves = [
        Mesh(name, vertices, vertices, triangles[part]) for name, part in (("a", slice(0, 5)), ("b", slice(5, 12)))
    ]
    closed = body.close(halves)
    assert len(closed.vertices) == 8 and enclosed(closed) == pytest.approx(1)
    vertices, triangles = box(drop=[0])
    capped = body.close([Mesh("open", vertices, vertices, triangles)])
    assert enclosed(capped) == pytest.approx(1) and len(capped.triangles) == 14
    vertices, triangles = box(flip=[3])
    with pytest.raises(SceneError, match="needs a closed head"):
        body.close([Mesh("flipped", vertices, vertices, triangles)])


def test_a_finer_raised_chart_is_joined_to_coarse_parts():
    """One side of the box, cut finer and raised by a pyramid: the volume is the box's and the pyramid's."""
    vertices, triangles = box()
    front = (vertices[triangles][:, :, 2] == 1).all(1)
    fine, cut = igl.upsample(vertices.astype(float), triangles[front].astype(np.int64), 3)
    used, cut = np.unique(cut, return_inverse=True)
    fine = fine[used]
    fine[:, 2] += 0.5 * np.minimum(fine[:, :2], 1 - fine[:, :2]).min(1)
    chart = Mesh("chart", fine.astype(np.float32), fine, cut.reshape(-1, 3))
    closed = body.close([chart, Mesh("rest", vertices, vertices, triangles[~front])])
    # A third of its height of 0.25; the cut follows one diagonal alone.
    assert enclosed(closed) == pytest.approx(1 + 0.25 / 3, rel=2e-3)


def test_a_variant_without_compiler_is_refused(monkeypatch):
    head = toy_head()
    lit = head.lit(lights.Dome(1.0))
    monkeypatch.setattr(tiers.dr, "is_jit_v", lambda kind: False)
    with pytest.raises(SceneError, match='tier = "diffusion" in .* needs the variant llvm_ad_rgb; install karellen'):
        draw(head, lit)


def table(**render):
    return parse_render({"width": 64, "height": 64, **render}, "[render]")


def test_scene_files_name_the_tier():
    assert set(table().to_table()) == {"width", "height", "samples", "depth", "seed", "variant"}
    render = table(tier="volume", subsurface_mm=[2, 1.0, 0.5])
    assert render.subsurface_mm == (2.0, 1.0, 0.5) and parse_render(render.to_table(), "again") == render
    assert table(tier="diffusion").subsurface_mm == SKIN1_MM


@pytest.mark.parametrize(("keys", "message"), [
    ({"tier": "bssrdf"}, "use one of opaque, diffusion, volume"),
    ({"tier": "volume", "subsurface_mm": [1, 2]}, "three numbers"),
    ({"tier": "volume", "subsurface_mm": [1, 0, 2]}, "three numbers"),
    ({"tier": "volume", "subsurface_mm": [1, 1, float("nan")]}, "three numbers"),
    ({"tier": "volume", "subsurface_mm": 1.0}, "three numbers"),
    ({"subsurface_mm": [1, 1, 1]}, "means nothing"),
    ({"tier": "volume", "variant": "scalar_rgb"}, "needs LLVM"),
])  # fmt: skip
def test_wrong_tiers_are_refused(keys, message):
    with pytest.raises(SceneError, match=message):
        table(**keys)

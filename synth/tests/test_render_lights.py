"""Lights: exposure measured in pictures, lat-long conventions against Mitsuba's own."""

import math

import numpy as np
import pytest
import render_toy  # isort: skip  (sets the variant, before drjit is imported)
import drjit as dr
import mitsuba as mi

from unshade.errors import PictureError, SceneError
from unshade.render import lights
from unshade.render.passes import render_layers
from unshade.render.pictures import write_exr
from unshade.render.camera import Camera, look_at
from unshade.render.scene import ChartMaps, HeadScene
from unshade.scene_file import Light

FACE = render_toy.toy_face()


def picture_of(tmp_path, height=16, width=32):
    """A lat-long picture with one bright, coloured spot and some negatives."""
    picture = np.full((height, width, 3), 0.3, np.float32)
    picture[5, 20] = [60, 40, 20]
    picture[1, 1] = -0.5
    write_exr(tmp_path / "sky.exr", {"": picture})
    return str(tmp_path / "sky.exr"), picture


def light(kind, tmp_path, **keys):
    path = picture_of(tmp_path)[0] if kind == "envmap" else None
    return Light(name=kind, kind=kind, path=path, **keys)


@pytest.mark.parametrize("kind", ["dome", "studio", "flash", "envmap"])
def test_a_white_face_is_just_well_exposed(kind, tmp_path):
    """The brightest pixel of a white Lambert face without its bounces is exposure x 1:
    the largest irradiance is pi. A ball of all normals takes the face's place."""
    theta, phi = np.meshgrid(np.linspace(1e-3, math.pi - 1e-3, 49), np.linspace(0, 2 * math.pi, 97), indexing="ij")
    n = np.stack([np.sin(theta) * np.sin(phi), np.cos(theta), np.sin(theta) * np.cos(phi)], -1).reshape(-1, 3)
    corner = (np.arange(48)[:, None] * 97 + np.arange(96)).ravel()
    triangles = np.concatenate([
        np.stack([corner, corner + 97, corner + 98], 1), np.stack([corner, corner + 98, corner + 1], 1),
    ]).astype(np.uint32)  # fmt: skip
    points = (0.1 * n).astype(np.float32)
    ball = render_toy.Chart(points, n.astype(np.float32), np.zeros((len(n), 2), np.float32), triangles)
    head = HeadScene(ball, [], ChartMaps(np.ones((2, 2, 3), np.float32)))
    model = lights.exposed(light(kind, tmp_path, exposure=0.5), points, n)
    brightest = 0.0
    for x in (-0.35, 0.0, 0.35):
        camera = Camera("000", 48, 48, 100.0, look_at(np.array([x, 0.2, 0.4]), np.zeros(3)), True)
        layers = render_layers(head.lit(model), camera.sensor(256), samples=256, depth=2, seed=1)
        assert layers.specular.max() < 1e-6
        front = layers.total @ lights.LUMINANCE
        # Means of 3 x 3 pixels, lest noise be taken for brightness.
        brightest = max(brightest, front.reshape(16, 3, 16, 3).mean((1, 3)).max())
    assert brightest == pytest.approx(0.5, rel=0.02)


@pytest.mark.parametrize("kind", ["dome", "studio", "envmap"])
def test_the_latlong_picture_shows_the_light(kind, tmp_path):
    """Rendered as an environment map, the lat-long picture lights the head's centre as
    the light itself does."""
    model = lights.exposed(light(kind, tmp_path), FACE.chart.vertices, FACE.chart.normals)
    as_map = lights.Environment(model.latlong())
    normals = np.concatenate([np.eye(3), -np.eye(3), np.ones((1, 3)) / math.sqrt(3)])
    centre = np.zeros_like(normals)
    np.testing.assert_allclose(
        as_map.irradiance(centre, normals), model.irradiance(centre, normals), rtol=0.02, atol=0.02
    )


def test_directions_are_mitsubas(tmp_path):
    """A texel lies where Mitsuba's environment map puts it."""
    model = lights.environment(light("envmap", tmp_path))
    directions, _ = lights._directions(16, 32, 1)
    scene = mi.load_dict({"type": "scene", **model.emitters()})
    d = mi.Vector3f(np.ascontiguousarray(directions.reshape(-1, 3).T, dtype=np.float32))
    si = dr.zeros(mi.SurfaceInteraction3f, 16 * 32)
    si.wi = -d
    seen = np.array(scene.environment().eval(si)).T.reshape(16, 32, 3)
    np.testing.assert_allclose(seen, model.picture, rtol=2e-3, atol=2e-3)


def test_irradiance_of_an_environment_is_mitsubas(tmp_path):
    model = lights.environment(light("envmap", tmp_path))
    emitter = mi.load_dict({"type": "scene", **model.emitters()}).environment()
    count = 1 << 20
    sampler = mi.load_dict({"type": "independent"})
    sampler.seed(3, count)
    si = dr.zeros(mi.SurfaceInteraction3f, count)
    sample, weight = emitter.sample_direction(si, sampler.next_2d())
    for normal in np.eye(3):
        cosine = dr.fmax(dr.dot(sample.d, mi.Vector3f(*normal.tolist())), 0)
        measured = np.array(dr.mean(weight * cosine, axis=1)).ravel()
        own = model.irradiance(np.zeros((1, 3)), normal[None])[0]
        np.testing.assert_allclose(own, measured, rtol=0.02)


def test_turning_moves_light_from_front_to_left_hand(monkeypatch):
    """+90 degrees about +Y take what was at +Z to +X."""
    picture = np.zeros((9, 16, 3), np.float32)
    picture[4, 7:9] = 1  # around phi = pi: +Z
    front = lights.Environment(picture)
    monkeypatch.setattr(lights, "read_rgb", lambda path: picture)
    turned = lights.environment(Light("e", "envmap", path="x", rotation_degrees=90.0))
    axes = np.eye(3)
    at = np.zeros((3, 3))
    assert front.irradiance(at, axes)[:, 0].argmax() == 2
    assert turned.irradiance(at, axes)[:, 0].argmax() == 0
    assert turned.picture.sum() == pytest.approx(picture.sum())


def test_negatives_and_clamp(tmp_path):
    model = lights.environment(light("envmap", tmp_path, clamp=10.0))
    assert model.picture.min() == 0
    assert model.picture.max() == 10


def test_lights_that_cannot_shine_are_named(tmp_path):
    write_exr(tmp_path / "black.exr", {"": np.zeros((8, 16, 3), np.float32)})
    with pytest.raises(SceneError, match="black.exr.*black"):
        lights.environment(Light("e", "envmap", path=str(tmp_path / "black.exr")))
    (tmp_path / "broken.exr").write_bytes(b"no picture")
    with pytest.raises(PictureError, match="broken.exr: cannot be read"):
        lights.environment(Light("e", "envmap", path=str(tmp_path / "broken.exr")))

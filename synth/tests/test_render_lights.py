"""Lights: exposure measured in pictures, lat-long conventions against Mitsuba's own."""

import math
from pathlib import Path

import drjit as dr
import mitsuba as mi
import numpy as np
import pytest
import render_toy

from unshade.camera.camera import Camera, look_at
from unshade.errors import PictureError, SceneError
from unshade.files.pictures import read_light, write_exr
from unshade.render import lights
from unshade.render.lights import envmap
from unshade.render.lights.conventions import around, directions, solid_angles
from unshade.render.passes import render_layers
from unshade.render.scene import ChartMaps, HeadScene
from unshade.scene_file import LIGHT_KINDS, Light
from unshade.scene_file.light import Gradient, KeyLight, Pattern, PointLight, Sun, TwoColours

FACE = render_toy.toy_face()
SCENES = Path(__file__).parents[2] / "scenes"


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


PLAIN = ["dome", "studio", "flash", "envmap"]
"""Kinds without settings of their own."""


@pytest.mark.parametrize("kind", PLAIN)
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


@pytest.mark.parametrize("kind", ["dome", "studio", "envmap", "key", "two-colour", "point"])
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
    towards, _ = directions(16, 32, 1)
    scene = mi.load_dict({"type": "scene", **model.emitters()})
    d = mi.Vector3f(np.ascontiguousarray(towards.reshape(-1, 3).T, dtype=np.float32))
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
    monkeypatch.setattr(envmap, "read_light", lambda path: picture)
    rotated = lights.environment(Light("e", "envmap", path="x", rotation_degrees=90.0))
    axes = np.eye(3)
    at = np.zeros((3, 3))
    assert front.irradiance(at, axes)[:, 0].argmax() == 2
    assert rotated.irradiance(at, axes)[:, 0].argmax() == 0
    assert rotated.picture.sum() == pytest.approx(picture.sum())


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


NORMALS = np.array([[0, 0, 1], [0.6, 0.5, 0.6], [-0.7, -0.6, 0.3]])
NORMALS = NORMALS / np.linalg.norm(NORMALS, axis=1, keepdims=True)
POINTS = 0.1 * NORMALS
SETTINGS = {
    "key": KeyLight(azimuth_degrees=-70, size_metres=0.9),
    "two-colour": TwoColours(),
    "sun": Sun(azimuth_degrees=-50, elevation_degrees=20),
    "point": PointLight(radius_metres=0.01),
    "gradient": Gradient("x+"),
    "stripes": Pattern("stripes", "y+", count=6, inverse=True),
    "hadamard": Pattern("hadamard", "x-", order=16, index=6),
}


def of(name, exposure=1.0):
    """A light of `SETTINGS`, exposed for a ball of three normals."""
    kind = "pattern" if isinstance(SETTINGS[name], Pattern) else name
    return lights.exposed(Light(name, kind, exposure, settings=SETTINGS[name]), POINTS, NORMALS)


def rendered_irradiance(emitters, samples=256):
    """Irradiance [3, 3] as Mitsuba's own integrator sees it: white patches at the points,
    each photographed from close by."""
    found = []
    for normal, point in zip(NORMALS, POINTS):
        side = np.cross(normal, [0.3, 0.9, 0.2])
        side /= np.linalg.norm(side)
        place = np.eye(4)
        place[:3] = np.stack([side * 0.01, np.cross(normal, side) * 0.01, normal, point], 1)
        eye = point + 0.2 * normal + 0.03 * side
        scene = mi.load_dict(
            {
                "type": "scene",
                "integrator": {"type": "direct"},
                "patch": {
                    "type": "rectangle",
                    "to_world": mi.ScalarTransform4f(place),
                    "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": [1.0, 1.0, 1.0]}},
                },
                "sensor": {
                    "type": "perspective",
                    "fov": 1.0,
                    "to_world": mi.ScalarTransform4f().look_at(
                        origin=eye.tolist(), target=point.tolist(), up=side.tolist()
                    ),
                    "film": {"type": "hdrfilm", "width": 8, "height": 8, "rfilter": {"type": "box"}},
                    "sampler": {"type": "multijitter", "sample_count": samples},
                },
                **emitters,
            }
        )
        found.append(math.pi * np.array(mi.render(scene, seed=1)).reshape(-1, 3).mean(0))
    return np.array(found)


@pytest.mark.parametrize("kind", LIGHT_KINDS)
def test_every_kind_has_a_model_and_stands_beside_mitsubas_renders(kind, tmp_path):
    """A kind that a scene may name, but that has no model or no test beside it, fails here."""
    model = lights.exposed(light(kind, tmp_path), POINTS, NORMALS)
    assert model.irradiance(POINTS, NORMALS).shape == (3, 3) and model.latlong().shape[2] == 3
    assert model.emitters() and (model.brightest() > 0).any()
    rendered = {"pattern" if isinstance(settings, Pattern) else name for name, settings in SETTINGS.items()}
    assert kind in {*PLAIN, *rendered}


@pytest.mark.parametrize("name", SETTINGS)
def test_irradiance_is_what_mitsuba_renders(name):
    model = of(name)
    own = model.irradiance(POINTS, NORMALS)
    np.testing.assert_allclose(rendered_irradiance(model.emitters()), own, atol=0.004 * own.max())


def test_the_sun_is_the_plugins_turned_upright():
    """Against the plugin itself, turned by Mitsuba's own transform, black below the horizon."""
    settings = Sun(azimuth_degrees=30, elevation_degrees=25, turbidity=4, ground_albedo=0.0)
    model = lights.unexposed(Light("sun", "sun", settings=settings))
    plugin = {
        "type": "sunsky",
        "turbidity": 4.0,
        "albedo": 0.0,
        "sun_direction": around(30, 25, 1.0).tolist(),
        # Its z becomes our y, its y our -z; the sun's direction is the world's.
        "to_world": mi.ScalarTransform4f().rotate([1, 0, 0], -90),
    }
    own = model.irradiance(POINTS, NORMALS)
    np.testing.assert_allclose(rendered_irradiance({"sunsky": plugin}, 1024), own, atol=0.01 * own.max())
    sky = model.latlong()
    row, column = np.unravel_index(sky.sum(-1).argmax(), sky.shape[:2])
    towards, _ = directions(*sky.shape[:2], 1)
    assert towards[row, column] @ around(30, 25, 1.0) > np.cos(np.radians(1))
    assert not sky[towards[..., 1] < -0.01].any()


def test_the_ground_returns_a_share_of_what_falls_on_it():
    model = lights.unexposed(Light("sun", "sun", settings=Sun(ground_albedo=0.4)))
    up, down = model.irradiance(np.zeros((2, 3)), np.array([[0.0, 1.0, 0.0], [0.0, -1.0, 0.0]]))
    np.testing.assert_allclose(down, 0.4 * up, rtol=0.01)


def test_gradients_are_those_of_the_formula():
    """E(n) = pi/2 + pi/3 n.x for (1 + d.x)/2; opposite gradients add up to the full sphere."""
    plus, minus, full = (
        lights.exposed(Light("g", "gradient", settings=Gradient(axis)), POINTS, NORMALS)
        for axis in ("x+", "x-", "full")
    )
    at = plus.irradiance(POINTS, NORMALS)
    np.testing.assert_allclose(at, np.repeat((math.pi / 2 + math.pi / 3 * NORMALS[:, :1]), 3, 1), rtol=1e-3)
    np.testing.assert_allclose(at + minus.irradiance(POINTS, NORMALS), full.irradiance(POINTS, NORMALS), rtol=1e-3)
    # Ma et al. 2007: the ratio of a Lambert surface's pictures gives its normal.
    assert full.irradiance(POINTS, NORMALS) == pytest.approx(math.pi)


def sphere_mean(first, second=None):
    """Mean over solid angle of a lat-long picture, or of the product of two."""
    solid = solid_angles(*first.shape[:2])
    return (first * (1 if second is None else second) * solid[:, None]).sum() / (solid.sum() * first.shape[1])


def test_patterns_split_the_sphere_evenly():
    def lit(**keys):
        return lights.unexposed(Light("p", "pattern", settings=Pattern(**keys))).latlong()[..., 0].astype(float)

    for keys in ({"pattern": "stripes", "axis": "z+", "count": 8}, {"pattern": "hadamard", "index": 5}):
        picture = lit(**keys)
        assert sphere_mean(picture) == pytest.approx(0.5, abs=2e-3)
        np.testing.assert_allclose(picture + lit(**keys, inverse=True), 1, atol=1e-6)
    # Rows of a Hadamard matrix: as +1 and -1 they are orthogonal.
    signs = [2 * lit(pattern="hadamard", axis="z+", order=4, index=index) - 1 for index in range(4)]
    gram = np.array([[sphere_mean(a, b) for a in signs] for b in signs])
    # Texels on edges are of neither sign.
    np.testing.assert_allclose(gram, np.eye(4), atol=0.02)
    towards, _ = directions(*lights.LATLONG, 1)
    half = lit(pattern="half", axis="y-")
    assert half[towards[..., 1] < -0.02].all() and not half[towards[..., 1] > 0.02].any()


def test_parts_of_a_light_stage_share_its_exposure():
    """However little of the face they reach, a lamp that is on is as bright."""
    for settings in (Pattern("half", "z-"), Pattern("half", "z+"), Pattern("hadamard", index=3)):
        model = lights.exposed(Light("p", "pattern", 0.5, settings=settings), POINTS, NORMALS)
        assert model.brightest() == pytest.approx(0.5)


def test_colours_fall_on_their_own_side():
    model = of("two-colour")
    left, right = model.irradiance(np.zeros((2, 3)), np.array([[1.0, 0.0, 0.2], [-1.0, 0.0, 0.2]]) / math.sqrt(1.04))
    assert left[0] / left[2] == pytest.approx(1 / 0.16, rel=1e-3) and right[0] / right[2] == pytest.approx(
        0.22, rel=1e-3
    )


def test_small_sources_keep_their_energy_and_place_in_the_latlong():
    model = of("point")
    picture = model.latlong()
    d = 1.0
    solid = 2 * math.pi * (1 - math.sqrt(1 - (0.01 / d) ** 2))
    assert sphere_mean(picture[..., 0].astype(float)) * 4 * math.pi == pytest.approx(model.radiance * solid, rel=1e-3)
    towards, _ = directions(*lights.LATLONG, 1)
    weights = picture[..., 0] * solid_angles(*lights.LATLONG)[:, None]
    mean = (towards * weights[..., None]).sum((0, 1))
    assert mean / np.linalg.norm(mean) @ around(-35, 25, 1.0) > np.cos(np.radians(0.2))


SKIES = {"courtyard": 98, "interior": 33_126, "photo-studio": 435, "sunrise": 67_366}


@pytest.mark.parametrize("name", SKIES)
def test_photographed_skies_come_along_as_half_floats(name):
    """Largest over mean luminance tells them apart; the sun of ``sunrise`` is sharp."""
    picture = read_light(SCENES / "lights" / f"{name}.exr")
    assert picture.shape == (512, 1024, 3) and (picture.astype(np.float16) == picture).all()
    luminance = picture @ lights.LUMINANCE
    assert luminance.max() / luminance.mean() == pytest.approx(SKIES[name], rel=0.01)

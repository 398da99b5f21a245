"""What `--describe` says of a scene, against formulas and an independent library."""

import math
import re

import colour
import numpy as np
import pytest
import render_toy

from unshade.render import describe as module
from unshade.render import lights
from unshade.render.colour_temperature import correlated_kelvin
from unshade.render.describe import describe, mean_radiance
from unshade.scene_file import parse_scene

FACE = render_toy.toy_face()


@pytest.fixture(scope="module")
def described():
    monkeypatch = pytest.MonkeyPatch()
    monkeypatch.setattr(module, "build_head", lambda spec: FACE)
    table = render_toy.toy_table() | {
        "relight": [
            {"name": "uniform", "kind": "dome", "exposure": 0.5},
            {"name": "sky", "kind": "sun", "ground_albedo": 0.0},
            {"name": "warm", "kind": "two-colour", "left": [1.0, 0.5, 0.2], "right": [1.0, 0.5, 0.2]},
            {"name": "x", "kind": "gradient", "axis": "x+"},
        ],
    }
    yield describe(parse_scene(table, "scene", None))
    monkeypatch.undo()


def row(text: str, name: str) -> list[str]:
    (line,) = [line for line in text.splitlines() if re.match(rf"  {name} ", line)]
    return re.split(r"\s{2,}", line.strip())


def test_lights_are_described(described):
    # name, use, kind, mean, maximum, ratio, colour, temperature, irradiance
    dome = row(described, "uniform")
    assert dome[1:3] == ["relit", "dome"] and dome[3:6] == ["0.5", "0.5", "1"] and dome[6] == "1.000:1.000:1.000"
    assert dome[7] == "6505 K" or abs(int(dome[7].split()[0]) - 6504) < 15
    assert dome[8] == "0.500 pi"
    assert row(described, "studio")[1] == "capture" and row(described, "studio")[8] == "1.000 pi"
    assert row(described, "warm")[6] == "2.000:1.000:0.400"
    gradient = row(described, "x")
    assert gradient[3:5] == ["0.5", "1"]
    sun = row(described, "sky")
    assert float(sun[5]) > 1e4 and int(sun[7].split()[0]) in range(4500, 9000)


def test_faults_of_the_solvers_inputs_are_described(described, monkeypatch):
    for part in ("image formation", "mesh", "labels"):
        assert row(described, part)[1] == "perfect"
    monkeypatch.setattr(module, "build_head", lambda spec: FACE)
    faults = {"labels": {"boundary_error": 0.1}, "captured_mesh": {"smoothing_mm": 2.0}}
    text = describe(parse_scene(render_toy.toy_table() | faults, "scene", None))
    assert row(text, "labels")[1] == "10 % of the boundary pixels have the label of the other side"
    assert row(text, "mesh")[1] == "smoothing_mm 2" and row(text, "image formation")[1] == "perfect"
    for faults, expected in (
        ({"omit": True}, "none"),
        ({"one": True}, "one for everything"),
        ({"hair_is_skin": True}, "hair is called skin"),
    ):
        assert (
            row(describe(parse_scene(render_toy.toy_table() | {"labels": faults}, "scene", None)), "labels")[1]
            == expected
        )


def test_cameras_and_sizes_are_described(described):
    assert row(described, "003")[1] == "withheld" and row(described, "000")[1] == "training"
    # 25 degrees across the shorter side of 40 x 32 pixels.
    wide = math.degrees(2 * math.atan(40 / 32 * math.tan(math.radians(12.5))))
    assert row(described, "000")[5] == f"{wide:.1f}° x 25.0°"
    assert "8 of 40 x 32 pixels: 4 views, 1 withheld ones in 4 other lights" in described
    assert row(described, "fitzpatrick") == ["fitzpatrick", "III"] and row(described, "texture_size")[1] == "64"
    assert row(described, "other parts")[1] == "rest, eye_left"


@pytest.mark.parametrize("rgb", [(1, 1, 1), (1, 0.6, 0.3), (0.8, 0.95, 1.2), (1.0, 0.75, 0.5)])
def test_temperatures_are_those_of_colour_science(rgb):
    xyz = colour.RGB_to_XYZ(np.array(rgb, float), "sRGB", apply_cctf_decoding=False)
    expected, _ = colour.temperature.uv_to_CCT_Ohno2013(colour.UCS_to_uv(colour.XYZ_to_UCS(xyz)))
    assert correlated_kelvin(np.array(rgb)) == pytest.approx(expected, rel=0.01)


def test_colours_without_temperature_have_none():
    assert correlated_kelvin(np.zeros(3)) is None
    assert correlated_kelvin(np.array([0.0, 1.0, 0.0])) is None
    assert correlated_kelvin(np.array([0.0, 0.0, 1.0])) is None


def test_mean_radiance_of_a_panel_is_its_solid_angle():
    """A square of half side a at distance d: 4 asin(a^2 / (a^2 + d^2)) steradians."""
    a, d = 0.3, 1.5
    panel = lights.Panel.facing_head([0.0, 0.0, d], 2 * a, 2 * a, 3.0)
    solid = 4 * math.asin(a * a / (a * a + d * d))
    np.testing.assert_allclose(mean_radiance(lights.Panels((panel,))), 3 * solid / (4 * math.pi), rtol=0.01)

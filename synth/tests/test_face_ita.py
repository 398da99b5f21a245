"""Measured skin tone: CIELAB against a colour library, painted faces against the published groups."""

import colour
import numpy as np
import pytest

from unshade.face import FaceSpec, build_face
from unshade.face.cache import load_head
from unshade.face.canvas import Canvas
from unshade.face.geometry import place
from unshade.face.hair import hair_style
from unshade.face.identity import shape
from unshade.face.ita import GROUPS, cielab, face_ita, tone_group, typology_angle
from unshade.face.paint import paint_maps

TYPES = dict(zip(("I", "II", "III", "IV", "V", "VI"), (name for name, _ in GROUPS)))


def library_angle(rgb):
    xyz = colour.RGB_to_XYZ(rgb, "sRGB", apply_cctf_decoding=False)
    lab = colour.XYZ_to_Lab(xyz, colour.CCS_ILLUMINANTS["CIE 1931 2 Degree Standard Observer"]["D65"])
    return lab, np.degrees(np.arctan2(lab[..., 0] - 50, lab[..., 2]))


def test_cielab_agrees_with_a_colour_library():
    rgb = np.random.default_rng(0).uniform(0.0, 1.0, (500, 3)) ** 3
    lab, angle = library_angle(rgb)
    np.testing.assert_allclose(cielab(rgb), lab, atol=0.05)
    bright = np.abs(lab[:, 2]) > 5
    np.testing.assert_allclose(typology_angle(cielab(rgb))[bright], angle[bright], atol=0.5)


@pytest.mark.parametrize(
    ("angle", "group"),
    [
        (60, "very light"),
        (55.1, "very light"),
        (54.9, "light"),
        (30, "intermediate"),
        (12, "tan"),
        (-29, "brown"),
        (-31, "dark"),
        (-90, "dark"),
    ],
)
def test_groups_have_the_published_borders(angle, group):
    assert tone_group(angle) == group


@pytest.fixture(scope="module")
def tones():
    head, found = load_head(), {skin: [] for skin in TYPES}
    for seed in (31, 33):
        geometry = place(head, shape(head, spec_of("III", seed, 64)))
        for skin in TYPES:
            spec = spec_of(skin, seed, 64)
            found[skin].append(face_ita(paint_maps(Canvas.face(head), geometry, hair_style(spec), spec)))
    return found


def spec_of(skin, seed, size):
    return FaceSpec.from_table({"name": "x", "seed": seed, "fitzpatrick": skin, "texture_size": size})


@pytest.mark.parametrize("skin", TYPES)
def test_each_type_lands_in_its_group(tones, skin):
    assert tone_group(np.mean([tone.angle for tone in tones[skin]])) == TYPES[skin]


def test_people_of_one_type_differ(tones):
    for found in tones.values():
        assert np.std([tone.angle for tone in found]) > 0.3


def test_the_groups_are_spanned(tones):
    angles = [tone.angle for found in tones.values() for tone in found]
    assert max(angles) > 55 and min(angles) < -30


def test_sites_are_skin_as_the_map_has_it():
    maps = build_face(spec_of("III", 31, 256)).maps
    tone = face_ita(maps)
    head = load_head()
    u, v = head.chart_uv[np.linalg.norm(head.template[head.chart_vertices] - [0, 48, 22], axis=1).argmin()]
    row, column = int((1 - v) * 256), int(u * 256)
    lab, _ = library_angle(maps.diffuse_albedo[row - 6 : row + 6, column - 6 : column + 6].mean(axis=(0, 1)))
    np.testing.assert_allclose(tone.lab["forehead"], lab, atol=1.5)
    # Cheeks are redder than the forehead (Xiao et al. 2017).
    assert min(tone.lab["left_cheek"][1], tone.lab["right_cheek"][1]) > tone.lab["forehead"][1]
    table = tone.to_table()
    assert table["group"] == "intermediate" and abs(table["ita_degrees"] - tone.angle) < 0.01
    assert abs(face_ita(build_face(spec_of("III", 31, 128)).maps).angle - tone.angle) < 1

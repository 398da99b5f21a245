"""Roughness and specular albedo by region, against published ranges of measured faces."""

import ast
import dataclasses
from pathlib import Path

import numpy as np
import pytest

import unshade
from unshade.face import FaceSpec, Label, build_face
from unshade.face.cache import load_head
from unshade.face.regions import find_regions, sample_masks
from unshade.face.relief import Relief
from unshade.face.roughness import HIGH, LOW, NOMINAL, draw_roughness, equivalent

SPEC = FaceSpec.from_table({"name": "x", "seed": 7, "fitzpatrick": "III", "texture_size": 512})


@pytest.fixture(scope="module")
def face():
    return build_face(SPEC)


@pytest.fixture(scope="module")
def places(face):
    """Rows and columns of the texels under the chart's vertices, by region."""
    head = load_head()
    regions = find_regions(head.template[head.chart_vertices].astype(np.float32), sample_masks(head.native_uv))
    row, column = ((1 - head.chart_uv[:, 1]) * 512).astype(int), (head.chart_uv[:, 0] * 512).astype(int)
    skin = face.maps.labels[row, column]
    found = {}
    for name in ("nose", "forehead", "cheek", "chin", "upper_lid", "lips"):
        allowed = {"lips": [Label.LIPS], "nose": [Label.NOSE], "upper_lid": [Label.EYELID]}.get(name, [Label.SKIN])
        where = (getattr(regions, name) > 0.6) & np.isin(skin, allowed)
        found[name] = (row[where], column[where])
    return found


def test_nominal_is_the_material_s_own():
    # Read, not imported: the material needs a renderer.
    source = Path(unshade.__file__).with_name("render") / "skin_bsdf.py"
    stated = {
        node.targets[0].id: ast.literal_eval(node.value)
        for node in ast.parse(source.read_text()).body
        if isinstance(node, ast.Assign) and node.targets[0].id in ("LOBE_ALPHAS", "LOBE_WEIGHTS")
    }
    assert NOMINAL == (*stated["LOBE_ALPHAS"], stated["LOBE_WEIGHTS"][0])


def test_roughness_of_regions_lies_where_it_was_measured(face, places):
    mean = {name: equivalent(face.maps.roughness[where]).mean() for name, where in places.items()}
    # Single Torrance-Sparrow lobes of faces: m of 0.2 to 0.4 (Weyrich et al. 2006), 0.3 customary (d'Eon & Luebke 2007).
    assert all(0.18 < value < 0.40 for value in mean.values()), mean
    assert mean["nose"] < 0.9 * mean["forehead"] < 0.9 * 0.95 * mean["cheek"]
    assert mean["lips"] < 0.9 * mean["cheek"] and mean["forehead"] < mean["chin"] < mean["cheek"]
    assert len({round(value, 3) for value in mean.values()}) == len(mean)


def test_specular_albedo_of_regions_lies_where_it_was_measured(face, places):
    mean = {name: face.maps.specular_albedo[where].mean() for name, where in places.items()}
    assert all(0.02 < value < 0.04 for value in mean.values()), mean
    assert mean["nose"] > 1.08 * mean["cheek"] and mean["forehead"] > mean["cheek"] > mean["upper_lid"]


def test_map_is_bounded_and_nominal_at_the_outer_rim(face):
    rough = face.maps.roughness
    assert rough.dtype == np.float32 and rough.shape == (512, 512, 3)
    assert (rough >= np.float32(LOW)).all() and (rough <= np.float32(HIGH)).all()
    head = load_head()
    uv = head.chart_uv[head.rim_mm < 0.1]
    at_rim = rough[((1 - uv[:, 1]) * 512).astype(int), (uv[:, 0] * 512).astype(int)]
    np.testing.assert_allclose(at_rim, np.broadcast_to(np.float32(NOMINAL), at_rim.shape), atol=0.01)


def test_pores_scatter_and_age_dries():
    points = np.zeros((50, 3), dtype=np.float32) + np.float32([42, -38, 2])
    regions, none = find_regions(points), np.zeros(50, dtype=np.float32)
    flat = Relief(none, none, none, none)
    cover, rims = dict.fromkeys(("brow", "scalp", "beard"), none), {"outer": none + 1, "wet": none, "lash": none}

    def mean(relief, spec=SPEC):
        return equivalent(draw_roughness(regions, relief, cover, rims, 0.16, spec)).mean()

    assert mean(dataclasses.replace(flat, pores=none + 1)) > 1.15 * mean(flat)
    assert mean(flat, dataclasses.replace(SPEC, age=1.0)) > 1.05 * mean(flat, dataclasses.replace(SPEC, age=0.0))

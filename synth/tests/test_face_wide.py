"""A chart of head, neck and shoulders: the same person, and no step where it is cut open."""

import dataclasses

import numpy as np
import pytest
from scipy.ndimage import map_coordinates

from unshade.errors import SceneError
from unshade.face import FaceSpec, Label, build_face

SPEC = FaceSpec.sample(7, fitzpatrick="III", texture_size=256)


@pytest.fixture(scope="module")
def wide():
    return build_face(dataclasses.replace(SPEC, chart="wide"))


def test_it_is_the_same_person_on_a_larger_chart(wide):
    narrow = build_face(SPEC)
    known = {tuple(vertex) for vertex in wide.chart.vertices.tolist()}
    assert all(tuple(vertex) in known for vertex in narrow.chart.vertices.tolist())
    assert {part.name for part in narrow.parts} - {part.name for part in wide.parts} == {"rest"}
    scalp = [(face.maps.labels == Label.SCALP).sum() for face in (narrow, wide)]
    assert scalp[1] > scalp[0]
    assert all(np.isfinite(getattr(wide.maps, name)).all() for name in ("diffuse_albedo", "specular_normal", "height"))


def test_both_sides_of_a_seam_look_alike(wide):
    """Vertices at one place with two UV: albedo there differs by less than between neighbours."""
    _, twin, count = np.unique(wide.chart.vertices, axis=0, return_inverse=True, return_counts=True)
    twin = twin.ravel()
    pairs = np.argsort(twin, kind="stable")[count[np.sort(twin)] == 2].reshape(-1, 2)
    assert len(pairs) > 200
    size = SPEC.texture_size
    at = np.stack([1 - wide.chart.uv[:, 1], wide.chart.uv[:, 0]]) * size - 0.5
    light = map_coordinates(np.log(wide.maps.diffuse_albedo.mean(axis=2)), at, order=1, mode="nearest")
    assert np.median(np.abs(light[pairs[:, 0]] - light[pairs[:, 1]])) < 0.03
    assert light.std() > 0.2


def test_a_scene_states_its_chart():
    table = SPEC.to_table() | {"chart": "wide"}
    assert FaceSpec.from_table(table).to_table() == table
    assert "chart" not in SPEC.to_table()
    with pytest.raises(SceneError, match="use face or wide"):
        FaceSpec.from_table(table | {"chart": "head"})

"""One face, whole: reproducible, sealed at its seams, maps as promised."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from unshade.face import FaceSpec, Label, build_face, chart

TABLE = {"name": "x", "seed": 7, "fitzpatrick": "III", "texture_size": 256}


@pytest.fixture(scope="module")
def face():
    return build_face(FaceSpec.from_table(TABLE))


def arrays(face):
    for owner in (face.chart, face.maps, *face.parts):
        yield from (value for value in vars(owner).values() if isinstance(value, np.ndarray))


def test_equal_specifications_give_equal_bytes(face):
    again = build_face(FaceSpec.from_table(TABLE))
    assert [a.tobytes() for a in arrays(again)] == [a.tobytes() for a in arrays(face)]


def test_another_seed_is_another_person_on_the_same_chart(face):
    other = build_face(FaceSpec.from_table(TABLE | {"seed": 8, "texture_size": 128}))
    np.testing.assert_array_equal(other.chart.uv, face.chart.uv)
    offset = np.linalg.norm(other.chart.vertices - face.chart.vertices, axis=1)
    assert 0.001 < np.sqrt((offset**2).mean()) < 0.02


def test_world_is_metres_with_the_head_round_the_origin(face):
    low, high = face.chart.vertices.min(axis=0), face.chart.vertices.max(axis=0)
    assert 0.19 < high[1] - low[1] < 0.26 and 0.13 < high[0] - low[0] < 0.20
    assert face.chart.normals[face.chart.vertices[:, 2].argmax(), 2] > 0.7
    left, right = (part for part in face.parts if part.name.startswith("eye"))
    middle = (left.vertices.mean(axis=0) + right.vertices.mean(axis=0)) / 2
    assert left.vertices[:, 0].mean() > 0 > right.vertices[:, 0].mean()
    np.testing.assert_allclose(middle[:2], 0, atol=0.002)


def test_everything_has_its_promised_type(face):
    for mesh in (face.chart, *face.parts):
        assert mesh.vertices.dtype == mesh.normals.dtype == np.float32 and mesh.triangles.dtype == np.uint32
        assert mesh.triangles.max() == len(mesh.vertices) - 1
        np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-5)
        corner = mesh.vertices[mesh.triangles].astype(float)
        outward = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        agree = (outward * mesh.normals[mesh.triangles].sum(axis=1)).sum(axis=1) > 0
        assert agree.mean() > 0.999
    for part in face.parts:
        shape = part.diffuse.shape[:-1]
        assert part.specular.shape == shape and (part.uv is not None or shape == (len(part.vertices),))
        assert 0 <= part.diffuse.min() and part.diffuse.max() < 0.9
        assert 0 <= part.specular.min() and part.specular.max() <= 0.05


def test_chart_and_rest_meet_without_a_seam(face):
    rest = next(part for part in face.parts if part.name == "rest")
    rim = chart.boundary_loops(face.chart.triangles)[0]
    distance, twin = cKDTree(rest.vertices).query(face.chart.vertices[rim])
    assert distance.max() == 0
    np.testing.assert_array_equal(rest.normals[twin], face.chart.normals[rim])
    uv = face.chart.uv[rim]
    size = face.spec.texture_size
    column = np.clip((uv[:, 0] * size).astype(int), 0, size - 1)
    row = np.clip(((1 - uv[:, 1]) * size).astype(int), 0, size - 1)
    step = np.abs(face.maps.diffuse_albedo[row, column] - rest.diffuse[twin]).max(axis=1)
    # Behind the ears the hairline runs along the rim, where a texel is too coarse for it.
    assert np.median(step) < 0.001 and np.quantile(step, 0.95) < 0.02
    shine = np.abs(face.maps.specular_albedo[row, column] - rest.specular[twin])
    assert np.median(shine) < 0.0001 and np.quantile(shine, 0.95) < 0.002
    smooth = (face.maps.specular_normal[row, column] * face.chart.normals[rim]).sum(axis=1)
    assert np.median(np.degrees(np.arccos(np.clip(smooth, -1, 1)))) < 2


def test_holes_of_the_chart_are_backed_by_parts(face):
    behind = np.concatenate([part.vertices for part in face.parts if part.name in ("mouth", "sockets")])
    for loop in chart.boundary_loops(face.chart.triangles)[1:]:
        assert cKDTree(behind).query(face.chart.vertices[loop])[0].max() == 0


def test_maps_hold_values_everywhere(face):
    maps = face.maps
    size = face.spec.texture_size
    for name in ("diffuse_albedo", "specular_normal", "diffuse_normal"):
        assert getattr(maps, name).shape == (size, size, 3) and getattr(maps, name).dtype == np.float32
    assert maps.diffuse_albedo.min() > 0.005 and maps.diffuse_albedo.max() < 0.9
    assert maps.specular_albedo.min() > 0 and maps.specular_albedo.max() <= 0.05
    for normal in (maps.specular_normal, maps.diffuse_normal):
        np.testing.assert_allclose(np.linalg.norm(normal, axis=2), 1, atol=1e-5)


def test_labels_name_every_region_of_the_chart_alone(face):
    labels, inside = face.maps.labels, face.maps.inside
    assert labels.dtype == np.uint8
    np.testing.assert_array_equal(labels > 0, inside)
    assert set(np.unique(labels)) == set(Label)
    fraction = {label: (labels[inside] == label).mean() for label in Label}
    assert fraction[Label.SKIN] > 0.4 and 0.005 < fraction[Label.LIPS] < 0.05 and 0.01 < fraction[Label.NOSE] < 0.06


def test_lips_are_redder_and_brows_darker_than_skin(face):
    mean = {label: face.maps.diffuse_albedo[face.maps.labels == label].mean(axis=0) for label in (1, 2, 3)}
    assert mean[Label.LIPS][0] / mean[Label.LIPS][1] > 1.1 * mean[Label.SKIN][0] / mean[Label.SKIN][1]
    assert mean[Label.BROW].sum() < 0.6 * mean[Label.SKIN].sum()


@pytest.fixture(scope="module")
def large():
    return build_face(FaceSpec.from_table(TABLE | {"texture_size": 512}))


def test_detail_is_in_the_specular_normal_and_less_in_the_diffuse_one(large):
    skin = large.maps.labels == Label.SKIN
    inner = skin[:, 2:] & skin[:, 1:-1] & skin[:, :-2]

    def roughness(normal):
        return np.sqrt((np.diff(normal, n=2, axis=1)[inner] ** 2).mean())

    assert roughness(large.maps.specular_normal) > 1.3 * roughness(large.maps.diffuse_normal)


def test_a_larger_texture_is_the_same_face(face, large):
    half = large.maps.diffuse_albedo.reshape(256, 2, 256, 2, 3).mean(axis=(1, 3))
    inside = face.maps.inside & large.maps.inside.reshape(256, 2, 256, 2).all(axis=(1, 3))
    assert np.abs(half - face.maps.diffuse_albedo)[inside].mean() < 0.005

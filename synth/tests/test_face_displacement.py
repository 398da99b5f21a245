"""Relief as geometry: its normals are those of the map, it casts shadows, and solvers get the smooth mesh."""

import dataclasses

import mitsuba as mi
import numpy as np
import pytest

from unshade.errors import SceneError
from unshade.face import Chart, FaceSpec, Label, build_face, displacement
from unshade.face.displacement import displaced
from unshade.face.texels import rasterise
from unshade.render.scene import mesh_shape
from unshade.scene_file import parse_scene
from unshade.vectors import unit, vertex_normals

SPEC = FaceSpec.sample(7, fitzpatrick="III", detail="natural", texture_size=256)


@pytest.fixture(scope="module")
def face():
    return build_face(dataclasses.replace(SPEC, displacement=True))


def test_the_chart_is_as_without(face):
    smooth = build_face(SPEC)
    assert smooth.surface is smooth.chart
    for field in dataclasses.fields(Chart):
        np.testing.assert_array_equal(getattr(face.chart, field.name), getattr(smooth.chart, field.name))


def test_the_surface_is_raised_by_the_painted_height(face):
    count = len(face.chart.vertices)
    offset = (face.surface.vertices[:count] - face.chart.vertices).astype(float)
    along = (offset * face.chart.normals).sum(1)
    assert 5e-5 < along.std() < 1e-3 and np.abs(along).max() < 3e-3
    assert np.abs(offset - along[:, None] * face.chart.normals).max() < 2e-7
    assert len(face.surface.triangles) >= 2 * face.maps.inside.sum()


def test_its_normals_are_those_of_the_map(face):
    """Texel by texel, the surface leans from the smooth one as the specular normals do: gradients of one height."""
    surface, inside = face.surface, face.maps.inside
    texels = rasterise(surface.uv.astype(float), surface.triangles.astype(np.int64), face.spec.texture_size)
    real = vertex_normals(surface.vertices.astype(float), surface.triangles.astype(np.int64))
    smooth = unit(texels.sample(surface.normals.astype(float)))
    lean = face.maps.specular_normal[texels.inside] - smooth, unit(texels.sample(real)) - smooth
    np.testing.assert_array_equal(texels.inside, inside)
    # Lids and lips have creases narrower than their relief, which no height over a surface describes.
    skin = face.maps.labels[inside] == Label.SKIN
    painted, real = (part[skin].ravel() for part in lean)
    assert np.corrcoef(painted, real)[0, 1] > 0.85
    assert (painted @ real) / (painted @ painted) == pytest.approx(1, abs=0.1)


def test_a_ridge_casts_its_shadow():
    """A plane 1 m wide with a ridge 0.1 m high, under light at 45 degrees: shadow on the side away from it, as long as
    the ridge is high."""
    corners = np.float32([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    plane = Chart(
        corners, np.tile(np.float32([0, 0, 1]), (4, 1)), corners[:, :2].copy(), np.uint32([[0, 1, 2], [0, 2, 3]])
    )
    height = np.zeros((64, 64), np.float32)
    height[:, 31:33] = 0.1
    raised = displaced(plane, height)
    scene = mi.load_dict({"type": "scene", "ridge": mesh_shape("ridge", raised, mi.load_dict({"type": "diffuse"}))})
    x = np.linspace(0.3, 0.8, 101)
    origins = mi.Point3f(*(mi.Float(np.float32(a)) for a in (x, np.full_like(x, 0.5), np.full_like(x, 1e-4))))
    shaded = np.array(scene.ray_test(mi.Ray3f(origins, mi.Vector3f(-1, 0, 1))))
    lit_side, shadow = shaded[x < 0.45], shaded[(x > 0.53) & (x < 0.59)]
    assert not lit_side.any() and shadow.all() and not shaded[x > 0.63].any()


def test_no_texture_is_so_large_that_triangles_fill_the_memory(monkeypatch, face):
    monkeypatch.setattr(displacement, "_MOST_TRIANGLES", 4 * len(face.chart.triangles) + 1)
    raised = displaced(face.chart, np.zeros((8192, 8192), np.float32))
    assert len(raised.triangles) == 4 * len(face.chart.triangles)


def test_a_scene_states_it():
    table = SPEC.to_table() | {"displacement": True}
    assert FaceSpec.from_table(table).to_table() == table
    assert "displacement" not in SPEC.to_table()
    with pytest.raises(SceneError, match="displacement.*true or false"):
        FaceSpec.from_table(SPEC.to_table() | {"displacement": 1})
    scene = {
        "format": 1,
        "name": "raised",
        "face": table,
        "light": {"name": "studio", "kind": "studio"},
        "rig": {"name": "phone", "kind": "phone", "train": 3, "test": 1, "seed": 1},
        "render": {"width": 32, "height": 32, "tier": "volume"},
    }
    assert parse_scene(scene, "scene", None).face.displacement

"""Tangent space: the frames that other programs have, there and back."""

import json
import subprocess

import export_toy
import numpy as np
import pytest
import render_toy

from unshade import _native
from unshade.cycles import interpreter
from unshade.exporting.tangents import mikktspace_normals, mitsuba_normals, with_tangents
from unshade.render.scene import ChartMaps
from unshade.surface import Mesh, Surface

BLENDER = """
import json, sys
import numpy as np
bpy = __import__("bpy")
data = np.load(sys.argv[-1])
mesh = bpy.data.meshes.new("mesh")
mesh.from_pydata(data["vertices"].tolist(), [], data["triangles"].tolist())
mesh.polygons.foreach_set("use_smooth", [True] * len(data["triangles"]))
mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", data["uv"][data["triangles"].ravel()].ravel())
mesh.attributes.new("custom_normal", "FLOAT_VECTOR", "POINT").data.foreach_set("vector", data["normals"].ravel())
mesh.calc_tangents(uvmap="UVMap")
print("TANGENTS", json.dumps([[*loop.tangent, loop.bitangent_sign] for loop in mesh.loops]))
"""


@pytest.fixture(scope="module")
def toy():
    face = render_toy.toy_face()
    chart = face.chart
    return Surface(
        Mesh(chart.vertices, chart.normals, chart.uv, chart.triangles.astype(np.int64)), ChartMaps.truth(face)
    )


def plane(turn=None):
    """A square that faces +Z, with its UV turned."""
    turn = np.eye(2) if turn is None else turn
    uv = np.float32([[0, 0], [1, 0], [1, 1], [0, 1]])
    vertices = np.column_stack([uv, np.zeros(4)]).astype(np.float32)
    normals = np.tile(np.float32([0, 0, 1]), (4, 1))
    return vertices, normals, (uv @ turn).astype(np.float32), np.int64([[0, 1, 2], [0, 2, 3]])


def test_tangents_point_along_u():
    tangents = _native.mikktspace(*plane())
    assert tangents.shape == (2, 3, 4)
    np.testing.assert_allclose(tangents, np.broadcast_to([1, 0, 0, 1], tangents.shape), atol=1e-6)


def test_mirrored_uv_turn_the_sign():
    tangents = _native.mikktspace(*plane(np.diag([1.0, -1.0])))
    np.testing.assert_allclose(tangents, np.broadcast_to([1, 0, 0, -1], tangents.shape), atol=1e-6)


def test_shapes_that_do_not_fit_are_refused():
    vertices, normals, uv, triangles = plane()
    with pytest.raises(ValueError, match="one per vertex"):
        _native.mikktspace(vertices, normals[:3], uv, triangles)
    with pytest.raises(ValueError, match="names no vertex"):
        _native.mikktspace(vertices, normals, uv, triangles + 1)
    with pytest.raises(ValueError, match="expected"):
        _native.mikktspace(vertices, normals, vertices, triangles)


def test_a_seam_in_the_tangents_splits_vertices():
    # A mirrored half: the middle vertices belong to tangents of either sign.
    vertices = np.float32([[-1, 0, 0], [0, 0, 0], [1, 0, 0], [-1, 1, 0], [0, 1, 0], [1, 1, 0]])
    uv = np.column_stack([np.abs(vertices[:, 0]), vertices[:, 1]]).astype(np.float32)
    triangles = np.int64([[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]])
    mesh = Mesh(vertices, np.tile(np.float32([0, 0, 1]), (6, 1)), uv, triangles)
    split = with_tangents(mesh)
    assert len(split.mesh.vertices) == 8
    np.testing.assert_array_equal(split.mesh.vertices[split.mesh.triangles], vertices[triangles])
    signs = split.tangents[split.mesh.triangles][..., 3]
    assert (signs[:2] == -1).all() and (signs[2:] == 1).all()


def test_a_pixel_shader_finds_the_normals_again(toy):
    mesh = with_tangents(toy.mesh)
    local = mikktspace_normals(toy, mesh, toy.specular_normal)
    texels = toy.texels
    corners = mesh.mesh.triangles[texels.triangle]
    n, t = (np.einsum("mk,mkc->mc", texels.weights, v[corners]) for v in (mesh.mesh.normals, mesh.tangents[..., :3]))
    b = mesh.tangents[corners[:, 0], 3:] * np.cross(n, t)
    x, y, z = local[texels.inside].T[..., None]
    again = export_toy.unit(x * t + y * b + z * n)
    np.testing.assert_allclose(again, toy.specular_normal[texels.inside], atol=2e-6)
    np.testing.assert_allclose(np.linalg.norm(local, axis=-1), 1, atol=1e-6)


def test_the_meshs_own_normal_is_blue(toy):
    mesh_normal = toy.mesh_normal
    for local in (mikktspace_normals(toy, with_tangents(toy.mesh), mesh_normal), mitsuba_normals(toy, mesh_normal)):
        np.testing.assert_allclose(local, np.broadcast_to([0, 0, 1], local.shape), atol=1e-5)


def test_up_the_picture_is_green(toy):
    up = export_toy.unit(toy.mesh_normal + [0, 0.3, 0])
    middle = mikktspace_normals(toy, with_tangents(toy.mesh), up)[32, 32]
    assert middle[1] > 0.2 and abs(middle[0]) < 0.05


def test_blender_has_the_same_tangents(toy, tmp_path):
    export_toy.needs_blender()
    python = interpreter.command()
    if len(python) != 2:
        pytest.skip("a blender without its Python cannot run this script: make cycles")
    mesh = toy.mesh
    np.savez(tmp_path / "mesh.npz", vertices=mesh.vertices, normals=mesh.normals, uv=mesh.uv, triangles=mesh.triangles)
    words = [python[0], "-c", BLENDER, str(tmp_path / "mesh.npz")]
    output = subprocess.run(words, capture_output=True, text=True, check=True).stdout
    theirs = np.array(json.loads(next(line for line in output.splitlines() if line.startswith("TANGENTS"))[9:]))
    ours = _native.mikktspace(mesh.vertices, mesh.normals, mesh.uv, mesh.triangles).reshape(-1, 4)
    np.testing.assert_allclose(ours, theirs, atol=1e-5)

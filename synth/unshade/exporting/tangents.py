"""Normals in tangent space, against the tangents that the reading program has.

glTF, Blender and most bakers use MikkTSpace; Mitsuba 3.9 takes the direction of u of each triangle. Both are
written with +Y (green up the picture, towards larger v).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .. import _native
from ..surface import Mesh, Surface
from ..vectors import unit


@dataclass(frozen=True)
class TangentMesh:
    """A mesh whose vertices have MikkTSpace tangents (V,4): xyz unit, and the sign of the bitangent n x t."""

    mesh: Mesh
    tangents: np.ndarray


def with_tangents(mesh: Mesh) -> TangentMesh:
    """The mesh with its tangents; a vertex whose corners differ becomes several."""
    corners = _native.mikktspace(mesh.vertices, mesh.normals, mesh.uv, mesh.triangles).reshape(-1, 4)
    # A corner without a tangent, of a triangle without area in the UV, gets any direction across its normal.
    index = mesh.triangles.ravel()
    empty = ~(np.abs(corners[:, :3]).sum(1) > 0)
    corners[empty, :3] = across(mesh.normals[index[empty]])
    rows = np.column_stack([index.astype(np.float64), corners])
    kept, number = np.unique(rows, axis=0, return_inverse=True)
    old = kept[:, 0].astype(np.int64)
    split = Mesh(mesh.vertices[old], mesh.normals[old], mesh.uv[old], number.reshape(-1, 3).astype(np.int64))
    return TangentMesh(split, kept[:, 1:].astype(np.float32))


def across(normals: np.ndarray) -> np.ndarray:
    """A unit vector across each normal (N,3)."""
    axis = np.eye(3, dtype=np.float32)[np.abs(normals).argmin(1)]
    return unit(np.cross(axis, normals))


def mikktspace_normals(surface: Surface, tangent_mesh: TangentMesh, normals: np.ndarray) -> np.ndarray:
    """Object-space normals (N,N,3) in tangent space, +Y, unit: the exact inverse of the usual pixel shader.

    normal = x t + y b + z n, with n and t interpolated and not made unit again, and b = sign n x t (MikkTSpace's
    own prescription). ``tangent_mesh`` is that of the surface.
    """
    texels = surface.texels
    # Its triangles are the surface's in their order, only their vertices have other numbers.
    corners = tangent_mesh.mesh.triangles[texels.triangle]
    n, t = (
        np.einsum("mk,mkc->mc", texels.weights, values[corners])
        for values in (tangent_mesh.mesh.normals, tangent_mesh.tangents[:, :3])
    )
    b = tangent_mesh.tangents[corners[:, 0], 3:] * np.cross(n, t)
    return surface.spread(_into(t, b, n, normals[texels.inside]))


def mitsuba_normals(surface: Surface, normals: np.ndarray) -> np.ndarray:
    """Object-space normals (N,N,3) in the frames of Mitsuba 3.9's ``normalmap``, whose rows count from v = 1.

    Its tangent is the triangle's dp/du across the interpolated normal, its bitangent n x t.
    """
    mesh, texels = surface.mesh, surface.texels
    n = unit(texels.sample(mesh.normals))
    a, b, c = (mesh.vertices[mesh.triangles[:, corner]] for corner in range(3))
    (ua, va), (ub, vb), (uc, vc) = (mesh.uv[mesh.triangles[:, corner]].T for corner in range(3))
    area = (ub - ua) * (vc - va) - (uc - ua) * (vb - va)
    # No texel lies in a triangle without area in the UV.
    scale = np.where(area != 0, area, 1)[:, None]
    along_u = ((b - a) * (vc - va)[:, None] - (c - a) * (vb - va)[:, None]) / scale
    t = along_u[texels.triangle]
    t = unit(t - n * (t * n).sum(1, keepdims=True))
    return surface.spread(_into(t, np.cross(n, t), n, normals[texels.inside]))


def _into(t: np.ndarray, b: np.ndarray, n: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Coordinates (M,3) of normals in the frames t, b, n, which need not be orthogonal; unit."""
    rows = np.stack([np.cross(b, n), np.cross(n, t), np.cross(t, b)], 1)
    sign = np.sign((t * rows[:, 0]).sum(1, keepdims=True))
    local = sign * np.einsum("mrc,mc->mr", rows, normals)
    length = np.linalg.norm(local, axis=1, keepdims=True)
    return np.where(length > 0, local / np.where(length > 0, length, 1), [0, 0, 1]).astype(np.float32)

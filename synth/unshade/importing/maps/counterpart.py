"""For every texel of the capture's chart the nearest point of another mesh, and its frame there."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import igl
import numpy as np
from numpy.typing import NDArray

from ... import _native
from ...face.texels import Texels, rasterise
from ...vectors import triangle_normals, unit
from ..chart_mesh import ChartMesh, smooth_normals

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Counterparts:
    """Points of the other mesh for the M texels of the capture's chart: ``found`` (M,) whether one lies within the
    limit and faces the same way, its ``triangle`` (M,) and ``weights`` (M,3), ``distance`` (M,) metres."""

    texels: Texels
    found: NDArray[np.bool_]
    triangle: NDArray[np.int64]
    weights: Floats
    distance: Floats

    def at(self, values: Floats, triangles: NDArray[np.int64]) -> Floats:
        """Values (V,K) of the other mesh's vertices at the counterparts (M,K)."""
        return np.einsum("mk,mkc->mc", self.weights, values[triangles[self.triangle]])


def find_counterparts(
    vertices: NDArray[np.float32],
    normals: NDArray[np.float32],
    uv: NDArray[np.float32],
    triangles: NDArray[np.uint32],
    theirs: ChartMesh,
    *,
    size: int,
    limit: float,
) -> Counterparts:
    """Counterparts on ``theirs``, which lies in the capture's place, of a chart of ``size`` texels; ``limit`` in m.

    A point beyond the limit, or whose surface faces the other way, does not count.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        texels = rasterise(uv.astype(np.float64), triangles.astype(np.int64), size)
    points = texels.sample(vertices).astype(np.float64)
    squared, triangle, nearest = igl.point_mesh_squared_distance(points, theirs.vertices, theirs.triangles)
    triangle = np.asarray(triangle, np.int64)
    a, b, c = (theirs.vertices[theirs.triangles[triangle, corner]] for corner in range(3))
    weights = _barycentric(nearest, a, b, c)
    same = (
        np.einsum("mk,mk->m", triangle_normals(theirs.vertices, theirs.triangles)[triangle], texels.sample(normals))
    ) > 0
    distance = np.sqrt(squared)
    return Counterparts(texels, (distance <= limit) & same, triangle, weights, distance)


def facing_out(theirs: ChartMesh, points: Floats, normals: Floats) -> ChartMesh:
    """The mesh with its triangles and normals turned as the capture's surface is at ``points`` (K,3), if they are not."""
    _, triangle, _ = igl.point_mesh_squared_distance(points, theirs.vertices, theirs.triangles)
    facing = unit(triangle_normals(theirs.vertices, theirs.triangles))
    if np.einsum("mk,mk->m", facing[np.asarray(triangle)], normals).mean() < 0:
        theirs = replace(theirs, triangles=np.ascontiguousarray(theirs.triangles[:, ::-1]))
        facing = -facing
    if theirs.normals is not None and (facing * theirs.normals[theirs.triangles[:, 0]]).sum() < 0:
        theirs = replace(theirs, normals=-theirs.normals)
    return theirs


def _barycentric(p: Floats, a: Floats, b: Floats, c: Floats) -> Floats:
    """Weights (M,3) of points in their triangles; of a triangle without area the first corner."""
    u, v, w = b - a, c - a, p - a
    uu, uv, vv, wu, wv = ((x * y).sum(1) for x, y in ((u, u), (u, v), (v, v), (w, u), (w, v)))
    area = uu * vv - uv * uv
    flat = area <= 1e-12 * uu * vv
    area = np.where(flat, 1, area)
    second, third = (vv * wu - uv * wv) / area, (uu * wv - uv * wu) / area
    weights = np.stack([1 - second - third, second, third], 1)
    weights = np.where(flat[:, None], [1.0, 0, 0], weights).clip(0, 1)
    return weights / weights.sum(1, keepdims=True)


@dataclass(frozen=True)
class Layout:
    """Another mesh's layout as its pictures have it: ``uv`` (V,2) with row 0 at v = 1, whichever way it counts."""

    mesh: ChartMesh
    uv: Floats
    _charts: dict[int, Texels] = field(default_factory=lambda: dict[int, Texels](), repr=False)

    @classmethod
    def of(cls, mesh: ChartMesh, *, down: bool) -> Layout:
        """``down``: the pictures' row 0 lies at v = 0."""
        uv = mesh.uv.copy()
        if down:
            uv[:, 1] = 1 - uv[:, 1]
        return cls(mesh, uv)

    def chart(self, size: int) -> Texels:
        """The texels of a picture that the mesh uses."""
        if size not in self._charts:
            with np.errstate(divide="ignore", invalid="ignore"):
                self._charts[size] = rasterise(self.uv, self.mesh.triangles, size)
        return self._charts[size]

    def frames(self, counterparts: Counterparts) -> tuple[Floats, Floats, Floats]:
        """Tangent, bitangent and normal (M,3) each at the counterparts, as MikkTSpace has them: green up the picture."""
        normals, corners = self._tangents
        corners = corners[counterparts.triangle]
        n = counterparts.at(normals, self.mesh.triangles)
        t = np.einsum("mk,mkc->mc", counterparts.weights, corners[..., :3])
        return t, corners[:, 0, 3:] * np.cross(n, t), n

    @cached_property
    def _tangents(self) -> tuple[Floats, Floats]:
        """Normals (V,3) and MikkTSpace's tangents (F,3,4)."""
        mesh = self.mesh
        normals = unit(mesh.normals if mesh.normals is not None else smooth_normals(mesh.vertices, mesh.triangles))
        parts = [np.ascontiguousarray(values, np.float32) for values in (mesh.vertices, normals, self.uv)]
        return normals, _native.mikktspace(*parts, mesh.triangles).astype(np.float64)

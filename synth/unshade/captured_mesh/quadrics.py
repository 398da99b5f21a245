"""Quadric error: the squared distance to all planes that a vertex stands for."""

from __future__ import annotations

import numpy as np

from ..vectors import triangle_normals
from .smooth import boundary_edges

_EVENNESS = 1e-3
"""Weight of the squared edge length beside the squared distance: on flat skin, where any
vertex could go, short edges go first and the mesh stays even."""


class Quadrics:
    """One quadric per vertex (Garland & Heckbert 1997), weighted by area, with planes that
    stand on boundary edges so that outlines keep their shape."""

    def __init__(self, positions: np.ndarray, triangles: np.ndarray) -> None:
        normal = triangle_normals(positions, triangles)
        area = 0.5 * np.linalg.norm(normal, axis=1)
        self._forms = np.zeros((len(positions), 10))
        self._area = np.zeros(len(positions))
        unit = normal / np.maximum(2 * area, 1e-300)[:, None]
        self._add(triangles, unit, positions[triangles[:, 0]], area / 3)
        self._area += sum(np.bincount(triangles[:, k], area / 3, minlength=len(positions)) for k in range(3))
        edges = boundary_edges(triangles)
        starts, along = positions[edges[:, 0]], positions[edges[:, 1]] - positions[edges[:, 0]]
        at_vertex = np.zeros_like(positions)
        for k in range(3):
            np.add.at(at_vertex, triangles[:, k], normal)
        upright = np.cross(along, at_vertex[edges[:, 0]] + at_vertex[edges[:, 1]])
        upright /= np.maximum(np.linalg.norm(upright, axis=1, keepdims=True), 1e-300)
        self._add(edges, upright, starts, (along**2).sum(1))

    def _add(self, cells: np.ndarray, normal: np.ndarray, point: np.ndarray, weight: np.ndarray) -> None:
        plane = np.concatenate([normal, -(normal * point).sum(1, keepdims=True)], axis=1)
        rows, columns = np.triu_indices(4)
        forms = weight[:, None] * plane[:, rows] * plane[:, columns]
        for corner in cells.T:
            for term in range(10):
                self._forms[:, term] += np.bincount(corner, forms[:, term], minlength=len(self._forms))

    def cost(self, start: np.ndarray, end: np.ndarray, positions: np.ndarray) -> np.ndarray:
        """Error (m^4) of pulling vertices ``start`` (E,) onto ``end`` (E,)."""
        x, y, z = positions[end].T
        a = (self._forms[start] + self._forms[end]).T
        error = x * (a[0] * x + 2 * (a[1] * y + a[2] * z + a[3])) + y * (a[4] * y + 2 * (a[5] * z + a[6]))
        error += z * (a[7] * z + 2 * a[8]) + a[9]
        length = ((positions[end] - positions[start]) ** 2).sum(1)
        # Rounding makes tiny negative errors of flat places.
        return np.maximum(error, 0) + _EVENNESS * self._area[start] * length

    def merge(self, start: np.ndarray, end: np.ndarray) -> None:
        """Hands the planes of ``start`` (C,) over to ``end`` (C,), all different."""
        self._forms[end] += self._forms[start]
        self._area[end] += self._area[start]

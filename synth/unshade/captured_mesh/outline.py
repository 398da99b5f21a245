"""The outline of a chart in UV: its outer boundary and its holes."""

from __future__ import annotations

import numpy as np

_MAX_BOW = 0.2
"""Height of a vertex over the chord that replaces it, over the chord's length."""


class Outline:
    """Directed boundary edges (B,2) with the chart on their left. Every vertex ends one edge
    and starts another."""

    def __init__(self, uv: np.ndarray, edges: np.ndarray) -> None:
        self._uv = uv
        self._next, self._previous = np.full(len(uv), -1), np.full(len(uv), -1)
        self._next[edges[:, 0]] = edges[:, 1]
        self._previous[edges[:, 1]] = edges[:, 0]
        self._vertices = np.unique(edges)
        self.member = np.zeros(len(uv), bool)
        """Which vertices (V,) lie on it."""
        self.member[self._vertices] = True
        # Two fans that meet in one vertex: their edges would be mixed up.
        self._pinched = np.bincount(edges[:, 0], minlength=len(uv)) > 1

    def would_overlap(self, onto: np.ndarray) -> np.ndarray:
        """Vertices (V,) of the outline whose collapse (``onto`` (V,) >= 0) bends it too much,
        or whose chord leaves the chart and meets another piece of it.

        A chord can only cross another edge of the outline if a vertex of it lies in the
        triangle between chord and outline, so the outline stays free of crossings, even if
        several chords are drawn at once.
        """
        bad = np.zeros(len(onto), bool)
        vertex = self._vertices[onto[self._vertices] >= 0]
        bad[vertex[self._pinched[vertex]]] = True
        vertex = vertex[~self._pinched[vertex]]
        before, after = self._previous[vertex], self._next[vertex]
        p, q, r = self._uv[before], self._uv[vertex], self._uv[after]
        bow = _cross(r - p, q - p)
        bad[vertex[np.abs(bow) > _MAX_BOW * ((r - p) ** 2).sum(1)]] = True
        # Beyond the chart lies the triangle p, r, q where q bows to the left.
        outside = np.flatnonzero(bow > 0)
        others = self._uv[self._vertices]
        for i in outside:
            inside = (_cross(r[i] - p[i], others - p[i]) >= 0) & (_cross(q[i] - r[i], others - r[i]) >= 0)
            inside &= _cross(p[i] - q[i], others - q[i]) >= 0
            corners = (self._vertices == before[i]) | (self._vertices == vertex[i]) | (self._vertices == after[i])
            bad[vertex[i]] |= bool((inside & ~corners).any())
        return bad


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]

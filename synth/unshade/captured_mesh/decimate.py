"""Decimation of a chart: fewer vertices, the same UV.

Half-edge collapses (a vertex is pulled onto a neighbour), cheapest by quadric error first
(Garland & Heckbert 1997), many at a time where their neighbourhoods are disjoint. What is
left is a subset of the vertices, so positions and texture coordinates are the old ones.
"""

from __future__ import annotations

import numpy as np

from .outline import Outline
from .quadrics import Quadrics

_CHEAPEST = 0.5
"""Share of the possible collapses that one round considers."""

_ASKED = 0.4
"""Share of the vertices, by chance, that one round looks at."""

_PATIENCE = 12
"""Rounds without any collapse, each with other random choices, before giving up."""

_MIN_QUALITY = 0.05
"""Least area of a new triangle over that of the equilateral one with the same edges, in UV
and in space: no slivers."""

_MIN_COSINE = 0.3
"""Between the normals of a triangle before and after a collapse: no folds in space."""


def decimate(
    positions: np.ndarray,
    uv: np.ndarray,
    triangles: np.ndarray,
    target: int,
    fixed: np.ndarray,
    rng: np.random.Generator,
) -> tuple[np.ndarray, np.ndarray]:
    """Old indices (W,) of the vertices that are kept and the new triangles (G,3).

    ``positions`` (V,3), ``uv`` (V,2), ``triangles`` (F,3), counter-clockwise in UV; vertices
    that are ``fixed`` (V,) stay. W exceeds ``target`` where no collapse is left that keeps
    all triangles counter-clockwise in UV, the surface unfolded, and every hole open.
    """
    quadrics = Quadrics(positions, triangles)
    alive, idle = len(np.unique(triangles)), 0
    while alive > target and idle < _PATIENCE:
        mesh = _Round(positions, uv, triangles, rng)
        wanted = mesh.wanted(quadrics, fixed, 1.0 if idle else _CHEAPEST)
        chosen = mesh.independent(wanted)[: alive - target]
        idle = 0 if len(chosen) else idle + 1
        onto = mesh.onto[chosen]
        quadrics.merge(chosen, onto)
        moved = np.arange(len(positions))
        moved[chosen] = onto
        triangles = moved[triangles]
        a, b, c = triangles.T
        triangles = triangles[(a != b) & (b != c) & (c != a)]
        alive -= len(chosen)
    kept, local = np.unique(triangles, return_inverse=True)
    return kept, local.reshape(-1, 3)


class _Round:
    """The mesh between two rounds, and the collapses it allows."""

    def __init__(self, positions: np.ndarray, uv: np.ndarray, triangles: np.ndarray, rng: np.random.Generator) -> None:
        self.positions, self.uv, self.triangles, self.rng = positions, uv, triangles, rng
        self.size = len(positions)
        sides = np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)])
        self.keys, first, count = np.unique(self._key(sides[:, 0], sides[:, 1]), return_index=True, return_counts=True)
        rim = count == 1
        self.outline = Outline(uv, sides[first[rim]])
        edges = sides[first]
        self.edges = np.concatenate([edges, edges[:, ::-1]])
        self.edge_on_rim = np.concatenate([rim, rim])
        self.onto = np.full(self.size, -1)

    def _key(self, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return np.minimum(a, b) * self.size + np.maximum(a, b)

    def wanted(self, quadrics: Quadrics, fixed: np.ndarray, fraction: float) -> np.ndarray:
        """Vertices whose cheapest collapse is among the cheapest ``fraction`` and breaks nothing,
        cheapest first; `onto` holds where each goes."""
        start, end = self.edges.T
        # Few can win in one round, so a part of the vertices suffices to find them.
        asked = self.rng.random(self.size) < _ASKED
        allowed = (asked & ~fixed)[start] & (~self.outline.member[start] | self.edge_on_rim)
        start, end = start[allowed], end[allowed]
        # Random factors, so that the next round tries another neighbour where this one fails.
        cost = quadrics.cost(start, end, self.positions) * self.rng.uniform(1, 2, len(start))
        order = np.lexsort((cost, start))
        first = np.ones(len(order), bool)
        first[1:] = start[order][1:] != start[order][:-1]
        best = order[first]
        best = best[np.argsort(cost[best], kind="stable")][: round(fraction * len(best))]
        self.onto[start[best]] = end[best]
        bad = self._folds() | self._pinches() | self.outline.would_overlap(self.onto)
        return start[best][~bad[start[best]]]

    def _folds(self) -> np.ndarray:
        """Vertices (V,) whose collapse would flip, fold or squash a triangle."""
        bad = np.zeros(self.size, bool)
        for k in range(3):
            vertex, a, b = (self.triangles[:, (k + i) % 3] for i in range(3))
            onto = self.onto[vertex]
            stays = (onto >= 0) & (onto != a) & (onto != b)
            vertex, a, b, onto = vertex[stays], a[stays], b[stays], onto[stays]
            before = np.cross(self.positions[a] - self.positions[vertex], self.positions[b] - self.positions[vertex])
            after = np.cross(self.positions[a] - self.positions[onto], self.positions[b] - self.positions[onto])
            lengths = np.linalg.norm(before, axis=1) * np.linalg.norm(after, axis=1)
            folded = (before * after).sum(1) < _MIN_COSINE * lengths
            flat = np.linalg.norm(after, axis=1) < _MIN_QUALITY * _equilateral(self.positions, onto, a, b)
            (x1, y1), (x2, y2) = (self.uv[a] - self.uv[onto]).T, (self.uv[b] - self.uv[onto]).T
            flipped = x1 * y2 - y1 * x2 <= _MIN_QUALITY * _equilateral(self.uv, onto, a, b)
            bad[vertex[folded | flat | flipped]] = True
        return bad

    def _pinches(self) -> np.ndarray:
        """Vertices (V,) whose collapse would make the mesh non-manifold: they share more
        neighbours with the target than the triangles at their edge (the link condition)."""
        start, neighbour = self.edges.T
        onto = self.onto[start]
        asked = (onto >= 0) & (neighbour != onto)
        key = self._key(neighbour[asked], onto[asked])
        place = np.searchsorted(self.keys, key).clip(max=len(self.keys) - 1)
        shared = np.bincount(start[asked][self.keys[place] == key], minlength=self.size)
        return shared != np.where(self.outline.member, 1, 2)

    def independent(self, wanted: np.ndarray) -> np.ndarray:
        """Vertices of ``wanted`` (indices, in the order of their cost) that win a lottery in their
        neighbourhood of two edges: their closed rings are disjoint, so none spoils another's checks."""
        rank = np.full(self.size, self.size)
        rank[wanted] = self.rng.permutation(len(wanted))
        minimum = rank
        for _ in range(2):
            spread = minimum.copy()
            np.minimum.at(spread, self.edges[:, 0], minimum[self.edges[:, 1]])
            minimum = spread
        return wanted[minimum[wanted] == rank[wanted]]


def _equilateral(points: np.ndarray, a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    """Twice the area of the equilateral triangle with the same sum of squared edges."""
    squared = sum(((points[p] - points[q]) ** 2).sum(1) for p, q in ((a, b), (b, c), (c, a)))
    return squared / (2 * np.sqrt(3))

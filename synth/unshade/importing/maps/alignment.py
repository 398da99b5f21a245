"""Where another method's mesh lies against the capture's: the same place, another unit, other axes, or a fit."""

from __future__ import annotations

import itertools
import json
from dataclasses import dataclass
from pathlib import Path

import igl
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...errors import MapsError
from ..capture_folder import RECORD
from ..placement import UNITS
from ..source import Matrix

PLACES = ("auto", "keep", "source", "fit")

_POINTS = 1500
"""Points of the capture's mesh that are looked at."""

_STEPS = 60


@dataclass(frozen=True)
class Alignment:
    """The similarity (4,4) from another mesh to the capture's, what it is in words, and the median distance (m) of the
    capture's vertices to the moved mesh."""

    matrix: Matrix
    words: str
    median: float


def align(
    theirs: tuple[NDArray[np.float64], NDArray[np.int64]],
    ours: NDArray[np.float64],
    *,
    how: str,
    unit: str | None,
    source: Matrix | None,
    limit: float,
    shown: str,
) -> Alignment:
    """Finds where the mesh ``theirs`` (vertices, triangles) lies; ``ours`` (V,3) are the capture's vertices, metres.

    ``keep`` takes it as it is, in its ``unit``; ``source`` moves it as the capture was when it was imported (``source``
    is that matrix); ``auto`` tries these, units and quarter turns, and takes the first that is within half of ``limit``
    (m), else the nearest; ``fit`` goes on from there with a similarity of least squares (ICP). Raises `MapsError` if
    the meshes are further than ``limit`` apart, in the median.
    """
    points = ours[:: max(1, len(ours) // _POINTS)]
    vertices, triangles = theirs
    metres = np.diag([UNITS[unit]] * 3 + [1.0]) if unit else np.eye(4)
    if how == "source" and source is None:
        raise MapsError(f"{shown}: place is source, but the capture was not imported; keep its place, or fit it")
    candidates = [(metres, "as it is" if unit in (None, "m") else f"in {unit}")]
    if source is not None and how != "keep":
        moved = (source if unit is None else source @ metres, "moved as the capture was when it was imported")
        candidates = [moved] if how == "source" else [*candidates, moved]
    surface = _Surface(vertices, triangles)
    found = [surface.measured(points, *candidate) for candidate in candidates]
    near = [alignment for alignment in found if alignment.median <= limit / 2]
    if near or how in ("keep", "source"):
        best = near[0] if near else found[0]
    else:
        tried = _tried(candidates, unit)
        tree = cKDTree(vertices)
        some = points[:: max(1, len(points) // 200)]
        matrix, words = min(tried, key=lambda candidate: _rough(tree, some, candidate[0]))
        best = surface.measured(points, matrix, words)
    if how == "fit":
        best = _fitted(surface, points, best)
    if best.median > limit:
        fix = "state its unit and axes, raise the limit, or let it be fitted (place fit)"
        raise MapsError(
            f"{shown}: lies {1000 * best.median:.3g} mm (median) from the capture's mesh {best.words}, "
            f"the limit is {1000 * limit:g} mm; {fix}"
        )
    return best


def source_to_capture(capture: Path) -> Matrix | None:
    """How a capture was moved when it was imported; None if it was not imported."""
    try:
        matrix = np.array(json.loads((capture / RECORD).read_bytes())["source_to_capture"], float)
    except (OSError, ValueError, KeyError, TypeError):
        return None
    return matrix if matrix.shape == (4, 4) and np.isfinite(matrix).all() else None


def moved(matrix: Matrix, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points (V,3) after a similarity."""
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def _tried(candidates: list[tuple[Matrix, str]], unit: str | None) -> list[tuple[Matrix, str]]:
    """Every candidate in every unit (unless it is stated) and every quarter turn."""
    scales = [("", 1.0)] if unit else [("", 1.0), *((f" in {name}", size) for name, size in UNITS.items() if size != 1)]
    result = []
    for (matrix, words), (scaled, size) in itertools.product(candidates, scales):
        for axes, signs in itertools.product(itertools.permutations(range(3)), itertools.product((1, -1), repeat=3)):
            turn = np.eye(4)
            turn[:3, :3] = np.eye(3)[list(axes)] * np.array(signs)[:, None]
            if np.linalg.det(turn) > 0:
                names = [("" if sign > 0 else "-") + "xyz"[axis] for axis, sign in zip(axes, signs)]
                with_axes = "" if np.array_equal(turn, np.eye(4)) else f" with axes {', '.join(names)} as x, y, z"
                result.append((matrix @ turn @ np.diag([size, size, size, 1.0]), words + scaled + with_axes))
    return result


def _rough(tree: cKDTree, points: NDArray[np.float64], matrix: Matrix) -> float:
    """Median distance to the nearest vertex, looked up in the mesh's own place."""
    back = np.linalg.inv(matrix)
    scale = np.cbrt(np.linalg.det(matrix[:3, :3]))
    return float(np.median(tree.query(moved(back, points))[0]) * scale)


class _Surface:
    """A mesh in its own place, with a tree over its triangles, so that points are moved and not the mesh."""

    def __init__(self, vertices: NDArray[np.float64], triangles: NDArray[np.int64]) -> None:
        self.vertices, self.triangles = np.ascontiguousarray(vertices), np.ascontiguousarray(triangles)
        self._tree = igl.AABB()
        self._tree.init(self.vertices, self.triangles)

    def nearest(self, points: NDArray[np.float64], matrix: Matrix) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Distances (K,) to ``points`` (K,3) of the mesh once it is moved, and its nearest points (K,3)."""
        back = np.ascontiguousarray(moved(np.linalg.inv(matrix), points))
        _, _, nearest = self._tree.squared_distance(self.vertices, self.triangles, back)
        nearest = moved(matrix, np.asarray(nearest))
        return np.linalg.norm(nearest - points, axis=1), nearest

    def measured(self, points: NDArray[np.float64], matrix: Matrix, words: str) -> Alignment:
        return Alignment(matrix, words, float(np.median(self.nearest(points, matrix)[0])))


def _fitted(surface: _Surface, points: NDArray[np.float64], start: Alignment) -> Alignment:
    """Iterated closest points, the farthest fifth left out; the similarity of each step is Umeyama's."""
    matrix = start.matrix
    for _ in range(_STEPS):
        distance, nearest = surface.nearest(points, matrix)
        kept = distance <= np.quantile(distance, 0.8)
        a, b = nearest[kept], points[kept]
        middle_a, middle_b = a.mean(0), b.mean(0)
        u, s, vt = np.linalg.svd((b - middle_b).T @ (a - middle_a) / len(a))
        d = np.array([1, 1, np.sign(np.linalg.det(u @ vt))])
        turn = (u * d) @ vt
        scale = float((s * d).sum() / ((a - middle_a) ** 2).sum(1).mean())
        step = np.eye(4)
        step[:3, :3] = scale * turn
        step[:3, 3] = middle_b - scale * turn @ middle_a
        matrix = step @ matrix
    fitted = surface.measured(points, matrix, f"{start.words}, then fitted by a similarity (ICP)")
    return fitted if fitted.median < start.median else start

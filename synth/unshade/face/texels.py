"""The texels of the chart: which triangle covers each, and where in it."""

from __future__ import annotations

import dataclasses
import functools

import numpy as np
import scipy.sparse as sp
from scipy.ndimage import distance_transform_edt

# Candidate texels tested at a time, to bound memory.
_BATCH = 4_000_000


@dataclasses.dataclass(frozen=True)
class Texels:
    """Texels whose centre lies in the chart, in row-major order (M of them).

    `inside` (N,N) bool; `triangle` (M,) the covering triangle's vertices' row in
    `triangles` (F,3); `weights` (M,3) f32 barycentric.
    """

    inside: np.ndarray
    triangles: np.ndarray
    triangle: np.ndarray
    weights: np.ndarray

    @functools.cached_property
    def _matrix(self) -> sp.csr_matrix:
        ends = np.arange(0, 3 * len(self.triangle) + 1, 3)
        corners = self.triangles[self.triangle].ravel()
        return sp.csr_matrix(
            (self.weights.ravel(), corners, ends), shape=(len(self.triangle), int(self.triangles.max()) + 1)
        )

    def sample(self, values: np.ndarray) -> np.ndarray:
        """Values per chart vertex (C,) or (C,K) interpolated at the texels: (M,) or (M,K) f32."""
        return self._matrix @ np.ascontiguousarray(values, dtype=np.float32)

    def image(self, values: np.ndarray, fill: float = 0.0) -> np.ndarray:
        """Texel values (M,...) as a picture (N,N,...), `fill` outside the chart."""
        picture = np.full(self.inside.shape + values.shape[1:], fill, dtype=values.dtype)
        picture[self.inside] = values
        return picture

    @functools.cached_property
    def _number(self) -> np.ndarray:
        return self.image(np.arange(1, len(self.triangle) + 1))

    def around(self, uv: np.ndarray, reach: float) -> np.ndarray:
        """Texels in a square of half side `reach` (texels) round a point of the chart."""
        size = len(self.inside)
        column, row = uv[0] * size - 0.5, (1 - uv[1]) * size - 0.5
        rows = slice(max(0, int(row - reach)), int(row + reach) + 2)
        number = self._number[rows, max(0, int(column - reach)) : int(column + reach) + 2]
        return number[number > 0] - 1

    def nearest_inside(self) -> tuple[np.ndarray, np.ndarray]:
        """Row and column (N,N) of the nearest texel of the chart."""
        return tuple(distance_transform_edt(~self.inside, return_distances=False, return_indices=True))


def rasterise(uv: np.ndarray, triangles: np.ndarray, size: int) -> Texels:
    """Cover an N x N grid (texel row 0 at v = 1) by UV triangles, each texel centre by at most one.

    Triangles are grouped by the size of their bounding box, so that numpy tests all
    candidate texels of a group at once. On a shared edge the last triangle wins.
    """
    points = np.stack([uv[:, 0] * size - 0.5, (1 - uv[:, 1]) * size - 0.5], axis=1)[triangles]
    low = np.ceil(points.min(axis=1)).astype(np.int64)
    extent = np.floor(points.max(axis=1)).astype(np.int64) - low + 1
    owner = np.full(size * size, -1, dtype=np.int64)
    weights = np.zeros((size * size, 3), dtype=np.float32)
    # Most triangles of a fine mesh hold no texel's centre.
    some = np.flatnonzero((extent > 0).all(axis=1))
    widths, heights = extent[some].T
    boxes, number, counts = np.unique(widths * (size + 1) + heights, return_inverse=True, return_counts=True)
    groups = np.split(some[np.argsort(number, kind="stable")], np.cumsum(counts)[:-1])
    for box, group in zip(boxes, groups):
        box = np.array(divmod(int(box), size + 1))
        step = max(1, _BATCH // int(box.prod()))
        for start in range(0, len(group), step):
            _cover(points, low, group[start : start + step], box, size, owner, weights)
    inside = owner >= 0
    return Texels(inside.reshape(size, size), triangles, owner[inside], weights[inside])


def _cover(points, low, group, box, size, owner, weights) -> None:
    """Enter the texels of the triangles `group`, all with bounding boxes of `box` texels."""
    column, row = np.meshgrid(np.arange(box[0]), np.arange(box[1]))
    x = low[group, 0, None] + column.ravel()
    y = low[group, 1, None] + row.ravel()
    (ax, ay), (bx, by), (cx, cy) = (points[group, k].T[:, :, None] for k in range(3))
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    b = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / area
    c = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / area
    # A hair's breadth of tolerance keeps centres exactly on an edge from falling between two triangles.
    hit = (b >= -1e-9) & (c >= -1e-9) & (b + c <= 1 + 1e-9)
    texel = (y * size + x)[hit]
    owner[texel] = np.broadcast_to(group[:, None], hit.shape)[hit]
    weights[texel] = np.stack([1 - b[hit] - c[hit], b[hit], c[hit]], axis=1)

"""Curves drawn on the face: hairs and creases, as distances from texels to polylines."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree


class Sketch:
    """Texels of the front of the face, seen along -Z in template millimetres."""

    def __init__(self, points: np.ndarray, front: np.ndarray):
        """`points` (M,3) mm; `front` (M,) bool: the texels that can be drawn on."""
        self.index = np.flatnonzero(front)
        self.plane = points[self.index, :2].astype(np.float64)
        self.tree = cKDTree(self.plane)

    def near(self, curve: np.ndarray, reach: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Texels within `reach` of a polyline (K,2): index, distance (mm), place along it (0 to 1).

        A texel appears once, with its nearest segment.
        """
        low, high = curve.min(axis=0) - reach, curve.max(axis=0) + reach
        found = self.tree.query_ball_point((low + high) / 2, np.linalg.norm(high - low) / 2, return_sorted=True)
        found = np.asarray(found, dtype=np.int64)
        start, step = curve[:-1], np.diff(curve, axis=0)
        offset = self.plane[found][:, None, :] - start
        share = np.clip((offset * step).sum(axis=2) / np.maximum((step**2).sum(axis=1), 1e-12), 0, 1)
        distance = np.linalg.norm(offset - share[:, :, None] * step, axis=2)
        segment = distance.argmin(axis=1)
        rows = np.arange(len(found))
        shortest = distance[rows, segment]
        close = shortest <= reach
        along = (segment + share[rows, segment]) / len(step)
        return self.index[found[close]], shortest[close], along[close]

    def coverage(self, curve: np.ndarray, width: float, texel: float) -> tuple[np.ndarray, np.ndarray]:
        """Texels that a stroke tapering from `width` (mm) covers, and the covered share of each."""
        index, distance, along = self.near(curve, width + texel)
        half = 0.5 * width * (1 - 0.8 * along**2)
        outer = np.clip(0.5 + (half - distance) / texel, 0, 1)
        inner = np.clip(0.5 + (-half - distance) / texel, 0, 1)
        return index, outer - inner

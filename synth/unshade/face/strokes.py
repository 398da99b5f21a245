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
        start, step = curve[:-1], np.diff(curve, axis=0)
        balls = self.tree.query_ball_point(start + step / 2, reach + 0.5 * np.linalg.norm(step, axis=1))
        found = np.unique(np.concatenate([np.asarray(ball, dtype=np.int64) for ball in balls]))
        offset = self.plane[found][:, None, :] - start
        fraction = np.clip((offset * step).sum(axis=2) / np.maximum((step**2).sum(axis=1), 1e-12), 0, 1)
        away = offset - fraction[:, :, None] * step
        distance = np.sqrt((away**2).sum(axis=2))
        segment = distance.argmin(axis=1)
        rows = np.arange(len(found))
        shortest = distance[rows, segment]
        close = shortest <= reach
        along = (segment + fraction[rows, segment]) / len(step)
        return self.index[found[close]], shortest[close], along[close]

    def coverage(self, curve: np.ndarray, width: float, texel: float) -> tuple[np.ndarray, np.ndarray]:
        """Texels that a stroke tapering from `width` (mm) covers, and the covered share of each."""
        index, distance, along = self.near(curve, width + texel)
        half = 0.5 * width * (1 - 0.8 * along**2)
        outer = np.clip(0.5 + (half - distance) / texel, 0, 1)
        inner = np.clip(0.5 + (-half - distance) / texel, 0, 1)
        return index, outer - inner

"""The albedo of the flesh at any place: that of the nearest skin, in two grids.

A fine one over the chart, where texture matters; a coarse one over the whole head.
"""

from __future__ import annotations

import drjit as dr
import mitsuba as mi
import numpy as np
from scipy.ndimage import distance_transform_edt

from .surface import SkinPoints

FINE, COARSE = 1.0e-3, 4.0e-3
"""Edges of the voxels in metres."""
_MARGIN = 6.0e-3
"""Metres that the fine grid extends beyond the chart: several mean free paths."""


class AlbedoGrid:
    """Albedo under diffuse light at points within the head.

    No dataclass: Dr.Jit would carry the fields of one through its loops as variables.
    """

    def __init__(self, fine: tuple, coarse: tuple) -> None:
        self.fine = fine
        self.coarse = coarse

    @classmethod
    def of(cls, points: SkinPoints, albedo: np.ndarray) -> AlbedoGrid:
        """``albedo`` (M,3) of the points."""
        chart = points.positions[: len(points.texels.triangle)]
        return cls(
            _nearest(points.positions, albedo, chart.min(0) - _MARGIN, chart.max(0) + _MARGIN, FINE),
            _nearest(points.positions, albedo, points.positions.min(0), points.positions.max(0), COARSE),
        )

    def albedo(self, p):
        """Linear Rec.709 albedo at points of the world."""
        (fine, low, size), (coarse, low_coarse, size_coarse) = self.fine, self.coarse
        at = (p - mi.Point3f(*low)) / mi.Vector3f(*size)
        inside = dr.all((at > 0) & (at < 1))
        there = (p - mi.Point3f(*low_coarse)) / mi.Vector3f(*size_coarse)
        return dr.select(inside, mi.Color3f(fine.eval(at, inside)), mi.Color3f(coarse.eval(there, ~inside)))


def _nearest(positions: np.ndarray, values: np.ndarray, low: np.ndarray, high: np.ndarray, edge: float) -> tuple:
    """Texture of a box: the mean of the values in a voxel, or else that of the nearest voxel
    with any; with the box's corner and size."""
    x, y, z = shape = np.ceil((high - low) / edge).astype(int)
    place = np.floor((positions - low) / edge).astype(int)
    within = ((place >= 0) & (place < shape)).all(1)
    column, row, layer = place[within].T
    number = (layer * y + row) * x + column
    count = np.bincount(number, minlength=x * y * z)
    mean = np.stack([np.bincount(number, values[within, c], minlength=count.size) for c in range(3)], 1)
    mean = (mean / np.maximum(count, 1)[:, None]).astype(np.float32).reshape(z, y, x, 3)
    nearest = distance_transform_edt((count == 0).reshape(z, y, x), return_distances=False, return_indices=True)
    texture = mi.Texture3f(mi.TensorXf(np.ascontiguousarray(mean[tuple(nearest)])), wrap_mode=dr.WrapMode.Clamp)
    return texture, tuple(map(float, low)), tuple(map(float, shape * edge))

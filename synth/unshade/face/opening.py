"""The opening between the lids of one eye: its two edges and its inner corner."""

from __future__ import annotations

import dataclasses

import numpy as np
from scipy.ndimage import gaussian_filter1d

from .eyeball import clearance
from .geometry import Geometry
from .head import Head
from .lids import between, margin, margin_sides

_STEPS, _BLUR = 160, 2.0
"""Points along each lid, and the blur of its course in points: edges of the mesh are coarser than lashes."""


@dataclasses.dataclass(frozen=True)
class Opening:
    """`upper` and `lower` (K,3) m: where the lids' skin meets the eyeball, from the inner corner outward; `sphere` (4,),
    `turn` (3,3) the eyeball; `side` +1 for the person's left eye, -1 for the right."""

    upper: np.ndarray
    lower: np.ndarray
    sphere: np.ndarray
    turn: np.ndarray
    side: float

    @property
    def corner(self) -> np.ndarray:
        """The inner corner (3,)."""
        return 0.5 * (self.upper[0] + self.lower[0])

    @property
    def height(self) -> float:
        """How far (m) the lids stand apart in the middle."""
        middle = slice(_STEPS // 4, -_STEPS // 4)
        return float(np.median((self.upper - self.lower)[middle, 1]))


def openings(head: Head, geometry: Geometry) -> list[Opening]:
    """Those of the left and the right eye."""
    found = []
    for side, sphere, turn in zip((1.0, -1.0), geometry.eyes, geometry.gaze):
        triangles = head.part_chart
        crossing, fraction, hidden = margin(triangles, clearance(geometry.positions, sphere, turn))
        edge = between(geometry.positions, crossing, fraction)
        lids = margin_sides(triangles, crossing, hidden, edge)
        inner = max((side * edge[lid, 0]).min() for lid in lids)
        outer = min((side * edge[lid, 0]).max() for lid in lids)
        found.append(Opening(*(_course(edge[lid], side, inner, outer) for lid in lids), sphere, turn, side))
    return found


def _course(edge: np.ndarray, side: float, inner: float, outer: float) -> np.ndarray:
    """Points (K,3) evenly spaced in x from `inner` to `outer`, in that order."""
    order = np.argsort(side * edge[:, 0])
    x = np.linspace(inner, outer, _STEPS)
    columns = [np.interp(x, side * edge[order, 0], column) for column in edge[order].T]
    return gaussian_filter1d(np.stack(columns, axis=1), _BLUR, axis=0, mode="nearest")

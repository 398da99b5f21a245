"""How eyelids move over an eyeball: round it, just far enough to close, never through it."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.spatial import cKDTree

from .eyeball import clearance
from .lids import between, margin, margin_sides
from .regions import smoothstep

_LID_REACH = 1.7
"""Skin this near (radii) to an eyeball's centre belongs to its lids."""

_THICKNESS = 0.0012
"""Distance (m) from the eyeball that skin keeps where it slides over it; nearer skin keeps its own."""

_UNROLLED = 0.003
"""Skin that lay in the lid's fold has left it after this way (m)."""

_EDGE = 0.0005, 0.003
"""Within this distance (m) of its margin a lid thins out to nothing."""

_OVERLAP = np.radians(0.6)
"""Closed lids press on each other by this angle, so that no ray slips through."""

_COLUMNS, _SMOOTH = 64, 4.0
"""Columns over the width of the eye, and the standard deviation in columns by which their stretches are blurred."""


def close_lids(
    moved: np.ndarray, offset: np.ndarray, weight: float, triangles: np.ndarray, eye: np.ndarray, gaze: np.ndarray
) -> np.ndarray:
    """Positions (V,3) with the lids of one eye closed by `weight`, 0 to 1.

    `offset` (V,3): where the morph target moves the lids of the average face. Its angles
    round the eyeball are stretched column by column so that at weight 1 the two margins
    meet on this face, whatever the size of its lid opening; `triangles` are the chart's.
    """
    near = np.flatnonzero(np.linalg.norm(offset, axis=1) > 0)
    start, end = moved[near] - eye[:3], moved[near] + offset[near] - eye[:3]
    angle, radius = np.arctan2(start[:, 1], start[:, 2]), np.hypot(start[:, 1], start[:, 2])
    turn = np.zeros(len(moved))
    turn[near] = np.arctan2(end[:, 1] * start[:, 2] - end[:, 2] * start[:, 1], (start[:, 1:] * end[:, 1:]).sum(axis=1))
    stretch = _stretch(moved - eye[:3], turn, triangles, clearance(moved, eye, gaze))
    reach = weight * np.interp(start[:, 0], *stretch)
    angle = angle + reach * turn[near]
    radius = radius + reach * (np.hypot(end[:, 1], end[:, 2]) - radius)
    closed = moved.copy()
    closed[near] = eye[:3] + np.column_stack(
        [start[:, 0] + reach * (end[:, 0] - start[:, 0]), radius * np.sin(angle), radius * np.cos(angle)]
    )
    return closed


def _stretch(
    points: np.ndarray, turn: np.ndarray, triangles: np.ndarray, gap: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The factor on the turns (V,) about the eyeball's x axis that closes the lids, as a curve over x (m)."""
    crossing, fraction, hidden = margin(triangles, gap)
    edge, closing = between(points, crossing, fraction), between(turn, crossing, fraction)
    upper, lower = margin_sides(triangles, crossing, hidden, edge)
    angle = np.arctan2(edge[:, 1], edge[:, 2])
    x = np.linspace(edge[upper, 0].min(), edge[upper, 0].max(), _COLUMNS)

    def column(values: np.ndarray, side: np.ndarray) -> np.ndarray:
        order = np.argsort(edge[side, 0])
        return np.interp(x, edge[side, 0][order], values[side][order])

    opening = column(angle, upper) - column(angle, lower) + _OVERLAP
    way = column(closing, lower) - column(closing, upper)
    # Near the corners both vanish: lean on the mean ratio there, and keep the curve smooth, or the skin would crease.
    mean, ease = opening.sum() / way.sum(), 0.2 * way.max()
    stretch = (opening + ease * mean) / (np.maximum(way, 0) + ease)
    return x, gaussian_filter1d(np.clip(stretch, 0, 2), _SMOOTH, mode="nearest")


def lift_lids(
    resting: np.ndarray, moved: np.ndarray, triangles: np.ndarray, socket: np.ndarray, eye: np.ndarray, gaze: np.ndarray
) -> np.ndarray:
    """Positions (V,3) `moved` by an expression, held to the eyeball they slide over.

    Morph targets move vertices on straight lines, through the eyeball rather than round it,
    and know of no cornea. Each vertex keeps at least the clearance it has in the `resting`
    face; the hidden rim and the socket's skin behind it (vertices `socket`) keep exactly
    their own, so that no gap opens. Skin that unrolls from the fold above the lid, where it
    may touch the eyeball, is lifted clear.
    """
    rest = clearance(resting, eye, np.eye(3))
    crossing, fraction, rim = margin(triangles, rest)
    near = np.flatnonzero(np.linalg.norm(resting - eye[:3], axis=1) < _LID_REACH * eye[3])
    fixed = rim[near]
    fixed[np.isin(near, socket)] = True
    floor = np.where(fixed, rest[near], np.minimum(rest[near], _THICKNESS))
    way = smoothstep(0, _UNROLLED, np.linalg.norm(moved[near] - resting[near], axis=1))
    away = smoothstep(*_EDGE, cKDTree(between(resting, crossing, fraction)).query(resting[near])[0])
    floor += ~fixed * way * np.maximum(away * _THICKNESS - floor, 0)
    change = floor - clearance(moved[near], eye, gaze)
    change = np.where(fixed, change, np.maximum(change, 0))
    outward = moved[near] - eye[:3]
    lifted = moved.copy()
    lifted[near] += outward * (change / np.linalg.norm(outward, axis=1))[:, None]
    return lifted

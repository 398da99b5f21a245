"""From a file's units and axes to the world: metres, +Y up, looking along +Z."""

from __future__ import annotations

import numpy as np

from ..face.spec import FaceError
from ..vectors import vertex_normals
from .piece import Piece
from .spec import UNITS, HeadFiles

NOSE_TO_ORIGIN = 0.11
"""Metres from the tip of the nose to the world's origin, as in generated faces."""

_SIZES = (0.08, 1.2)
"""Metres that the larger side of a head's chart may measure: a mask to a bust."""


def axes(head: HeadFiles) -> np.ndarray:
    """Rotation [3, 3] from the file's axes to the world's."""
    up, forward = _unit(head.up), _unit(head.forward)
    return np.stack([np.cross(up, forward), up, forward])


def in_metres(piece: Piece, head: HeadFiles) -> np.ndarray:
    """Vertices (V,3) f64 in the world's units and axes, the origin as in the file."""
    return piece.vertices @ axes(head).T * UNITS[head.units]


def origin(points: np.ndarray, head: HeadFiles) -> np.ndarray:
    """Origin (3,) in metres, to subtract from the chart's points (V,3) of `in_metres` and the occluders'.

    Without a stated origin it lies amid the chart sideways and in height, and behind its
    foremost point as far as behind a nose's tip. Raises `FaceError` for a size that no head has.
    """
    low, high = points.min(axis=0), points.max(axis=0)
    size = float((high - low).max())
    if not _SIZES[0] <= size <= _SIZES[1]:
        raise FaceError(
            f'{head.mesh}: the chart measures {size:.3g} m in units = "{head.units}"; '
            f"heads measure {_SIZES[0]:g} to {_SIZES[1]:g} m, so state other units or name the head's object in chart"
        )
    if head.origin is not None:
        return np.array(head.origin) @ axes(head).T * UNITS[head.units]
    return middle(points)


def middle(points: np.ndarray) -> np.ndarray:
    """A point (3,) inside the head of the chart's points (V,3), as in `origin`."""
    low, high = points.min(axis=0), points.max(axis=0)
    return np.array([(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, high[2] - NOSE_TO_ORIGIN])


def smooth_normals(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Unit normals (V,3) of vertices (V,3), those in one place sharing theirs: no seam of
    the UVs shows."""
    size = float((points.max(axis=0) - points.min(axis=0)).max())
    places, welded = np.unique(np.round(points / (1e-6 * size)).astype(np.int64), axis=0, return_inverse=True)
    welded = welded.ravel()
    return vertex_normals(places * (1e-6 * size), welded[triangles])[welded]


def _unit(axis: str) -> np.ndarray:
    return (1.0 if axis[0] == "+" else -1.0) * np.eye(3)["xyz".index(axis[1])]

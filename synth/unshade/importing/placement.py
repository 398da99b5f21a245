"""Where an imported head comes to stand: metres, upright, facing +Z, its middle near the origin.

Lights are placed around the origin and the solver's light is found in metres, so a capture of another size
or place is moved as a whole, cameras and mesh alike.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import CaptureError
from .source import Matrix

UNITS = {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001, "in": 0.0254}
"""Metres."""

PLACES = ("auto", "keep", "cameras")

_HEIGHTS = (0.12, 1.0)
"""Extent (m) of what may be a face or a head with its shoulders."""

_USUAL = 0.26
"""Extent (m) that a mesh of unknown scale gets: of a face with its forehead, chin and ears."""

_OFF = 0.3
"""How far (m) a head's middle may be from the origin."""

_UPRIGHT, _FACING = 0.7, 0.4
"""Cosines: of the cameras' mean up to +Y, of the direction to them to +Z."""


@dataclass(frozen=True)
class Placement:
    """The similarity (4, 4) of cameras and mesh, and in words what it does; no words for none. ``upright`` is the
    phrase of the import's last line that says by what the head is upright."""

    matrix: Matrix
    words: tuple[str, ...]
    upright: str


def place(vertices: NDArray[np.float64], cameras: list[Matrix], *, metres: float | None, how: str) -> Placement:
    """``metres`` is the length of the source's unit, where it is known. ``how``: ``keep`` scales alone,
    ``cameras`` stands the head upright by its cameras, ``auto`` does so where it does not stand so already.
    """
    low, high = vertices.min(0), vertices.max(0)
    extent = float((high - low).max())
    if not 0 < extent < np.inf:
        raise CaptureError("the mesh is a single point; export it again")
    words: list[str] = []
    scale = 1.0 if metres is None else metres
    if metres is not None and metres != 1:
        words.append(f"scaled by {metres:g}: one unit of the source is {metres:g} m")
    elif metres is None and not _HEIGHTS[0] <= extent <= _HEIGHTS[1]:
        scale = _USUAL / extent
        words.append(
            f"scaled by {scale:.6g}: the mesh extends over {extent:.4g} units, taken for {_USUAL} m; state the unit if it is known"
        )
    matrix = np.diag([scale, scale, scale, 1.0])
    if how == "keep":
        return Placement(matrix, tuple(words), "head kept as the source has it")
    middle = (low + high) / 2
    ups = np.array([camera[:3, 1] for camera in cameras])
    away = np.array([camera[:3, 3] - middle for camera in cameras])
    away /= np.linalg.norm(away, axis=1, keepdims=True).clip(1e-12)
    up, front = _unit(ups.mean(0)), _unit(away.mean(0))
    stands = up[1] >= _UPRIGHT and front[2] >= _FACING
    near = float(np.linalg.norm(middle)) * scale <= _OFF
    upright = "head upright as the source has it"
    if how == "auto" and stands and near:
        return Placement(matrix, tuple(words), upright)
    if how == "auto" and stands:
        # Upright, but far away: it is moved and nothing else.
        rotation = np.eye(3)
    else:
        forward = _unit(front - up * (front @ up))
        if not np.isfinite(forward).all() or abs(front @ up) > 0.99:
            raise CaptureError(
                "the cameras do not say which way is up; turn the capture upright and keep its place (--place keep)"
            )
        rotation = np.stack([np.cross(up, forward), up, forward])
        upright = "head upright by the cameras' mean up"
        words.append(
            "turned: +Y is the mean of the cameras' up, +Z points from the mesh's middle to their mean direction"
        )
    moved = np.eye(4)
    moved[:3, :3] = rotation * scale
    moved[:3, 3] = -rotation @ middle * scale
    words.append("moved: the mesh's middle is the origin")
    return Placement(moved, tuple(words), upright)


def _unit(vector: NDArray[np.float64]) -> NDArray[np.float64]:
    length = float(np.linalg.norm(vector))
    return vector / length if length > 1e-9 else np.full(3, np.nan)

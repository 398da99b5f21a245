"""Where an imported head comes to stand: metres, upright, facing +Z, its middle near the origin.

Lights are placed around the origin and the solver's light is found in metres, so a capture of another size
or place is moved as a whole, cameras and mesh alike.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import CaptureError
from ..vectors import unit
from .source import Matrix

UNITS = {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001, "in": 0.0254}
"""Metres."""

KEPT_PLACE = "keep"

PLACES = ("auto", KEPT_PLACE, "cameras")

_HEIGHTS = (0.12, 1.0)
"""Extent (m) of what may be a face or a head with its shoulders."""

_USUAL = 0.26
"""Extent (m) that a mesh of unknown scale gets: of a face with its forehead, chin and ears."""

_OFF = 0.3
"""How far (m) a head's middle may be from the origin."""

_UPRIGHT, _FACING = 0.7, 0.4
"""Cosines: of up to +Y, of the direction to the cameras to +Z."""

_SQUARE = 0.95
"""Cosine to +Y of the cameras' sides from which photographs lie on their sides in a world that is upright."""

_AGREE = 0.5
"""Length of the mean of unit vectors below which they have no common direction."""

_LYING = 0.1
"""By how much the mean of the cameras' sides is longer than that of their ups if photographs lie on their sides."""

_FREE = np.deg2rad(120)
"""Largest angle (rad) without a camera around a head that is captured all round."""

_BALANCED = 0.3
"""Length of the mean of the cameras' azimuths, as unit vectors, up to which no side has more of them."""

_STEEP = 0.2
"""Cosine to the horizontal below which a camera has no azimuth."""


@dataclass(frozen=True)
class Placement:
    """The similarity (4, 4) of cameras and mesh, described in words (none for the identity).

    ``upright`` and ``front`` are phrases for the evidence of up and front; ``warnings`` are sentences on possible
    faults.
    """

    matrix: Matrix
    words: tuple[str, ...]
    upright: str
    front: str
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True)
class UpDirections:
    """The direction (N, 3) that points up in each photograph as it is shown, and of how many EXIF turns it."""

    directions: NDArray[np.float64]
    turned: int


_ALL_ROUND = "cameras surround the head: the azimuth is the source's"


def place(
    vertices: NDArray[np.float64],
    cameras: list[Matrix],
    shown: UpDirections,
    *,
    metres: float | None,
    how: str,
    facing: tuple[str, int] | None = None,
) -> Placement:
    """Returns where cameras and mesh come to stand.

    ``metres`` is the length of the source's unit, where it is known. ``how``: ``keep`` scales alone,
    ``cameras`` stands the head upright by its cameras, ``auto`` does so where it does not stand so already.
    ``facing`` is the name and number of a view that looks at the face. Without it the cameras' mean direction
    is the front, unless they stand all round. Raises `CaptureError`.
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
    if how == KEPT_PLACE:
        if facing is not None:
            raise CaptureError(f"front turns the head and place {KEPT_PLACE} leaves it; state one of them")
        return Placement(matrix, tuple(words), "head kept as the source has it", "kept")
    middle = (low + high) / 2
    up, upright, warnings = _up(cameras, shown, source_may_stand=how == "auto")
    front, evidence = _front(np.array([camera[:3, 3] - middle for camera in cameras]), up, facing)
    if front is None:
        warnings.append("the cameras surround the head, so its azimuth is kept; name a frontal view (front)")
    turn = np.eye(3)
    stands = up[1] >= _UPRIGHT and (front is None or front[2] >= _FACING)
    if how != "auto" or facing is not None or not stands:
        turn = _shortest_turn(up) if front is None else np.stack([np.cross(up, front), up, front])
        words.append(f"turned: +Y is up {upright}, +Z is the front, {evidence}")
    if not np.array_equal(turn, np.eye(3)) or float(np.linalg.norm(middle)) * scale > _OFF:
        matrix[:3, :3] = turn * scale
        matrix[:3, 3] = -turn @ middle * scale
        words.append("moved: the mesh's middle is the origin")
    return Placement(matrix, tuple(words), f"head upright {upright}", evidence, tuple(warnings))


def _up(
    cameras: list[Matrix], shown: UpDirections, *, source_may_stand: bool
) -> tuple[NDArray[np.float64], str, list[str]]:
    """The unit vector that is up, its evidence in words, and warnings."""
    sides, ups = (np.array([camera[:3, axis] for camera in cameras]).mean(0) for axis in (0, 1))
    seen = shown.directions.mean(0)
    # Where EXIF turns some photographs of many, tags that were kept when pixels were turned spread the ups.
    if shown.turned and np.linalg.norm(seen) >= np.linalg.norm(ups):
        return _agreed(seen), f"by EXIF orientation of {shown.turned} photographs", []
    upright = "by the cameras' mean up"
    if shown.turned:
        upright += f", with which EXIF orientation of {shown.turned} photographs does not agree"
    if source_may_stand and not _unit(ups)[1] >= _UPRIGHT:
        for side, lie in ((sides, "on their sides"), (-sides, "on their sides"), (-ups, "upside down")):
            if np.linalg.norm(side) >= _AGREE and _unit(side)[1] >= _SQUARE:
                return np.array([0.0, 1.0, 0.0]), f"as in the source, where photographs lie {lie}", []
    warnings: list[str] = []
    if np.linalg.norm(sides) > np.linalg.norm(ups) + _LYING:
        warnings.append(
            "the photographs seem to be rotated by 90 degrees, and EXIF does not state the direction; if the head does so too, turn mesh "
            "and cameras upright and keep their place (place keep)"
        )
    return _agreed(ups), upright, warnings


def _agreed(mean: NDArray[np.float64]) -> NDArray[np.float64]:
    if not np.linalg.norm(mean) >= _AGREE:
        raise CaptureError(
            f"the photographs do not agree which way is up (their mean up has a length of {np.linalg.norm(mean):.2f}); "
            "turn the capture upright and keep its place (place keep)"
        )
    return _unit(mean)


def _front(
    away: NDArray[np.float64], up: NDArray[np.float64], facing: tuple[str, int] | None
) -> tuple[NDArray[np.float64] | None, str]:
    """The horizontal unit vector to the front, and its evidence in words; None without evidence.

    ``away`` (N, 3) are the cameras' positions from the mesh's middle.
    """
    away = unit(away)
    level = away - np.outer(away @ up, up)
    if facing is not None:
        name, number = facing
        if np.linalg.norm(level[number]) < _STEEP:
            raise CaptureError(f"front: {name} looks from above or below; name a view that looks at the face")
        return _unit(level[number]), f"where {name} looks from"
    level = level[np.linalg.norm(level, axis=1) >= _STEEP]
    if not len(level):
        return None, _ALL_ROUND
    level = unit(level)
    angles = np.sort(np.arctan2(np.cross(level[0], level) @ up, level @ level[0]))
    free = np.diff(angles, append=angles[0] + 2 * np.pi).max()
    mean = level.mean(0)
    if free <= _FREE or np.linalg.norm(mean) < _BALANCED:
        return None, _ALL_ROUND
    return _unit(mean), "the cameras' mean direction"


def _shortest_turn(up: NDArray[np.float64]) -> NDArray[np.float64]:
    """The rotation (3, 3) by the smallest angle that turns ``up`` to +Y."""
    if up[1] < -0.999:
        return np.diag([1.0, -1.0, -1.0])
    x, _, z = np.cross(up, [0.0, 1.0, 0.0])
    cross = np.array([[0.0, -z, 0.0], [z, 0.0, -x], [0.0, x, 0.0]])
    return np.eye(3) + cross + cross @ cross / (1 + up[1])


def _unit(vector: NDArray[np.float64]) -> NDArray[np.float64]:
    length = float(np.linalg.norm(vector))
    return vector / length if length > 1e-9 else np.full(3, np.nan)

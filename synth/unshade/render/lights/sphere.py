"""Patterns on a light stage's sphere: spherical gradients and binary patterns.

Full-on lamps have radiance 1 before exposure, so patterns of one set share an exposure
and may be added, subtracted and divided, as photometric methods do.
"""

from __future__ import annotations

import numpy as np

from ...scene_file.light import Gradient, Pattern
from .conventions import LATLONG, averaged, directions
from .dome import Dome
from .envmap import Environment

_AXES = {"x": 0, "y": 1, "z": 2}
_FINE = 4


class StagePattern(Environment):
    """An environment whose brightest lamps are fully on before exposure."""


def gradient(settings: Gradient) -> Dome | StagePattern:
    """The linear gradient of Ma et al. 2007, "Rapid Acquisition of Specular and Diffuse
    Normal Maps from Polarized Spherical Gradient Illumination"."""
    if settings.axis == "full":
        return Dome()
    towards, row = directions(*LATLONG, _FINE)
    return _environment((1 + _along(towards, settings.axis)) / 2, row)


def pattern(settings: Pattern) -> StagePattern:
    towards, row = directions(*LATLONG, _FINE)
    along = _along(towards, settings.axis)
    if settings.pattern == "half":
        lit = along > 0
    elif settings.pattern == "stripes":
        # Bands of equal height on a sphere are of equal solid angle (Archimedes).
        lit = _steps((1 - along) / 2, settings.count) % 2 == 0
    else:
        lit = _hadamard(towards, along, settings)
    return _environment((lit ^ settings.inverse).astype(float), row)


def _hadamard(towards: np.ndarray, along: np.ndarray, settings: Pattern) -> np.ndarray:
    """Where row ``index`` of Sylvester's matrix is +1, cell by cell: bands across the
    axis, each cut into sectors around it."""
    bits = settings.order.bit_length() - 1
    bands, sectors = 1 << bits // 2, 1 << bits - bits // 2
    axis = _AXES[settings.axis[0]]
    turn = np.arctan2(towards[..., (axis + 2) % 3], towards[..., (axis + 1) % 3]) / (2 * np.pi) % 1
    cell = _steps((1 - along) / 2, bands) * sectors + _steps(turn, sectors)
    parity = np.array([(settings.index & number).bit_count() % 2 for number in range(settings.order)])
    return parity[cell] == 0


def _along(towards: np.ndarray, axis: str) -> np.ndarray:
    return towards[..., _AXES[axis[0]]] * (1 if axis[1] == "+" else -1)


def _steps(fraction: np.ndarray, count: int) -> np.ndarray:
    """Fractions 0 to 1 as whole numbers 0 to ``count`` - 1."""
    return np.floor(fraction * count).astype(int).clip(0, count - 1)


def _environment(values: np.ndarray, row: np.ndarray) -> StagePattern:
    picture = averaged(values, row, _FINE)
    return StagePattern(np.repeat(picture[..., None], 3, 2).astype(np.float32))

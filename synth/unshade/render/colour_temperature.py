"""Correlated colour temperature of a linear Rec.709 colour.

The Planckian locus is Krystek's (1985, "An algorithm to calculate correlated colour
temperature"), the nearest point of which in CIE 1960 UCS is the correlated temperature.
"""

from __future__ import annotations

import numpy as np

_TO_XYZ = np.array(
    [[0.4123908, 0.3575843, 0.1804808], [0.2126390, 0.7151687, 0.0721923], [0.0193308, 0.1191948, 0.9505322]]
)
"""Linear Rec.709 to CIE XYZ (D65)."""

_KELVIN = np.geomspace(1000, 15000, 4000)
"""The range in which Krystek's fit holds."""

FARTHEST = 0.05
"""Distance from the locus (CIE 1960) beyond which a temperature means nothing (CIE 15)."""


def correlated_kelvin(rgb: np.ndarray) -> float | None:
    """Kelvin, or ``None`` for black and for colours too far from any black body's."""
    x, y, z = _TO_XYZ @ np.asarray(rgb, float)
    weight = x + 15 * y + 3 * z
    if weight <= 0:
        return None
    distance = np.hypot(*(_locus() - np.array([[4 * x], [6 * y]]) / weight))
    nearest = int(distance.argmin())
    inside = 0 < nearest < len(_KELVIN) - 1
    return float(_KELVIN[nearest]) if inside and distance[nearest] < FARTHEST else None


def _locus() -> np.ndarray:
    """u and v [2, N] of black bodies."""
    t = _KELVIN
    u = (0.860117757 + 1.54118254e-4 * t + 1.28641212e-7 * t**2) / (1 + 8.42420235e-4 * t + 7.08145163e-7 * t**2)
    v = (0.317398726 + 4.22806245e-5 * t + 4.20481691e-8 * t**2) / (1 - 2.89741816e-5 * t + 1.61456053e-7 * t**2)
    return np.stack([u, v])

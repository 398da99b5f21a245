"""The sRGB transfer curve (IEC 61966-2-1)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

_LINEAR_END, _CODE_END = 0.0031308, 0.04045
"""Where the straight part of the curve ends."""


def encoded(linear: NDArray[Any]) -> NDArray[Any]:
    """Returns the codes of linear values, 0 to 1 for 0 to 1, in the precision of ``linear``."""
    power = np.maximum(linear, _LINEAR_END) ** (1 / 2.4)
    return np.where(linear <= _LINEAR_END, 12.92 * linear, 1.055 * power - 0.055)


def decoded(codes: NDArray[Any]) -> NDArray[Any]:
    """Returns the linear values of codes, in the precision of ``codes``."""
    power = ((np.maximum(codes, _CODE_END) + 0.055) / 1.055) ** 2.4
    return np.where(codes <= _CODE_END, codes / 12.92, power)


def slope(linear: NDArray[Any]) -> NDArray[Any]:
    """Returns the derivative of `decoded` at the codes of linear values."""
    power = np.maximum(linear, _LINEAR_END) ** (1.4 / 2.4)
    return np.where(linear <= _LINEAR_END, 1 / 12.92, 2.4 / 1.055 * power)

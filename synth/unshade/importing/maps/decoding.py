"""From another method's codes to the numbers of a maps folder, by a statement."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .counterpart import Counterparts, Layout
from .statement import AUTO, Texture
from .texture import Codes, Floats, linear

LEVEL, SHARE, GLASS = 0.08, 0.05, 0.04
"""Reflectance of a specular level of 1, of a share of 1, and of what is not metal."""


def curve_of(texture: Texture, *, colour: bool, exact: bool) -> str:
    """The curve; where none is stated, integers of colours are sRGB and everything else is linear."""
    if texture.curve != AUTO:
        return texture.curve
    return "srgb" if colour and not exact else "linear"


def scalar(codes: Codes, texture: Texture) -> Floats:
    """One linear channel (N,N) of a map."""
    values = linear(codes.plane(texture.channel), curve_of(texture, colour=False, exact=codes.exact))
    return values * np.float32(texture.scale)


def reflectance(values: Floats, kind: str) -> Floats:
    """Specular albedo, reflectance at normal incidence, of numbers that are ``kind``."""
    if kind == "level":
        return values * np.float32(LEVEL)
    if kind == "share":
        return values * np.float32(SHARE)
    if kind == "ior":
        return ((values - 1) / np.maximum(values + 1, 1e-3)) ** 2
    if kind == "metalness":
        return np.float32(GLASS) * (1 - values)
    return values


def alpha(values: Floats, kind: str) -> Floats:
    """GGX alpha of numbers that are ``kind``, above 0 and at most 1."""
    if kind == "perceptual":
        values = values**2
    elif kind == "gloss":
        values = (1 - values).clip(0) ** 2
    elif kind == "alpha-squared":
        values = np.sqrt(values.clip(0))
    return values.clip(1e-3, 1)


def vectors(codes: Codes) -> Floats:
    """Normals (N,N,3) of a picture as it codes them: n/2 + 1/2 in integers and in floats without negative ones."""
    if codes.exact and codes.values.min() < -0.05:
        return codes.values
    return 2 * codes.values - 1


def normals(
    values: NDArray[np.float32],
    kind: str,
    green: str,
    layout: Layout,
    counterparts: Counterparts,
    turn: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Unit normals (M,3) in the capture's space of vectors (M,3) at the counterparts; NaN where there is none.

    Tangent space is that of the other mesh in its place beside the capture; ``turn`` (3,3) takes object space there.
    """
    if kind == "tangent":
        t, b, n = layout.frames(counterparts)
        sign = -1.0 if green == "down" else 1.0
        found = values[:, :1] * t + sign * values[:, 1:2] * b + values[:, 2:] * n
    else:
        found = values.astype(np.float64) @ turn.T
    length = np.linalg.norm(found, axis=1, keepdims=True)
    return np.where(length > 0.2, found / np.where(length > 0.2, length, 1), np.nan)

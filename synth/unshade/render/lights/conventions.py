"""Directions, lat-long pictures and colours as Mitsuba has them.

d = (sin t sin p, cos t, -sin t cos p) with p = 2 pi u at column centres u = (i + .5)/W, and
t = pi v with rows at v = j/(H - 1), so that the first and last row lie on the poles.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...vectors import away

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
LATLONG = (256, 512)
"""Height and width of a light's lat-long picture, unless it is an environment map."""


def directions(height: int, width: int, fine: int) -> tuple[np.ndarray, np.ndarray]:
    """Unit directions [rows, width * fine, 3] of ``fine`` x ``fine`` points per texel, and
    the texel row of each; texels on the poles are half as high."""
    v = (np.arange((height - 1) * fine) + 0.5) / fine if fine > 1 else np.arange(height)
    row = np.floor(v + 0.5).astype(int)
    theta = np.pi * v / (height - 1)
    phi = 2 * np.pi * (np.arange(width * fine) + 0.5) / (width * fine)
    t, p = np.meshgrid(theta, phi, indexing="ij")
    return np.stack([np.sin(t) * np.sin(p), np.cos(t), -np.sin(t) * np.cos(p)], -1), row


def averaged(picture: np.ndarray, row: np.ndarray, fine: int) -> np.ndarray:
    """Texels [H, W] of values at the points of `directions`."""
    columns = picture.reshape(len(row), -1, fine).mean(2)
    sums = np.zeros((row[-1] + 1, columns.shape[1]))
    np.add.at(sums, row, columns)
    return sums / np.bincount(row)[:, None]


def bilinear(picture: np.ndarray, towards: np.ndarray) -> np.ndarray:
    """Values [..., 3] of a lat-long picture [H, W, 3] in unit directions [..., 3], of its type."""
    height, width = picture.shape[:2]
    line = np.arccos(towards[..., 1].clip(-1, 1)) / np.pi * (height - 1)
    column = np.arctan2(towards[..., 0], -towards[..., 2]) / (2 * np.pi) * width - 0.5
    top, left = np.floor(line).astype(int).clip(0, height - 2), np.floor(column).astype(int)
    down, across = (line - top)[..., None], (column - left)[..., None]
    rows = [
        picture[row, left % width] * (1 - across) + picture[row, (left + 1) % width] * across for row in (top, top + 1)
    ]
    return (rows[0] * (1 - down) + rows[1] * down).astype(picture.dtype)


def solid_angles(height: int, width: int) -> np.ndarray:
    """Solid angle (sr) of a texel of every row [H]."""
    edges = np.pi * (np.arange(height + 1) - 0.5).clip(0, height - 1) / (height - 1)
    return (2 * np.pi / width) * (np.cos(edges[:-1]) - np.cos(edges[1:]))


def deposit(picture: np.ndarray, direction: np.ndarray, energy: np.ndarray) -> None:
    """Adds a source too small for the texels [H, W, 3]: ``energy`` (radiance x solid angle,
    RGB) goes to the four texels around its direction, so that its mean direction stays."""
    height, width = picture.shape[:2]
    x, y, z = direction / np.linalg.norm(direction)
    line = math.acos(min(max(y, -1.0), 1.0)) / math.pi * (height - 1)
    column = math.atan2(x, -z) / (2 * math.pi) * width - 0.5
    top, left = min(math.floor(line), height - 2), math.floor(column)
    solid = solid_angles(height, width)
    for j, down in ((top, 1 - (line - top)), (top + 1, line - top)):
        for i, across in ((left, 1 - (column - left)), (left + 1, column - left)):
            picture[j, i % width] += down * across * energy / solid[j]


def around(azimuth_degrees: float, elevation_degrees: float, distance: float) -> np.ndarray:
    """A place seen from the head: azimuth 0 in front of the face, positive towards +X."""
    return distance * away(*np.radians([azimuth_degrees, elevation_degrees]))


def rgb(value: float | np.ndarray) -> dict[str, Any]:
    """Linear Rec.709 for Mitsuba, of one number or of three."""
    return {"type": "rgb", "value": np.broadcast_to(np.asarray(value, float), (3,)).tolist()}


def grey(value: float | np.ndarray) -> bool:
    return np.ndim(value) == 0

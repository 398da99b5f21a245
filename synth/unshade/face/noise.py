"""Noise over template space, so that one pattern runs across chart, rest of the head and any texture size."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import map_coordinates

_PERIOD = 48
# Standard deviation of uniform noise (0..1) under the 3-D quadratic B-spline: its squared weights average (66/120)^3.
_LATTICE_SD = np.sqrt(1 / 12 * (66 / 120) ** 3)


def smooth_noise(points: np.ndarray, wavelength: float, rng: np.random.Generator) -> np.ndarray:
    """Smooth noise (M,) f32 of zero mean and unit variance at points (M,3), lattice step `wavelength` in the same unit.

    A quadratic B-spline over a periodic lattice of random values: once differentiable,
    as a height field needs.
    """
    lattice = (rng.random((_PERIOD,) * 3, dtype=np.float32) - np.float32(0.5)) / np.float32(_LATTICE_SD)
    place = (points.T / wavelength).astype(np.float32)
    return map_coordinates(lattice, place, order=2, mode="grid-wrap", prefilter=False, output=np.float32)


def octaves(points: np.ndarray, longest: float, count: int, finest: float, rng: np.random.Generator) -> np.ndarray:
    """Sum of `count` octaves of `smooth_noise`, gain 0.6; wavelengths under `finest` are left out, not aliased.

    Amplitudes do not depend on `finest`: a small texture is the large one without its detail.
    """
    total = np.zeros(len(points), dtype=np.float32)
    gains = 0.6 ** np.arange(count)
    for k, child in enumerate(rng.spawn(count)):
        if longest / 2**k >= finest:
            total += np.float32(gains[k] / np.linalg.norm(gains)) * smooth_noise(points, longest / 2**k, child)
    return total


def cells(places: np.ndarray, spacing: float, rng: np.random.Generator) -> np.ndarray:
    """Distance (M,) f32 to the nearest point of a jittered grid over places (M,2), in units of `spacing`."""
    scaled = (places / spacing).astype(np.float32)
    cell = np.floor(scaled).astype(np.int64)
    low = cell.min(axis=0) - 1
    extent = cell.max(axis=0) - low + 2
    jitter = rng.random((extent[0], extent[1], 2), dtype=np.float32)
    within, cell = scaled - cell.astype(np.float32), cell - low
    nearest = np.full(len(places), np.inf, dtype=np.float32)
    for dx in (-1, 0, 1):
        for dy in (-1, 0, 1):
            step = jitter[cell[:, 0] + dx, cell[:, 1] + dy]
            across = step[:, 0] + np.float32(dx) - within[:, 0]
            along = step[:, 1] + np.float32(dy) - within[:, 1]
            np.minimum(nearest, across * across + along * along, out=nearest)
    return np.sqrt(nearest)

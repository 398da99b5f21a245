"""Noise over template space, so that one pattern runs across chart, rest of the head and any texture size."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
from scipy.ndimage import map_coordinates

_PERIOD = 48
_PART, _THREADS = 1 << 19, 2
# Standard deviation of uniform noise (0..1) under the 3-D quadratic B-spline: its squared weights average (66/120)^3.
_LATTICE_SD = np.sqrt(1 / 12 * (66 / 120) ** 3)


def smooth_noise(points: np.ndarray, wavelength: float, rng: np.random.Generator) -> np.ndarray:
    """Smooth noise (M,) f32 of zero mean and unit variance at points (M,3), lattice step `wavelength` in the same unit.

    A quadratic B-spline over a periodic lattice of random values: once differentiable,
    as a height field needs.
    """
    lattice = (rng.random((_PERIOD,) * 3, dtype=np.float32) - np.float32(0.5)) / np.float32(_LATTICE_SD)
    out = np.empty(len(points), dtype=np.float32)

    def fill(part: slice) -> None:
        place = (points[part].T / wavelength).astype(np.float32)
        map_coordinates(lattice, place, order=2, mode="grid-wrap", prefilter=False, output=out[part])

    # The interpolation leaves the interpreter free, so two parts run side by side.
    parts = [slice(start, start + _PART) for start in range(0, len(points), _PART)]
    if len(parts) == 1:
        fill(parts[0])
    else:
        with ThreadPoolExecutor(_THREADS) as pool:
            list(pool.map(fill, parts))
    return out


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

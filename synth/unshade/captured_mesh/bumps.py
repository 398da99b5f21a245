"""Bumps that matching noise leaves on a reconstructed surface."""

from __future__ import annotations

import numpy as np

from ..vectors import twice_areas

_WAVES = 200
"""Enough that their sum is Gaussian (central limit theorem)."""


def bump_heights(
    positions: np.ndarray, triangles: np.ndarray, rms: float, wavelength: float, rng: np.random.Generator
) -> np.ndarray:
    """Heights (V,) at positions (V,3), all in metres: zero mean and ``rms`` over the surface.

    Random plane waves in space: isotropic directions and phases, one wavelength. A surface
    cuts the waves at a slant, so bumps on it are of this wavelength and longer ones, and
    heights r apart correlate by sin(2 pi r / wavelength) / (2 pi r / wavelength).
    """
    directions = rng.standard_normal((_WAVES, 3))
    directions *= 2 * np.pi / wavelength / np.linalg.norm(directions, axis=1, keepdims=True)
    phases = rng.uniform(0, 2 * np.pi, _WAVES)
    heights = np.zeros(len(positions))
    for direction, phase in zip(directions, phases):
        heights += np.cos((positions * direction).sum(1) + phase)
    areas = twice_areas(positions, triangles)
    weight = sum(np.bincount(triangles[:, k], areas, minlength=len(positions)) for k in range(3))
    weight /= weight.sum()
    heights -= (weight * heights).sum()
    return heights * (rms / np.sqrt((weight * heights**2).sum()))

"""Real spherical harmonics, and what they shade a Lambert surface with."""

from __future__ import annotations

import numpy as np
from scipy.special import sph_harm_y

_COSINE_LOBE = {0: 1.0, 1: 2 / 3, 2: 1 / 4, 3: 0.0, 4: -1 / 24}
"""The cosine lobe over pi by degree (Ramamoorthi and Hanrahan 2001, "An Efficient Representation for
Irradiance Environment Maps")."""


def sky_directions(rows: int) -> np.ndarray:
    """Unit vectors (rows, 2 rows, 3) to the cells of a lat-long environment, whose first row is up and centre +Z."""
    theta = np.pi * (np.arange(rows) + 0.5) / rows
    phi = np.pi * (np.arange(2 * rows) + 0.5) / rows
    t, p = np.meshgrid(theta, phi, indexing="ij")
    return np.stack([np.sin(t) * np.sin(p), np.cos(t), -np.sin(t) * np.cos(p)], -1)


def harmonics(directions: np.ndarray, order: int) -> np.ndarray:
    """(..., (order + 1)^2) of unit vectors (..., 3), orthonormal, degree by degree."""
    x, y, z = np.moveaxis(directions, -1, 0)
    theta, phi = np.arccos(np.clip(z, -1, 1)), np.arctan2(y, x)
    found = []
    for degree in range(order + 1):
        for m in range(-degree, degree + 1):
            value = sph_harm_y(degree, abs(m), theta, phi)
            found.append(value.real if m == 0 else np.sqrt(2) * (value.real if m > 0 else value.imag))
    return np.stack(found, -1)


def irradiance(normals: np.ndarray, order: int) -> np.ndarray:
    """(..., (order + 1)^2): irradiance / pi that each harmonic gives an unshadowed surface of unit normals (..., 3)."""
    lobe = [_COSINE_LOBE[degree] for degree in range(order + 1) for _ in range(2 * degree + 1)]
    return harmonics(normals, order) * lobe

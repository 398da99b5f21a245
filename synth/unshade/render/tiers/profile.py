"""Profile radius and medium albedo of both subsurface tiers from one mean free path.

Both describe a semi-infinite medium with isotropic scattering and without a step of the
refractive index at its surface. It is given by its mean free path l and by the albedo A
that it shows under diffuse light, per channel:

- Christensen and Burley 2015 (Pixar memo 15-04, "Approximate Reflectance Profiles for
  Efficient Subsurface Scattering"): R(r) = (e^(-r/d) + e^(-r/3d)) / (8 pi d r) with d = l/s,
  s = 1.9 - A + 3.5 (A - 0.8)^2 for diffuse light; its integral over the plane is 1.
- The single-scattering albedo of the medium as a function of A: Kulla and Conty 2017
  ("Revisiting Physically Based Shading at Imageworks", SIGGRAPH course).
"""

from __future__ import annotations

import numpy as np

HIGHEST_ALBEDO = 0.99
"""Above it a medium scatters for hundreds of mean free paths; no skin comes near."""

REACH = 13.0
"""Scale radii d within which 99 % of the profile lie."""


def scale_radius(mean_free_path: np.ndarray, albedo: np.ndarray) -> np.ndarray:
    """d of the profile, in the unit of ``mean_free_path``."""
    a = np.clip(albedo, 0, 1)
    return mean_free_path / (1.9 - a + 3.5 * (a - 0.8) ** 2)


def density(r: np.ndarray, d: np.ndarray) -> np.ndarray:
    """R(r): share of the light that leaves per unit of area at distance r > 0."""
    return (np.exp(-r / d) + np.exp(-r / (3 * d))) / (8 * np.pi * d * r)


def within(r: np.ndarray, d: np.ndarray) -> np.ndarray:
    """Share of the light that leaves within the distance r."""
    return 1 - 0.25 * np.exp(-r / d) - 0.75 * np.exp(-r / (3 * d))


def single_scattering(albedo):
    """Single-scattering albedo of the medium that shows ``albedo`` (numpy arrays)."""
    c = np.clip(albedo, 0, HIGHEST_ALBEDO)
    return 1 - (4.09712 + 4.20863 * c - np.sqrt(9.59217 + 41.6808 * c + 17.7126 * c * c)) ** 2

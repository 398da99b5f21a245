"""Closed-form results for the half space: the yardsticks of the subsurface tiers.

The medium scatters isotropically and its surface does not refract. Lengths are mean free paths.
"""

from __future__ import annotations

import numpy as np

_MU, _WEIGHT = ((a + s) / 2 for a, s in zip(np.polynomial.legendre.leggauss(64), (1, 0)))


def h_function(alpha: float, mu: np.ndarray | float) -> np.ndarray:
    """Chandrasekhar's H for isotropic scattering (Radiative Transfer 1950, chapter V) by iteration."""
    root, h = np.sqrt(1 - alpha), np.ones_like(_MU)
    for _ in range(3000):
        h = (h + 1 / (root + _integral(alpha, h, _MU))) / 2
    return 1 / (root + _integral(alpha, h, np.atleast_1d(mu)))


def _integral(alpha: float, h: np.ndarray, mu: np.ndarray) -> np.ndarray:
    return alpha / 2 * (_MU * h * _WEIGHT / (_MU + mu[:, None])).sum(1)


def radiance_under_even_light(alpha: float, mu: np.ndarray | float) -> np.ndarray:
    """Radiance that leaves at cosine ``mu`` where radiance 1 arrives from everywhere."""
    return 1 - h_function(alpha, mu) * np.sqrt(1 - alpha)


def diffuse_albedo(alpha: float) -> float:
    """Exitance over irradiance under even light."""
    return float(2 * (radiance_under_even_light(alpha, _MU) * _MU * _WEIGHT).sum())


def reflectance(alpha: float, mu_in: float, mu_out: float) -> float:
    """pi x BRDF: what a Lambert surface's albedo would have to be in these directions."""
    h_in, h_out = h_function(alpha, np.array([mu_in, mu_out]))
    return float(alpha / 4 * h_in * h_out / (mu_in + mu_out))


def searchlight(alpha: float, photons: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Distances from the entry at which photons of diffuse incidence leave, and their weights.

    Analogue walks in numpy: nothing here is shared with the renderer.
    """
    rng = np.random.default_rng(seed)
    place, direction = np.zeros((photons, 3)), _sphere(rng, photons)
    direction[:, 2] = -np.sqrt(rng.uniform(size=photons))  # cosine-distributed, downward
    level = np.sqrt(1 - direction[:, 2] ** 2) / np.linalg.norm(direction[:, :2], axis=1)
    direction[:, :2] *= level[:, None]
    weight = np.ones(photons)
    distances, weights = [], []
    while len(place):
        step = rng.exponential(size=len(place))
        ahead = place + direction * step[:, None]
        out = ahead[:, 2] > 0
        surface = place[out] - direction[out] * (place[out, 2] / direction[out, 2])[:, None]
        distances.append(np.linalg.norm(surface[:, :2], axis=1))
        weights.append(weight[out])
        place, weight = ahead[~out], weight[~out] * alpha
        survival = np.where(weight < 0.1, 0.5, 1.0)
        kept = rng.uniform(size=len(place)) < survival
        place, weight = place[kept], (weight / survival)[kept]
        direction = _sphere(rng, len(place))
    return np.concatenate(distances), np.concatenate(weights) / photons


def _sphere(rng: np.random.Generator, count: int) -> np.ndarray:
    v = rng.normal(size=(count, 3))
    return v / np.linalg.norm(v, axis=1, keepdims=True)

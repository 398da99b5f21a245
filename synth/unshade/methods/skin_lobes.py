"""Skin's highlights in light from everywhere, by quadrature of the material that all maps are for."""

from __future__ import annotations

import functools

import numpy as np

from ..render.ggx import density, masking, schlick
from ..render.skin_bsdf import LOBE_ALPHAS, LOBE_WEIGHTS
from ..vectors import unit

_ANGLES = np.radians(np.linspace(0, 84, 43))
_STEPS = (400, 800)
"""Elevations and azimuths of the quadrature: the sharper lobe is some 9 degrees wide."""


def reflected(view: np.ndarray, light: np.ndarray) -> np.ndarray:
    """Highlights' BRDF times cosine over rho_s / F0, for unit vectors (..., 3) in the frame of the normal."""
    half = unit(view + light)
    v, l, h = np.maximum(view[..., 2], 1e-4), np.maximum(light[..., 2], 1e-4), half[..., 2]
    total = sum(
        weight * density(h**2, alpha**2) * masking(v, alpha) * masking(l, alpha) / (4 * v)
        for alpha, weight in zip(LOBE_ALPHAS, LOBE_WEIGHTS)
    )
    return np.where(light[..., 2] > 0, total * schlick((view * half).sum(-1)), 0)


@functools.cache
def _tables() -> tuple[np.ndarray, np.ndarray]:
    """For each of the angles: the reflected share of light from everywhere, and the angle from the view to the mean
    direction of what reflects it."""
    z = (np.arange(_STEPS[0]) + 0.5) / _STEPS[0]
    phi = (np.arange(_STEPS[1]) + 0.5) / _STEPS[1] * 2 * np.pi
    z, phi = np.meshgrid(z, phi, indexing="ij")
    s = np.sqrt(1 - z * z)
    light = np.stack([s * np.cos(phi), s * np.sin(phi), z], -1)
    solid = 2 * np.pi / z.size
    albedos, turns = [], []
    for angle in _ANGLES:
        view = np.array([np.sin(angle), 0, np.cos(angle)])
        value = reflected(np.broadcast_to(view, light.shape), light)
        mean = (value[..., None] * light).sum((0, 1))
        albedos.append(value.sum() * solid)
        turns.append(angle - np.arctan2(mean[0], mean[2]))
    return np.array(albedos), np.array(turns)


def everywhere(cosine: np.ndarray) -> np.ndarray:
    """Radiance of the highlights, over rho_s / F0, in radiance 1 from everywhere, by the cosine to the view."""
    return np.interp(np.arccos(np.clip(cosine, -1, 1)), _ANGLES, _tables()[0])


def normal_between(view: np.ndarray, mean: np.ndarray) -> np.ndarray:
    """The normal (..., 3) for which light that is seen from ``view`` comes from ``mean`` on average (unit vectors).

    A mirror's normal lies half-way; rough highlights of slanted skin come from nearer to the normal.
    """
    between = np.arccos(np.clip((view * mean).sum(-1), -1, 1))
    turn = np.interp(between, _tables()[1], _ANGLES)
    across = unit(mean - (view * mean).sum(-1, keepdims=True) * view)
    return np.cos(turn)[..., None] * view + np.sin(turn)[..., None] * across

"""One GGX lobe in place of two.

The single lobe is the one that moves the least energy: of all alphas it has the smallest total variation
1/2 int |D - D'| cos dw to the two lobes, over the half vectors. The number reads as the share of a highlight
that lands elsewhere.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..render.ggx import density

_ALPHAS = np.geomspace(0.02, 1.0, 256)
"""Candidates, 1.5 % apart; and the steps to which the alphas of maps are quantised."""

_WEIGHT_STEPS = 64
_ANGLES = 192
_BATCH = 1 << 8
_MAX_KINDS = 1 << 14
"""Pairs of lobes that are fitted: some seconds."""


@dataclass(frozen=True)
class SingleLobe:
    """``alpha`` (N,N) f32 GGX, and the share (N,N) of the highlight's energy that it sends elsewhere, 0 to 1."""

    alpha: np.ndarray
    misplaced: np.ndarray


def fit(roughness: np.ndarray) -> SingleLobe:
    """The single lobe for GGX alphas of two lobes and the weight of the first (N,N,3)."""
    kinds, number = _kinds(roughness)
    lobes, weights = _lobes()
    best, distance = np.empty(len(kinds)), np.empty(len(kinds))
    for start in range(0, len(kinds), _BATCH):
        part = slice(start, start + _BATCH)
        pair, s = np.divmod(kinds[part], _WEIGHT_STEPS + 1)
        a, b = np.divmod(pair, len(_ALPHAS))
        two = (s / _WEIGHT_STEPS)[:, None] * lobes[a] + (1 - s / _WEIGHT_STEPS)[:, None] * lobes[b]
        errors = np.stack([np.abs(two - lobe) @ weights for lobe in lobes], 1) / 2
        best[part] = _ALPHAS[errors.argmin(1)]
        distance[part] = errors.min(1)
    shape = roughness.shape[:2]
    alpha, misplaced = (values[number].reshape(shape).astype(np.float32) for values in (best, distance))
    return SingleLobe(alpha, misplaced)


def _kinds(roughness: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distinct pairs of lobes as numbers, and the pair of each texel; quantised more coarsely where they are many."""
    for step in (1, 2, 4, 8):
        first, second = (_nearest(roughness[..., lobe]) // step * step for lobe in range(2))
        weight = np.rint(roughness[..., 2] * _WEIGHT_STEPS / step).astype(np.int64) * step
        codes = (first * len(_ALPHAS) + second) * (_WEIGHT_STEPS + 1) + weight
        kinds, number = np.unique(codes, return_inverse=True)
        if len(kinds) <= _MAX_KINDS:
            break
    return kinds, number


def _nearest(alpha: np.ndarray) -> np.ndarray:
    """The nearest candidate's number."""
    steps = np.log(alpha.clip(_ALPHAS[0], 1) / _ALPHAS[0]) / np.log(_ALPHAS[1] / _ALPHAS[0])
    return np.rint(steps).astype(np.int64)


def _lobes() -> tuple[np.ndarray, np.ndarray]:
    """D of every candidate (A,T) over half vectors, and what each angle weighs in int ... cos dw (T,).

    Angles are spread evenly in log tan: every lobe has its own decade.
    """
    tangent = np.geomspace(1e-3, 1e3, _ANGLES)
    cosine2 = 1 / (1 + tangent**2)
    d = density(cosine2, _ALPHAS[:, None] ** 2)
    # dw cos = 2 pi sin cos dtheta, and dtheta = tan cos^2 dlog(tan).
    step = np.log(tangent[1] / tangent[0])
    weights = 2 * np.pi * tangent * cosine2 * tangent * cosine2 * step
    return d, weights

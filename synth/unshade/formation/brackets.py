"""Bracketed exposures merged to one picture of high dynamic range."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..scene_file import Formation
from ..srgb import slope

_MARGIN = 4.0
"""Standard deviations below saturation at which an exposure starts to count. Chance clips one reading in 30,000
there, so that those that are left have no bias."""


def merged(readings: Sequence[np.ndarray], scales: Sequence[float], formation: Formation) -> np.ndarray:
    """The radiance [H, W, 3] (float64) of exposures of one view, each weighted by its inverse variance.

    ``readings`` are decoded codes, 0 to 1, of exposures that multiply radiance by ``scales``. The variance of a
    reading is that of its photons, its read noise and its quantisation, at the merged radiance (Granados et al. 2010,
    "Optimal HDR reconstruction with linear digital cameras", two iterations). The shortest exposure always counts; a
    longer one where the exposures before it, whose noise is independent of its own, predict a level below saturation.
    """
    order = np.argsort(scales)
    steps = [scales[k] for k in order]
    samples = [readings[k] / scales[k] for k in order]
    radiance = samples[0]
    weights = [1 / _variance(radiance, steps[0], formation)]
    for scale in steps[1:]:
        variance = _variance(radiance, scale, formation)
        spread = np.sqrt(variance + 1 / sum(weights))
        weights.append(np.where((radiance + _MARGIN * spread) * scale < 1, 1 / variance, 0))
        radiance = _mean(samples, weights)
    counted = [weight > 0 for weight in weights]
    weights = [used / _variance(radiance, scale, formation) for used, scale in zip(counted, steps)]
    return _mean(samples, weights)


def _mean(samples: list[np.ndarray], weights: list[np.ndarray]) -> np.ndarray:
    """Weighted mean of as many samples as have weights."""
    return sum(w * s for w, s in zip(weights, samples)) / sum(weights)


def _variance(radiance: np.ndarray, scale: float, formation: Formation) -> np.ndarray:
    """Variance of the radiance that an exposure reads where the true one is ``radiance``."""
    level = (radiance * scale).clip(0, 1)
    step = np.full_like(level, 1 / (2**formation.bits - 1))
    if formation.transfer == "srgb":
        step *= slope(level)
    variance = step**2 / 12
    if formation.full_well_electrons is not None:
        well = formation.full_well_electrons
        variance += level / well + (formation.read_noise_electrons / well) ** 2
    return variance / scale**2

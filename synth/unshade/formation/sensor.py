"""The sensor: exposure, photons, saturation, reading, code values, and back to radiance."""

from __future__ import annotations

import numpy as np

from ..errors import PictureError
from ..scene_file import Formation
from ..srgb import decoded, encoded
from .brackets import merged


def expose(radiance: np.ndarray, formation: Formation, seed: int) -> np.ndarray:
    """The picture [H, W, 3] (linear radiance, float32) that a sensor makes of ``radiance``.

    In the order of the light's way (the photon transfer model of Janesick, "Photon Transfer",
    2007, and of EMVA 1288): exposure; counting of photons (Poisson); saturation at the full
    well, which is the white level; read noise (Gaussian); the converter's range; code
    values. Then the code is decoded and the exposure divided out. Without black level the
    converter cuts negative readings off, so that noise brightens what is nearly black.
    Bracketed exposures go this way one by one, each with noise of its own, and are merged.

    Equal seeds give equal bytes. Raises `PictureError` where ``radiance`` is not finite.
    """
    if not np.isfinite(radiance).all():
        raise PictureError(
            "a rendered picture holds NaN or infinity, which no sensor can be exposed to; render it again with another seed"
        )
    if formation.white_level is None:
        return radiance
    scale = 2.0**formation.exposure_stops / formation.white_level
    if formation.brackets_stops is None:
        return (_reading(radiance, scale, formation, np.random.default_rng(seed)) / scale).astype(np.float32)
    scales = [scale * 2.0**stops for stops in formation.brackets_stops]
    readings = [_reading(radiance, s, formation, np.random.default_rng([seed, k])) for k, s in enumerate(scales)]
    return merged(readings, scales, formation).astype(np.float32)


def _reading(radiance: np.ndarray, scale: float, formation: Formation, rng: np.random.Generator) -> np.ndarray:
    """Decoded readings, 0 to 1 of the white level, of one exposure that multiplies radiance by ``scale``."""
    signal = radiance.astype(np.float64) * scale
    if formation.full_well_electrons is not None:
        signal = _counted(signal, formation.full_well_electrons, formation.read_noise_electrons, rng)
    signal = signal.clip(0, 1)
    if formation.bits is not None:
        signal = _quantised(signal, formation.bits, formation.transfer)
    return signal


def _counted(signal: np.ndarray, full_well: float, read_noise: float, rng: np.random.Generator) -> np.ndarray:
    """Shares of the full well after counting, saturation and reading."""
    expected = signal.clip(0) * full_well
    # So far above saturation the count does not matter, and the generator has its limits.
    electrons = rng.poisson(np.minimum(expected, 2 * full_well + 1000)).astype(np.float64)
    electrons = np.minimum(electrons, full_well)
    return (electrons + read_noise * rng.standard_normal(signal.shape)) / full_well


def _quantised(signal: np.ndarray, bits: int, transfer: str) -> np.ndarray:
    """Values 0 to 1 at the nearest code of the transfer curve."""
    largest = 2**bits - 1
    if transfer == "linear":
        return np.rint(signal * largest) / largest
    return decoded(np.rint(encoded(signal) * largest) / largest)

"""Unevenness of natural skin's pigments at every scale, with the spectrum that a photographed face has.

Amounts are in log luminance, so that they are as visible on one skin type as on another;
`melanin_factor` and `blood_factor` turn them into pigment.
"""

from __future__ import annotations

import functools
from collections.abc import Callable

import numpy as np

from .noise import smooth_noise
from .pigment import BLOOD, MELANOSOMES, exact_colour
from .regions import Regions, pair
from .spec import FaceSpec, stream

_COARSE_MM = {26.0: (0.050, 0.016), 13.0: (0.054, 0.016), 6.5: (0.044, 0.013)}
_FINE_MM = {3.2: (0.026, 0.012), 1.6: (0.022, 0.012), 0.9: (0.022, 0.012), 0.45: (0.018, 0.010), 0.23: (0.012, 0.007)}
"""Standard deviations in log luminance at each wavelength: of what melanin and blood do together, and of what each does
alone. In a photographed face one direction of colour holds nine tenths of the variance at every scale."""

_SYMMETRIC = 0.4
"""Share of the coarse variance that both halves of the face have in common: sun, rubbing and anatomy are alike on both."""

_DARKEST_BLOOD_FRACTION = 0.35
"""How much of the redness is left to be seen through the darkest skin."""

_COMMON_WEIGHTS = {"melanin": 0.6, "blood": 0.4}
"""Parts of the two pigments in their common effect."""


def draw_coarse(regions: Regions, spec: FaceSpec, amounts: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """Log luminance (M,), (M,) that melanin and blood take away over centimetres: by region, and without a place.

    The same function on the chart and on the rest of the head; `amounts`: factors on both.
    """
    folded = (regions.points * np.float32([0, 1, 1])) + np.abs(regions.points * np.float32([1, 0, 0]))

    def field(name: str, wavelength: float) -> np.ndarray:
        both, own = (stream(spec.seed, f"{name} blotches", str(wavelength), kind) for kind in ("both", "own"))
        return _SYMMETRIC**0.5 * smooth_noise(folded, wavelength, both) + (1 - _SYMMETRIC) ** 0.5 * smooth_noise(
            regions.points, wavelength, own
        )

    places = [_places(regions, pigment, spec) for pigment in _COMMON_WEIGHTS]
    return tuple(p + a * f for p, a, f in zip(places, amounts, _summed(_COARSE_MM, field)))


def draw_fine(points: np.ndarray, texel: float, spec: FaceSpec, amounts: tuple[float, float]) -> tuple:
    """Log luminance (M,), (M,) that melanin and blood take away over millimetres, at template points (M,3).

    They come and go, as freckled, flushed and even stretches do; what is finer than two texels
    is left out.
    """

    def field(name: str, wavelength: float) -> np.ndarray:
        return smooth_noise(points, wavelength, stream(spec.seed, f"{name} blotches", str(wavelength)))

    shown = {wavelength: sizes for wavelength, sizes in _FINE_MM.items() if wavelength >= 2 * texel}
    stretch = np.clip(1 + 0.5 * smooth_noise(points, 12.0, stream(spec.seed, "stretches")), 0.2, 2.2)
    return tuple(np.float32(a) * stretch * f for a, f in zip(amounts, _summed(shown, field)))


def _summed(scales: dict[float, tuple[float, float]], field: Callable[[str, float], np.ndarray]) -> list:
    """Melanin and blood, (M,) each or 0: their share of what is common at every scale, and their own."""
    sums: list = [np.float32(0), np.float32(0)]
    for wavelength, (common, own) in scales.items():
        together = field("common", wavelength)
        for number, (pigment, weight) in enumerate(_COMMON_WEIGHTS.items()):
            sums[number] = (
                sums[number] + np.float32(weight * common) * together + np.float32(own) * field(pigment, wavelength)
            )
    return sums


def _places(regions: Regions, pigment: str, spec: FaceSpec) -> np.ndarray:
    """Log luminance that whole regions add: lids and hollows of the eyes, the mouth's surround, nose, cheeks."""
    rng = stream(spec.seed, f"{pigment} places")
    if pigment == "melanin":
        weights = rng.uniform((0.06, 0.04, 0.0, -0.06, -0.06), (0.26, 0.20, 0.14, 0.10, 0.10))
        fields = (regions.upper_lid, regions.under_eye, regions.perioral, regions.temple, regions.forehead)
    else:
        weights = rng.uniform((0.0, 0.0, 0.0, 0.0, 0.0), (0.10, 0.08, 0.12, 0.06, 0.10))
        corners = pair(regions.points, (24, -66, 24), (5, 5, 10))
        fields = (regions.nose, regions.cheek, regions.wings, regions.chin, corners)
    return sum(np.float32(w) * field for w, field in zip(weights, fields))


@functools.cache
def _loss(fitzpatrick: str) -> tuple[float, float]:
    """Log luminance that a skin type loses per unit of log melanin and of log blood."""
    base, step = np.array([MELANOSOMES[fitzpatrick], BLOOD[fitzpatrick]]), np.exp(0.1)

    def lum(melanin: float, blood: float) -> float:
        return float(np.log(exact_colour(np.array(melanin), np.array(blood)) @ [0.2126, 0.7152, 0.0722]))

    here = lum(*base)
    return (here - lum(base[0] * step, base[1])) / 0.1, (here - lum(base[0], base[1] * step)) / 0.1


def melanin_factor(amount: np.ndarray, spec: FaceSpec) -> np.ndarray:
    """Factor (M,) on melanin that takes `amount` (M,) of log luminance away."""
    return np.exp(np.clip(amount / np.float32(_loss(spec.fitzpatrick)[0]), -1.5, 2.5))


def blood_factor(amount: np.ndarray, spec: FaceSpec) -> np.ndarray:
    """Factor (M,) on blood that takes `amount` (M,) of log luminance away; under dark skin less of it shows."""
    loss = max(_loss(spec.fitzpatrick)[1], _DARKEST_BLOOD_FRACTION * _loss("I")[1])
    return np.exp(np.clip(amount / np.float32(loss), -1.2, 1.2))

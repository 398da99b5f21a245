"""Unevenness of natural skin's pigments at every scale, with the spectrum that a photographed face has.

Amounts are in log luminance, so that they are as visible on one skin type as on another;
`melanin_factor` and `blood_factor` turn them into pigment.
"""

from __future__ import annotations

import functools

import numpy as np

from .noise import smooth_noise
from .pigment import BLOOD, MELANOSOMES, exact_colour
from .regions import Regions, pair
from .spec import FaceSpec, stream

_COARSE_MM = {26.0: (0.030, 0.024), 13.0: (0.030, 0.026), 6.5: (0.024, 0.020)}
_FINE_MM = {3.2: (0.024, 0.020), 1.6: (0.022, 0.015), 0.9: (0.018, 0.010)}
"""Standard deviations of melanin and blood at each wavelength, in log luminance."""

_SYMMETRIC = 0.75
"""Share of the coarse variance that both halves of the face have in common: sun, rubbing and anatomy are alike on both."""

_DARKEST_BLOOD_SHARE = 0.35
"""How much of the redness is left to be seen through the darkest skin."""


def draw_coarse(regions: Regions, spec: FaceSpec, amounts: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """Log luminance (M,), (M,) that melanin and blood take away over centimetres: by region, and without a place.

    The same function on the chart and on the rest of the head; `amounts`: factors on both.
    """
    folded = (regions.points * np.float32([0, 1, 1])) + np.abs(regions.points * np.float32([1, 0, 0]))
    fields = []
    for number, (pigment, amount) in enumerate(zip(("melanin", "blood"), amounts)):
        total = _places(regions, pigment, spec)
        for wavelength, deviations in _COARSE_MM.items():
            both, own = (stream(spec.seed, f"{pigment} blotches", str(wavelength), kind) for kind in ("both", "own"))
            here = _SYMMETRIC**0.5 * smooth_noise(folded, wavelength, both)
            here += (1 - _SYMMETRIC) ** 0.5 * smooth_noise(regions.points, wavelength, own)
            total = total + np.float32(amount * deviations[number]) * here
        fields.append(total)
    return fields[0], fields[1]


def draw_fine(points: np.ndarray, texel: float, spec: FaceSpec, amounts: tuple[float, float]) -> tuple:
    """Log luminance (M,), (M,) that melanin and blood take away over millimetres, at template points (M,3).

    Each scale comes and goes, as freckled, flushed and even stretches do; what is finer than
    two texels is left out.
    """
    fields = []
    for number, (pigment, amount) in enumerate(zip(("melanin", "blood"), amounts)):
        total = np.zeros(len(points), dtype=np.float32)
        stretch = np.clip(1 + 0.5 * smooth_noise(points, 12.0, stream(spec.seed, f"{pigment} stretches")), 0.2, 2.2)
        for wavelength, deviations in _FINE_MM.items():
            if wavelength >= 2 * texel:
                rng = stream(spec.seed, f"{pigment} blotches", str(wavelength))
                total += np.float32(amount * deviations[number]) * smooth_noise(points, wavelength, rng)
        fields.append(total * stretch)
    return fields[0], fields[1]


def _places(regions: Regions, pigment: str, spec: FaceSpec) -> np.ndarray:
    """What whole regions hold more of, in log luminance: lids and hollows of the eyes, the mouth's surround, nose, cheeks."""
    rng = stream(spec.seed, f"{pigment} places")
    if pigment == "melanin":
        weights = rng.uniform((0.12, 0.06, 0.0, -0.06, -0.06), (0.38, 0.26, 0.16, 0.12, 0.12))
        fields = (regions.upper_lid, regions.under_eye, regions.perioral, regions.temple, regions.forehead)
    else:
        weights = rng.uniform((0.04, 0.02, 0.02, 0.0, 0.0), (0.22, 0.18, 0.20, 0.12, 0.16))
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
    return np.exp(np.clip(amount / np.float32(_loss(spec.fitzpatrick)[0]), -2.5, 2.5))


def blood_factor(amount: np.ndarray, spec: FaceSpec) -> np.ndarray:
    """Factor (M,) on blood that takes `amount` (M,) of log luminance away; under dark skin less of it shows."""
    loss = max(_loss(spec.fitzpatrick)[1], _DARKEST_BLOOD_SHARE * _loss("I")[1])
    return np.exp(np.clip(amount / np.float32(loss), -2.5, 2.2))

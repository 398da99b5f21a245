"""Skin colour from two pigments: melanin in the epidermis, haemoglobin in the dermis.

A thin pigmented epidermis (Kubelka-Munk layer, K = 2 mua and S = 3/4 mus') lies on a
bloody dermis without end. Sources: absorption of melanosomes and of bloodless skin,
S. L. Jacques, "Skin Optics", Oregon Medical Laser Center News, Jan 1998
(omlc.org/news/jan98/skinoptics.html); scattering of skin, S. L. Jacques, "Optical
properties of biological tissues: a review", Phys. Med. Biol. 58 (2013) R37, equation 2 and
table 2 (data: omlc.org/news/dec14/Jacques_PMB2013); haemoglobin, S. Prahl's compilation
(omlc.org/spectra/hemoglobin); diffuse reflectance of the dermis, the dipole of Jensen
et al. 2001, section 2.4. Spectra become linear Rec.709 under D65 through the CIE 1931
observer.
"""

from __future__ import annotations

import dataclasses
import functools

import numpy as np

WAVELENGTHS = np.arange(400.0, 701.0, 10.0)
"""Sampled wavelengths in nm."""

# Molar extinction in cm-1/M at WAVELENGTHS (Prahl: Gratzer, Kollias), oxygenated and not.
_OXY = np.array([
    266232, 466840, 480360, 246072, 102580, 62816, 44480, 33209.2, 26629.2, 23684.4, 20932.8, 20035.2, 24202.4, 39956.8, 53236, 43016,
    32613.2, 44496, 50104, 14400.8, 3200, 1506, 942, 610, 442, 368, 319.6, 294, 277.6, 276, 290,
])  # fmt: skip
_DEOXY = np.array([
    223296, 303956, 407560, 528600, 413280, 103292, 23388.8, 16156.4, 14550, 16684, 20862, 25773.6, 31589.6, 39036.4, 46592, 53412,
    53788, 45072, 37020, 28324.4, 14677.2, 9443.6, 6509.6, 5148.8, 4345.2, 3750.12, 3226.56, 2795.12, 2407.92, 2051.96, 1794.28,
])  # fmt: skip
# CIE standard illuminant D65, relative power at WAVELENGTHS (CIE 015).
_D65 = np.array([
    82.7549, 91.4860, 93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861, 115.923, 108.811, 109.354, 107.802, 104.790, 107.689, 104.405,
    104.046, 100.000, 96.3342, 95.7880, 88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213,
    71.6091,
])  # fmt: skip

# Reduced scattering of skin, the mean of table 2 over the cited samples (dermis of Salomatina et al.
# 2006: 43.6, .41, .562; their epidermis: 66.7, .29, .689): at 500 nm in cm-1, the share of Rayleigh
# scattering in it, and the power of the rest.
_SCATTERING_AT_500, _RAYLEIGH_FRACTION, _MIE_POWER = 48.0, 0.409, 0.702


@dataclasses.dataclass(frozen=True)
class Tissue:
    """Skin over blood: share of the epidermis' scattering that is left, oxygenation below (both 0 to 1)."""

    scattering: float
    oxygenation: float


SKIN = Tissue(scattering=1.0, oxygenation=0.75)
LIP = Tissue(scattering=0.35, oxygenation=0.90)
"""The vermilion: hardly any horny layer scatters light, and its capillary loops are arterial."""

_EPIDERMIS_CM = 0.006
_HAEMOGLOBIN_GRAMS = 150.0  # per litre of whole blood
_HAEMOGLOBIN_MOLAR = 64500.0  # g/mol
_REFRACTIVE_INDEX = 1.4

MELANOSOMES = {"I": 0.0198, "II": 0.0322, "III": 0.0471, "IV": 0.0662, "V": 0.1120, "VI": 0.2050}
"""Volume fraction of melanosomes per Fitzpatrick type; Jacques gives 1.3-6.3 % for light,
11-16 % for moderately and 18-43 % for darkly pigmented adults. With these the base tones lie
in the middle of the six groups of the individual typology angle."""

BLOOD = {"I": 0.0115, "II": 0.0115, "III": 0.0120, "IV": 0.0125, "V": 0.0130, "VI": 0.0140}
"""Volume fraction of blood in the dermis of the face, flushed regions and lips not counted; what fits
the colour of foreheads and cheeks (Xiao et al. 2017), twice that of the arm (Alaluf et al. 2002)."""

MELANIN_LIMIT, BLOOD_LIMIT = 0.6, 0.12
"""Largest fractions that `skin_colour` tabulates."""


def _observer() -> np.ndarray:
    """CIE 1931 colour-matching functions (31,3), multi-lobe fit of Wyman, Sloan & Shirley 2013, table 1."""

    def lobe(height: float, centre: float, below: float, above: float) -> np.ndarray:
        offset = WAVELENGTHS - centre
        return height * np.exp(-0.5 * (offset * np.where(offset < 0, below, above)) ** 2)

    x = lobe(0.362, 442.0, 0.0624, 0.0374) + lobe(1.056, 599.8, 0.0264, 0.0323) - lobe(0.065, 501.1, 0.0490, 0.0382)
    y = lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322)
    z = lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725)
    return np.stack([x, y, z], axis=1)


_XYZ_TO_RGB = np.array([[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]])


def _projection() -> np.ndarray:
    """Matrix (31,3) from reflectance to linear Rec.709; a perfect white is exactly (1,1,1)."""
    rgb = (_D65[:, None] * _observer()) @ _XYZ_TO_RGB.T
    return rgb / rgb.sum(axis=0)


def reflectance(melanin: np.ndarray, blood: np.ndarray, tissue: Tissue = SKIN) -> np.ndarray:
    """Diffuse reflectance (...,31) of skin with these volume fractions of melanosomes and blood."""
    melanin, blood = np.asarray(melanin)[..., None], np.asarray(blood)[..., None]
    baseline = 0.244 + 85.3 * np.exp(-(WAVELENGTHS - 154) / 66.2)
    epidermis = melanin * 6.6e11 * WAVELENGTHS**-3.33 + (1 - melanin) * baseline
    extinction = tissue.oxygenation * _OXY + (1 - tissue.oxygenation) * _DEOXY
    whole_blood = np.log(10) * extinction * _HAEMOGLOBIN_GRAMS / _HAEMOGLOBIN_MOLAR
    absorption = blood * whole_blood + (1 - blood) * baseline
    scattering = reduced_scattering(WAVELENGTHS)
    return _layer(
        epidermis, tissue.scattering * scattering, _EPIDERMIS_CM, _dipole(scattering / (scattering + absorption))
    )


def reduced_scattering(wavelengths: np.ndarray) -> np.ndarray:
    """Reduced scattering coefficient of skin in cm-1 at wavelengths in nm: Rayleigh and Mie part."""
    relative = wavelengths / 500
    return _SCATTERING_AT_500 * (_RAYLEIGH_FRACTION * relative**-4.0 + (1 - _RAYLEIGH_FRACTION) * relative**-_MIE_POWER)


def _layer(absorption: np.ndarray, scattering: np.ndarray, thickness: float, below: np.ndarray) -> np.ndarray:
    """Reflectance of a layer over a ground of reflectance `below` (Kubelka 1948, equation 24)."""
    s = 0.75 * scattering
    a = 1 + 2 * absorption / s
    b = np.sqrt(a * a - 1)
    term = b / np.tanh(b * s * thickness)
    return (1 - below * (a - term)) / (a - below + term)


def _dipole(albedo: np.ndarray) -> np.ndarray:
    """Diffuse reflectance of a semi-infinite medium of this reduced albedo (Jensen et al. 2001)."""
    eta = _REFRACTIVE_INDEX
    inner = -1.440 / eta**2 + 0.710 / eta + 0.668 + 0.0636 * eta
    mismatch = (1 + inner) / (1 - inner)
    root = np.sqrt(3 * (1 - albedo))
    return albedo / 2 * (1 + np.exp(-4 / 3 * mismatch * root)) * np.exp(-root)


def exact_colour(melanin: np.ndarray, blood: np.ndarray, tissue: Tissue = SKIN) -> np.ndarray:
    """Linear Rec.709 diffuse albedo (...,3) from the full spectrum."""
    return np.clip(reflectance(melanin, blood, tissue) @ _projection(), 0, 1)


# Table knots grow with the square of the index: colour changes fastest where there is little pigment.
_KNOTS = 96


@functools.cache
def _table(tissue: Tissue) -> np.ndarray:
    knots = (np.arange(_KNOTS) / (_KNOTS - 1)) ** 2
    return exact_colour(MELANIN_LIMIT * knots[:, None], BLOOD_LIMIT * knots, tissue).astype(np.float32)


def skin_colour(melanin: np.ndarray, blood: np.ndarray, tissue: Tissue = SKIN) -> np.ndarray:
    """Linear Rec.709 diffuse albedo (M,3) f32, bilinear in a table of `exact_colour`; fractions are clipped to the limits."""

    def position(fraction: np.ndarray, limit: float) -> tuple[np.ndarray, np.ndarray]:
        knot = np.sqrt(np.clip(fraction / limit, 0, 1)).astype(np.float32) * (_KNOTS - 1)
        low = np.minimum(knot.astype(np.int64), _KNOTS - 2)
        return low, (knot - low).astype(np.float32)[:, None]

    (i, s), (j, t) = position(melanin, MELANIN_LIMIT), position(blood, BLOOD_LIMIT)
    table = _table(tissue)
    near = table[i, j] * (1 - t) + table[i, j + 1] * t
    far = table[i + 1, j] * (1 - t) + table[i + 1, j + 1] * t
    return near * (1 - s) + far * s

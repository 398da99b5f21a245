"""Roughness of the skin's surface: two GGX lobes whose widths and weights vary by region.

Fits of measured faces with one Torrance-Sparrow lobe give slopes m of about 0.2 to 0.4,
lowest where skin is oily (Weyrich et al. 2006; d'Eon & Luebke 2007 take 0.3 for the whole
face); two lobes, a narrow and a wide one, fit better, and each region has its own (Ghosh
et al. 2008; the shaders of Digital Emily 2). Here the region factors multiply the lobes of
the standard skin; `equivalent` gives the one slope that compares with m.
"""

from __future__ import annotations

import numpy as np

from .noise import octaves
from .regions import Regions
from .relief import Relief
from .spec import FaceSpec, stream

NOMINAL = (0.15, 0.35, 0.5)
"""Standard skin: alpha of the narrow lobe, alpha of the wide lobe, weight of the narrow one."""

LOW, HIGH = (0.06, 0.15, 0.15), (0.45, 0.60, 0.90)
"""Bounds of painted values."""

MIN_ALPHA = 0.02
"""GGX alpha of the smoothest lobe that the material takes."""

# How a region's sheen departs from standard skin: log of the factor on both alphas, and what is added to the narrow lobe's weight.
_REGIONS = {
    "nose": (-0.30, 0.12),
    "forehead": (-0.15, 0.07),
    "chin": (-0.16, 0.04),
    "cheek": (0.10, -0.03),
    "under_eye": (0.12, -0.04),
    "upper_lid": (-0.06, 0.02),
    "temple": (0.07, -0.02),
    "jaw": (0.12, -0.04),
    "perioral": (0.05, -0.02),
    "wings": (-0.10, 0.03),
    "lips": (-0.26, 0.05),
}
# Brow and scalp hair, too fine to be drawn: a broad sheen.
_HAIR = (0.28, 0.45, 0.4)
_WET = (0.07, 0.20, 0.75)


def draw_roughness(
    regions: Regions,
    relief: Relief,
    cover: dict[str, np.ndarray],
    rims: dict[str, np.ndarray],
    texel: float,
    spec: FaceSpec,
) -> np.ndarray:
    """Lobes (M,3) f32 at the texels of the chart, `NOMINAL` at its outer rim.

    Oily people and regions are smoother, old and dry skin rougher; pores, folds and stubble
    scatter more. `cover` and `rims` as for `skin.chart_colour`.
    """
    sebum = float(stream(spec.seed, "sebum").uniform(0.75, 1.25))
    width = 0.25 * (1 - sebum) * (0.4 + 0.6 * regions.oily) + np.float32(0.10 * spec.age)
    weight = np.full(len(regions.points), 0.08 * (sebum - 1), dtype=np.float32)
    for name, (factor, more) in _REGIONS.items():
        width = width + factor * getattr(regions, name)
        weight += more * getattr(regions, name)
    width = width + 0.07 * octaves(regions.points, 7.0, 3, 2 * texel, stream(spec.seed, "sheen"))
    width += 0.40 * relief.pores + 0.10 * relief.furrows + 0.25 * relief.creases + 0.15 * np.minimum(cover["beard"], 1)
    weight -= 0.15 * relief.pores
    lobes = np.empty((len(width), 3), dtype=np.float32)
    lobes[:, 0] = NOMINAL[0] * np.exp(width)
    # The wide lobe, scattering at many facets, follows the surface less.
    lobes[:, 1] = NOMINAL[1] * np.exp(0.7 * width)
    lobes[:, 2] = NOMINAL[2] + weight
    hair = np.maximum(cover["brow"], cover["scalp"])
    for values, where in ((_HAIR, hair), (_WET, rims["wet"])):
        lobes += where[:, None] * (np.float32(values) - lobes)
    lobes = np.clip(lobes, np.float32(LOW), np.float32(HIGH))
    return np.float32(NOMINAL) + rims["outer"].astype(np.float32)[:, None] * (lobes - np.float32(NOMINAL))


def equivalent(lobes: np.ndarray) -> np.ndarray:
    """Root mean square of the lobes' alphas by weight (...,): the one roughness of a single-lobe fit."""
    narrow, wide, weight = np.moveaxis(lobes, -1, 0)
    return np.sqrt(weight * narrow**2 + (1 - weight) * wide**2)

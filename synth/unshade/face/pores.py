"""Pores and the net of fine furrows between them.

Sizes: conspicuous pores are those wider than 0.25 mm (Flament et al. 2015, "Facial skin
pores: a multiethnic study"), some tens to a hundred per square centimetre of cheek and
more on the nose; they are drawn out along the cheek with age (Jang et al. 2018). Primary
furrows enclose plateaus of half a millimetre to a millimetre and are some hundredths of a
millimetre deep on the face (Hashimoto 1974).
"""

from __future__ import annotations

import dataclasses

import numpy as np

from .cellular import Cells, Grain, furrows, pits
from .regions import Regions
from .spec import FaceSpec, stream
from .wrinkles import slackness

SPACING_MM = 1.05
"""Side of the square that each holds one pore: 91 per cm2, of which three in four are large enough to be seen."""

_VISIBLE_FRACTION = 0.75
_RADII_MM = (0.12, 0.27)
"""Radius, down to 1/e of the depth, of the smallest and the largest pore."""

_PLATEAU_MM, _FURROW_MM = 0.85, 0.11
_TENSION_DEGREES = -58.0
"""Slope of the lines of tension over the cheek, from the nose down and outward."""


@dataclasses.dataclass(frozen=True)
class FineRelief:
    """`pores` (M,) and `furrows` (M,), 0 to about 1: shares of their full depth."""

    pores: np.ndarray
    furrows: np.ndarray


def draw_fine_relief(regions: Regions, places: np.ndarray, texel: float, spec: FaceSpec) -> FineRelief:
    """Pores and furrows at the texels of the chart: `places` (M,2) mm of the chart, `texel` its step in mm."""
    grain = _grain(regions, spec)
    person = float(stream(spec.seed, "pore size").uniform(0.65, 1.15)) * (0.9 + 0.15 * spec.gender + 0.1 * spec.age)
    amount = 0.28 + 1.0 * regions.nose + 0.75 * regions.cheek + 0.35 * regions.forehead + 0.3 * regions.chin
    amount = (
        np.clip(amount, 0, 1.3)
        * (1 - 0.9 * np.clip(regions.upper_lid + 0.8 * regions.under_eye, 0, 1))
        * (1 - regions.lips)
    )
    pores = pits(places, Cells(SPACING_MM, stream(spec.seed, "pores")), _RADII_MM, _VISIBLE_FRACTION, texel, grain)
    net = furrows(places, Cells(_PLATEAU_MM, stream(spec.seed, "furrows")), _FURROW_MM, texel, grain)
    return FineRelief(pores * (amount * np.float32(person)), net * (1 - regions.lips) * (1 - 0.6 * regions.nose))


def stubble_roots(places: np.ndarray, texel: float, spec: FaceSpec) -> np.ndarray:
    """Shaven hairs (M,) as dots around a mean of 1: about 0.12 mm wide, 1.6 a square millimetre, merged where texels are coarse."""
    spacing, radius = 0.8, 0.15
    dots = pits(places, Cells(spacing, stream(spec.seed, "beard roots")), (radius, radius), 1.0, texel)
    return dots / np.float32(np.pi * radius**2 / spacing**2)


def _grain(regions: Regions, spec: FaceSpec) -> Grain:
    """Along the lines of tension, mirrored over the midline; without direction off the cheeks."""
    angle = np.radians(_TENSION_DEGREES)
    along = np.empty((len(regions.points), 2), dtype=np.float32)
    along[:, 0] = np.where(regions.points[:, 0] > 0, np.cos(angle), -np.cos(angle))
    along[:, 1] = np.sin(angle)
    return Grain(along, 1 + np.float32(0.8) * slackness(regions, spec))

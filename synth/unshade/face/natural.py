"""Additions of `detail = "natural"` to a face: skin as uneven as people's, hair of strands, an individual sheen.

Amounts follow the spectra that `statistics` measures on a photographed face; docs/ground-truth.md has both.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from .blotches import blood_factor, draw_fine, melanin_factor
from .canvas import Canvas
from .character import Character, character
from .hair import HairStyle
from .locks import Hairs, draw_hairs
from .noise import octaves, smooth_noise
from .regions import Regions, smoothstep
from .roughness import HIGH, LOW, NOMINAL
from .skin import SPECULAR_LIMIT, Pigments
from .spec import FaceSpec, stream
from .spots import draw_spots
from .strands import Field
from .texels import Texels
from .vessels import VEIN_COLOUR, draw_vessels

_UNDULATION = (
    (22.0, 0.12),
    (9.0, 0.03),
    (4.5, 0.02),
    (2.2, 0.028),
    (1.1, 0.014),
    (0.55, 0.008),
    (0.28, 0.005),
    (0.16, 0.003),
)
"""Wavelength and standard deviation of the added unevenness, mm."""

_LIP_FURROWS = ((2.2, 0.050), (1.1, 0.030), (0.5, 0.012))
"""Distance and depth (mm) of the upright furrows of the lips, from the large ones to the lines between them."""

_MOIST = np.float32([0.09, 0.20, 0.68])
_MOIST_SPECULAR = 0.010
"""Lobes of moist lips, and what moisture adds to their specular albedo."""

_STRAND_MM, _WHISKER_MM = 0.10, 0.06
"""Height of hair over the skin that it lies on."""


@dataclasses.dataclass(frozen=True)
class Natural:
    """Layers over the texels (M,) of the chart.

    `melanin`, `blood`: factors on the pigments; `height` mm; `veins` 0 to 1; `hairs`; `lines`:
    dark lines of the lips, log luminance; `sheen`: log of what the specular albedo varies by; `moisture` of the lips, 0
    to 1.
    """

    person: Character
    melanin: np.ndarray
    blood: np.ndarray
    height: np.ndarray
    veins: np.ndarray
    hairs: Hairs
    lines: np.ndarray
    sheen: np.ndarray
    moisture: np.ndarray

    def pigments(self, base: Pigments, fade: np.ndarray) -> Pigments:
        """Uneven pigments; `fade` (M,) is 0 at the chart's outer rim, where the rest of the head takes over."""
        return Pigments(base.melanin * self.melanin**fade, base.blood * self.blood**fade)

    def colour(self, diffuse: np.ndarray, style: HairStyle, fade: np.ndarray) -> np.ndarray:
        """Diffuse albedo (M,3) with veins, lines of the lips and hair over it."""
        skin = diffuse * np.exp(-(fade * self.veins)[:, None] * VEIN_COLOUR - (fade * self.lines)[:, None])
        hairs = self.hairs
        for cover, tone, colour in (
            (hairs.beard_cover, hairs.beard_tone, style.brow),
            (hairs.cover, hairs.tone, style.scalp),
        ):
            skin = skin + cover[:, None] * (np.minimum(tone[:, None] * colour, 0.6) - skin)
        return np.maximum(skin, 0.004).astype(np.float32)

    def specular(self, values: np.ndarray, fade: np.ndarray) -> np.ndarray:
        """Specular albedo (M,) of this person; sheen of hair is a third of skin's."""
        hair = np.maximum(self.hairs.cover, self.hairs.beard_cover)
        own = values * np.exp(fade * self.sheen) * (1 - 0.6 * hair)
        own = self.person.specular * own + np.float32(_MOIST_SPECULAR) * self.moisture
        return np.clip(own, 0, SPECULAR_LIMIT).astype(np.float32)

    def roughness(self, lobes: np.ndarray, fade: np.ndarray) -> np.ndarray:
        """Lobes (M,3) of this person, the standard ones at the outer rim."""
        own = lobes * np.float32([self.person.roughness, self.person.roughness, 1])
        own += self.moisture[:, None] * (_MOIST - own)
        own = np.clip(own, np.float32(LOW) * np.float32([0.7, 0.7, 1]), np.float32(HIGH) * np.float32([1.2, 1.2, 1]))
        return (np.float32(NOMINAL) + fade[:, None] * (own - np.float32(NOMINAL))).astype(np.float32)


def draw_natural(
    regions: Regions,
    canvas: Canvas,
    texels: Texels,
    nearest: tuple[np.ndarray, np.ndarray],
    pores: np.ndarray,
    edge: np.ndarray,
    texel: float,
    style: HairStyle,
    spec: FaceSpec,
) -> Natural:
    """Draw all layers. `regions` at the texels; `pores` (M,) of the relief; `edge` (M,) is 0 at the chart's rim, where
    single marks end; `texel` in mm."""
    person = character(spec)
    field = Field(texels, nearest, regions.points)
    grounds = canvas.grounds()
    melanin, blood = draw_fine(regions.points, texel, spec, (person.mottle, person.redness))
    spots = draw_spots(regions.points, texels, canvas.sites, canvas.uv, texel, spec)
    threads, veins = draw_vessels(field, grounds[-1], texel, spec)
    hairs = draw_hairs(field, regions.points, grounds, texel, style, person, spec)
    # Pores hold sebum that has gone dark.
    melanin = melanin + edge * spots.melanin + np.float32(0.12) * np.clip(pores, 0, 1)
    height = edge * spots.height + _STRAND_MM * hairs.cover + _WHISKER_MM * hairs.beard_cover
    for wavelength, deviation in _UNDULATION:
        if wavelength >= 2 * texel:
            bumps = smooth_noise(regions.points, wavelength, stream(spec.seed, "bumps", str(wavelength)))
            height = height + np.float32(person.relief * deviation) * (1 - 0.7 * regions.lips) * bumps
    height += _lip_furrows(regions, texel, spec)
    return Natural(
        person=person,
        melanin=melanin_factor(melanin, spec),
        blood=blood_factor(blood + edge * (spots.blood + threads), spec),
        height=height.astype(np.float32),
        veins=edge * veins,
        hairs=hairs,
        lines=_lip_lines(regions, texel, spec),
        sheen=np.float32(0.12) * octaves(regions.points, 12.0, 4, 2 * texel, stream(spec.seed, "specular patches")),
        moisture=_lip_moisture(regions, texel, spec),
    )


def _lip_furrows(regions: Regions, texel: float, spec: FaceSpec) -> np.ndarray:
    """Height (M,) mm of the upright furrows of the lips: narrow grooves between full pads."""
    height = np.zeros(len(regions.points), dtype=np.float32)
    there = np.flatnonzero(regions.lips > 0)
    upright = regions.points[there] * np.float32([1.0, 0.22, 0.5])
    for distance, depth in _LIP_FURROWS:
        if distance >= 2 * texel:
            waves = smooth_noise(upright, distance, stream(spec.seed, "lip furrows", str(distance)))
            height[there] -= np.float32(depth) * regions.lips[there] * np.exp(-((waves / np.float32(0.45)) ** 2))
    return height


def _lip_moisture(regions: Regions, texel: float, spec: FaceSpec) -> np.ndarray:
    """Moisture (M,) 0 to 1: most where the lips meet, and on the lower one; lips dry in patches."""
    points, wet = regions.points, stream(spec.seed, "moisture").uniform(0.35, 0.75)
    meet = np.exp(-0.5 * ((points[:, 1] + 66.6) / 3.0) ** 2)
    patches = octaves(points, 6.0, 3, 2 * texel, stream(spec.seed, "moist patches"))
    amount = wet * (0.55 + 0.25 * regions.lower_lip + 0.45 * meet + 0.16 * patches)
    return (np.clip(amount, 0, 0.9) * smoothstep(0.15, 0.8, regions.lips)).astype(np.float32)


def _lip_lines(regions: Regions, texel: float, spec: FaceSpec) -> np.ndarray:
    """Log luminance (M,) that lips lose as a whole, in their upright lines and where they meet."""
    own = stream(spec.seed, "lips").uniform(0.0, 0.2)
    there = np.flatnonzero(regions.lips > 0)
    lines = np.zeros(len(regions.points), dtype=np.float32)
    if len(there):
        points = regions.points[there]
        squeezed = (points * np.float32([1.0, 0.25, 0.5])).astype(np.float32)
        upright = np.abs(smooth_noise(squeezed, max(1.4, 2 * texel), stream(spec.seed, "lip lines")))
        meet = np.exp(-0.5 * ((points[:, 1] + 66.6) / 1.2) ** 2)
        lines[there] = regions.lips[there] * (own + 0.22 * np.exp(-((upright / 0.35) ** 2)) + 0.3 * meet)
    return lines

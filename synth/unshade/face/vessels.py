"""Vessels that show through natural skin: red threads on nose and cheeks, blue veins at temples, brow and under the eyes."""

from __future__ import annotations

import numpy as np

from .normals import smoothed
from .spec import FaceSpec, stream
from .strands import Field, Ground, Strands

_THREADS = {"I": 2.6, "II": 2.0, "III": 1.2, "IV": 0.6, "V": 0.15, "VI": 0.0}
_VEINS = {"I": 0.10, "II": 0.09, "III": 0.07, "IV": 0.05, "V": 0.02, "VI": 0.0}
"""Vessels to a square centimetre where they are seen best."""

_VEIN_BLUR_MM = 0.7
"""Light spreads over the depth at which a vein lies."""

VEIN_COLOUR = np.float32([0.13, 0.075, 0.035])
"""Log albedo that skin over a vein loses in red, green and blue: least where light returns from above it."""


def draw_vessels(field: Field, ground: Ground, texel: float, spec: FaceSpec) -> tuple[np.ndarray, np.ndarray]:
    """`threads` (M,): log luminance that red threads take away; `veins` (M,): share of vein below, 0 to 1.

    `texel` in mm.
    """
    sites = ground.sites
    rng = stream(spec.seed, "vessels")
    red = (1.5 * sites.wings + sites.nose + 0.8 * sites.cheek) * (1 - sites.lips) * (1 - sites.lids)
    often = _THREADS[spec.fitzpatrick] * rng.uniform(0.2, 1.6) * (0.5 + spec.age)
    threads = _winding(field, field.roots(often, red, ground, rng), (2.0, 9.0), (0.12, 0.28), 0.5, rng)
    layers, tone = field.draw(threads, 0.4)
    blue = (sites.temple + 0.35 * sites.forehead + 0.8 * sites.under_eye) * (1 - sites.lids)
    often = _VEINS[spec.fitzpatrick] * rng.uniform(0.3, 1.5)
    veins = _winding(field, field.roots(often, blue, ground, rng), (15.0, 40.0), (1.0, 2.0), 0.22, rng)
    wide = smoothed(np.minimum(field.draw(veins, 0.3)[0], 1.5), field.texels, _VEIN_BLUR_MM / texel)
    return np.minimum(layers, 1.2) * tone, np.clip(wide, 0, 1).astype(np.float32)


def _winding(
    field: Field,
    roots: np.ndarray,
    lengths: tuple[float, float],
    widths: tuple[float, float],
    turn: float,
    rng: np.random.Generator,
) -> Strands:
    """Vessels that start in any direction and turn by `turn` radians (standard deviation) with every step."""
    count, steps = len(roots), 12
    angle = rng.uniform(0, 2 * np.pi, count)
    start = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    turns = np.cumsum(rng.normal(0, turn, (count, steps)), axis=1)
    length, width = rng.uniform(*lengths, count), rng.uniform(*widths, count)
    paths = field.grow(roots, length, lambda points: start, turns, steps)
    return Strands(paths, width, rng.uniform(0.12, 0.4, count))

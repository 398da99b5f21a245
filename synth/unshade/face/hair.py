"""Hair as paint: brows stroke by stroke, a buzz-cut scalp, the shadow of a beard."""

from __future__ import annotations

import dataclasses

import numpy as np

from .noise import octaves
from .regions import bump, pair, smoothstep
from .spec import FaceSpec, stream
from .strokes import Sketch

# Linear Rec.709 albedo of hair, from black to blond, and of grey hair.
_SHADES = np.array([[0.016, 0.012, 0.010], [0.030, 0.020, 0.014], [0.055, 0.034, 0.021], [0.120, 0.078, 0.045]])
_GREY = np.array([0.25, 0.235, 0.215])
_LIGHTEST = {"I": 4, "II": 4, "III": 3, "IV": 2, "V": 1, "VI": 1}
"""How many of the shades a skin type can have."""

# Hairline: height (mm) over the eyes by angle (degrees) from straight ahead, round a vertical
# axis through the skull; it dips before the ears and ends in the nape.
_HAIRLINE_ANGLE = [0, 18, 30, 40, 48, 54, 58, 64, 70, 80, 95, 120, 180]
_HAIRLINE = [68, 67, 69, 63, 46, 30, 2, -14, 8, 4, -25, -55, -72]
_SKULL_AXIS_Z = -94.0


@dataclasses.dataclass(frozen=True)
class HairStyle:
    """Colours (3,) and amounts of one person's hair."""

    scalp: np.ndarray
    brow: np.ndarray
    recession: float
    beard: float


def hair_style(spec: FaceSpec) -> HairStyle:
    """Seeded colour, grey with age; hairline and beard by age and gender."""
    rng = stream(spec.seed, "hair")
    shade = _SHADES[rng.integers(_LIGHTEST[spec.fitzpatrick])]
    grey = smoothstep(0.35, 1.0, np.float64(spec.age)) * rng.uniform(0.3, 0.85)
    manly = float(smoothstep(0.5, 0.9, np.float64(spec.gender)))
    return HairStyle(
        scalp=shade + grey * (_GREY - shade),
        brow=0.8 * shade + 0.35 * grey * (_GREY - shade),
        recession=manly * (3.0 + 12.0 * spec.age * rng.uniform()) + rng.normal(0.0, 2.0),
        beard=manly * rng.uniform(0.25, 0.85),
    )


def scalp_cover(points: np.ndarray, style: HairStyle, seed: int) -> np.ndarray:
    """Share (M,) of buzz-cut hair at template points (M,3) mm; the same function on chart and rest of the head."""
    x, y, z = points.T
    angle = np.degrees(np.arctan2(np.abs(x), z - _SKULL_AXIS_Z))
    # Recession lifts the hairline most over the temples.
    temple = np.exp(-0.5 * ((angle - 34) / 14) ** 2)
    line = np.interp(angle, _HAIRLINE_ANGLE, _HAIRLINE) + style.recession * (0.4 + 0.9 * temple) * (angle < 75)
    rag = 2.0 * octaves(points, 16.0, 2, 0.0, stream(seed, "hairline"))
    thin = 0.03 + 0.012 * octaves(points, 12.0, 2, 0.0, stream(seed, "thin hair"))
    cover = smoothstep(-5.0, 6.0, y - line + rag) * np.clip(1 - thin, 0, 1)
    # Ears stand in front of hair that grows behind them.
    ear = smoothstep(70.0, 75.0, np.abs(x)) * smoothstep(30.0, 22.0, y)
    return (cover * (1 - ear)).astype(np.float32)


def scalp_grain(points: np.ndarray, finest: float, seed: int) -> np.ndarray:
    """Stubble: factor (M,) around 1 on the scalp's cover."""
    return np.clip(1 + 0.03 * octaves(points, 1.2, 2, finest, stream(seed, "stubble")), 0.5, 1.07)


def beard_cover(points: np.ndarray, lips: np.ndarray, style: HairStyle) -> np.ndarray:
    """Share (M,) of shaven beard: jaw, chin and upper lip."""
    if style.beard == 0:
        return np.zeros(len(points), dtype=np.float32)
    x, y, z = points.T
    jaw = smoothstep(-38, -72, y + 0.32 * np.abs(x)) * smoothstep(-80, -40, z) * smoothstep(-120, -104, y)
    lip = bump(points, (0, -54, 36), (22, 6, 16))
    # Little grows beside the middle of the lower lip.
    bare = pair(points, (16, -84, 26), (9, 5, 14))
    return (style.beard * np.clip(np.maximum(0.85 * jaw, lip) - 0.3 * bare, 0, 1) * (1 - lips)).astype(np.float32)


def draw_brows(sketch: Sketch, points: np.ndarray, texel: float, spec: FaceSpec) -> tuple[np.ndarray, np.ndarray]:
    """Share (M,) of each texel that brow hairs cover, and the brows' outline (M,) 0 to 1.

    Hairs grow up at the nose, then lean outward and down along the arch; hairs of the
    upper edge lean down, those of the lower edge up, so that they meet in a ridge.
    """
    rng = stream(spec.seed, "brows")
    base = 18.0 + rng.uniform(-1.5, 1.5) - 1.5 * spec.gender
    rise = rng.uniform(4.0, 7.0) - 2.0 * spec.gender
    thickness = rng.uniform(0.8, 1.2) * (0.82 + 0.42 * spec.gender)
    density = rng.uniform(0.85, 1.2) * (1 - 0.25 * spec.age)
    inner, length = 11.5, 41.0

    def arch(t):
        return base + rise * np.sin(0.5 * np.pi * np.minimum(t / 0.72, 1.0)) - 24.0 * np.maximum(t - 0.70, 0.0)

    def half_width(t):
        return 4.0 * thickness * (1 - 0.72 * t**1.5) * (0.75 + 0.25 * np.minimum(t / 0.15, 1.0))

    place = (np.abs(points[:, 0]) - inner) / length
    t = np.clip(place, 0, 1)
    across = np.abs(points[:, 1] - arch(t)) / half_width(t)
    ends = smoothstep(-0.06, 0.08, place) * smoothstep(1.1, 0.9, place) * (points[:, 2] > -30)
    outline = smoothstep(1.25, 0.7, across) * ends
    # Short hair and shadow between the strokes.
    bare = 1 - 0.3 * density * outline
    for side in (-1.0, 1.0):
        for _ in range(int(520 * density)):
            t = rng.beta(1.1, 1.25)
            off = np.clip(rng.normal(0, 0.5), -1.15, 1.15)
            root = np.array([side * (inner + length * t), arch(t) + off * half_width(t)])
            lean = 75 - 70 * min(1.5 * t, 1.0) - 24 * max(t - 0.6, 0.0) / 0.4 - 26 * off + rng.normal(0, 9)
            bend = np.radians([lean, lean - rng.uniform(5, 22)])
            step = 0.5 * rng.uniform(4.5, 8.5) * (1 - 0.25 * t) * np.stack([side * np.cos(bend), np.sin(bend)], axis=1)
            curve = np.stack([root, root + step[0], root + step[0] + step[1]])
            index, cover = sketch.coverage(curve, rng.uniform(0.16, 0.28), texel)
            bare[index] *= 1 - 0.85 * cover
    return (1 - bare).astype(np.float32), outline.astype(np.float32)

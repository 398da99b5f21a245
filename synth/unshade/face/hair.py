"""Hair as paint: brows stroke by stroke, a buzz-cut scalp, the shadow of a beard."""

from __future__ import annotations

import dataclasses

import numpy as np

from .noise import octaves
from .regions import Regions, bump, pair, smoothstep
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
    opacity: float = 0.93
    """Share of the skin that thick hair hides."""
    grey: float = 0.0
    """Share of grey strands among those of natural hair."""
    softness: float = 6.0
    """Way (mm) over which hair thickens behind the hairline."""
    ragged: float = 0.0
    """Standard deviation (mm) of the hairline's fine raggedness."""


def hair_style(spec: FaceSpec) -> HairStyle:
    """Seeded colour, grey with age; hairline and beard by age and gender."""
    rng = stream(spec.seed, "hair")
    shade = _SHADES[rng.integers(_LIGHTEST[spec.fitzpatrick])]
    grey = smoothstep(0.35, 1.0, np.float64(spec.age)) * rng.uniform(0.3, 0.85)
    manly = float(smoothstep(0.5, 0.9, np.float64(spec.gender)))
    style = HairStyle(
        scalp=shade + grey * (_GREY - shade),
        brow=0.85 * shade + 0.38 * grey * (_GREY - shade),
        recession=manly * (3.0 + 12.0 * spec.age * rng.uniform()) + rng.normal(0.0, 2.0),
        beard=manly * rng.uniform(0.25, 0.85),
    )
    if spec.detail == "smooth":
        return style
    # Between strands hardly any light returns, and single strands go grey; beards have the brows' colour.
    own = stream(spec.seed, "natural hair")
    darker = own.uniform(0.3, 0.6)
    return dataclasses.replace(
        style,
        scalp=darker * (shade + 0.3 * grey * (_GREY - shade)),
        brow=darker * style.brow,
        grey=grey,
        beard=manly * own.uniform(0.5, 1.0),
        opacity=0.985,
        softness=own.uniform(9.0, 18.0),
        ragged=own.uniform(1.5, 3.5),
    )


def scalp_cover(points: np.ndarray, style: HairStyle, seed: int) -> np.ndarray:
    """Share (M,) of buzz-cut hair at template points (M,3) mm; the same function on chart and rest of the head."""
    x, y, z = points.T
    angle = np.degrees(np.arctan2(np.abs(x), z - _SKULL_AXIS_Z))
    # Recession lifts the hairline most over the temples.
    temple = np.exp(-0.5 * ((angle - 34) / 14) ** 2)
    line = np.interp(angle, _HAIRLINE_ANGLE, _HAIRLINE) + style.recession * (0.4 + 0.9 * temple) * (angle < 75)
    rag = 2.0 * octaves(points, 16.0, 2, 0.0, stream(seed, "hairline"))
    if style.ragged:
        rag += style.ragged * octaves(points, 5.0, 3, 0.0, stream(seed, "ragged hairline"))
    thin = 0.03 + 0.012 * octaves(points, 12.0, 2, 0.0, stream(seed, "thin hair"))
    cover = smoothstep(-5.0, style.softness, y - line + rag) * np.clip(1 - thin, 0, 1)
    # Ears stand in front of hair that grows behind them.
    ear = smoothstep(70.0, 75.0, np.abs(x)) * smoothstep(30.0, 22.0, y)
    return (cover * (1 - ear)).astype(np.float32)


def scalp_grain(points: np.ndarray, finest: float, seed: int) -> np.ndarray:
    """Stubble: factor (M,) around 1 on the scalp's cover."""
    return np.clip(1 + 0.03 * octaves(points, 1.2, 2, finest, stream(seed, "stubble")), 0.5, 1.07)


def beard_cover(regions: Regions, style: HairStyle) -> np.ndarray:
    """Share (M,) of shaven beard: jaw, chin and upper lip."""
    points = regions.points
    if style.beard == 0:
        return np.zeros(len(points), dtype=np.float32)
    lip = bump(points, (0, -54, 36), (22, 6, 16))
    # Little grows beside the middle of the lower lip.
    bare = pair(points, (16, -84, 26), (9, 5, 14))
    return (style.beard * np.clip(np.maximum(0.85 * regions.jaw, lip) - 0.3 * bare, 0, 1) * (1 - regions.lips)).astype(
        np.float32
    )


def draw_brows(sketch: Sketch, points: np.ndarray, texel: float, spec: FaceSpec) -> tuple[np.ndarray, np.ndarray]:
    """Share (M,) of each texel that brow hairs cover, and the brows' outline (M,) 0 to 1.

    Hairs grow up at the nose, then lean outward and down along the arch; hairs of the
    upper edge lean down, those of the lower edge up, so that they meet in a ridge. They
    stand thick along the ridge and thin out to both edges and ends. The two brows of a
    face differ a little in height, arch and hairs.
    """
    rng = stream(spec.seed, "brows")
    base = 18.0 + rng.uniform(-1.5, 1.5) - 1.5 * spec.gender
    rise = rng.uniform(4.0, 7.0) - 2.0 * spec.gender
    thickness = rng.uniform(0.8, 1.2) * (0.82 + 0.42 * spec.gender)
    density = rng.uniform(0.85, 1.2) * (1 - 0.25 * spec.age)
    bare, outline = np.ones(len(points)), np.zeros(len(points))
    patchy = 1 + 0.35 * octaves(points, 2.5, 2, texel, stream(spec.seed, "brow shade"))
    for side in (-1.0, 1.0):
        own = stream(spec.seed, "brow", "right" if side < 0 else "left")
        brow = Brow(base + own.normal(0, 0.5), rise + own.normal(0, 0.4), 4.0 * thickness * own.uniform(0.95, 1.05))
        across, place = brow.place(side * points[:, 0], points[:, 1])
        ends = smoothstep(-0.08, 0.12, place) * smoothstep(1.08, 0.86, place) * (points[:, 2] > -30)
        here = smoothstep(1.25, 0.7, np.abs(across)) * ends
        outline = np.maximum(outline, here)
        # Fine hair between the drawn ones, and its shadow.
        bare *= 1 - np.clip(0.34 * density * patchy * np.exp(-((across / 0.75) ** 2)) * ends, 0, 0.8)
        for _ in range(int(430 * density)):
            curve, width = brow.hair(own)
            index, cover = sketch.coverage(curve * [side, 1], width, texel)
            bare[index] *= 1 - 0.75 * cover
    return (1 - bare).astype(np.float32), outline.astype(np.float32)


@dataclasses.dataclass(frozen=True)
class Brow:
    """Course of one brow over the frontal plane of the template, in mm: `base` height, `rise` of the arch, `half` its half height."""

    base: float
    rise: float
    half: float
    inner: float = 11.5
    length: float = 41.0

    def arch(self, t: np.ndarray) -> np.ndarray:
        """Height of the ridge at a share of the way from nose to temple."""
        return (
            self.base + self.rise * np.sin(0.5 * np.pi * np.minimum(t / 0.72, 1.0)) - 24.0 * np.maximum(t - 0.70, 0.0)
        )

    def half_height(self, t: np.ndarray) -> np.ndarray:
        return self.half * (1 - 0.66 * t**1.5) * (0.75 + 0.25 * np.minimum(t / 0.15, 1.0))

    def place(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Offset from the ridge in half heights, and share of the way along it, at distance `x` from the midline."""
        along = (x - self.inner) / self.length
        t = np.clip(along, 0, 1)
        return (y - self.arch(t)) / self.half_height(t), along

    def hair(self, rng: np.random.Generator) -> tuple[np.ndarray, float]:
        """One hair: polyline (3,2) on the +x side and its width at the root."""
        t = rng.beta(1.2, 1.35)
        # Short of the inner end there is room for fewer rows.
        off = np.clip(rng.normal(0, 0.48), -1.2, 1.2) * (0.5 + 0.5 * min(t / 0.2, 1.0))
        root = np.array([self.inner + self.length * t, self.arch(t) + off * self.half_height(t)])
        lean = 75 - 70 * min(1.5 * t, 1.0) - 24 * max(t - 0.6, 0.0) / 0.4 - 26 * off + rng.normal(0, 11)
        angles = np.radians([lean, lean - rng.uniform(5, 22)])
        step = 0.5 * rng.uniform(4.0, 8.0) * (1 - 0.25 * t) * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        return np.stack([root, root + step[0], root + step[0] + step[1]]), rng.uniform(0.13, 0.24)

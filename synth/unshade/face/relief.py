"""The painted height of the skin: pores, fine texture, creases of the lips, wrinkles, brow hair; in millimetres."""

from __future__ import annotations

import dataclasses

import numpy as np

from .noise import cells, octaves, smooth_noise
from .regions import Regions, smoothstep
from .spec import FaceSpec, stream
from .strokes import Sketch


UNDULATION_MM = 0.17
"""Standard deviation of the unevenness at 2 to 9 mm: fat, muscle and follicles under the skin.

With it the specular normals lie about 3 degrees from those of the smooth mesh, as those of a
scanned face do from its multi-view-stereo mesh."""


@dataclasses.dataclass(frozen=True)
class Relief:
    """`height` (M,) mm over the smooth mesh; `pores` and `creases` (M,) 0 to 1, for the colour in their depth."""

    height: np.ndarray
    pores: np.ndarray
    creases: np.ndarray


def draw_relief(regions: Regions, places: np.ndarray, sketch: Sketch, brows: np.ndarray, texel: float, spec: FaceSpec) -> Relief:
    """Relief at the texels of the chart.

    `places` (M,2) are chart coordinates in mm, `texel` the side of a texel in mm; detail
    finer than two texels is left out.
    """
    smooth = 1 - 0.85 * regions.upper_lid
    bare = (1 - regions.lips) * smooth
    amount = np.clip(0.35 + 1.2 * regions.nose + 0.8 * regions.cheek + 0.4 * regions.forehead + 0.3 * regions.chin, 0, 1.6)
    pores = _pores(places, texel, spec) * amount * bare
    height = -0.10 * pores
    height += 0.022 * bare * _grain(regions.points, places, texel, spec)
    height += UNDULATION_MM * octaves(regions.points, 9.0, 3, 2 * texel, stream(spec.seed, "undulation"))
    lips = regions.lips > 0
    height[lips] += _lip_creases(regions.points[lips], regions.lips[lips], texel, spec)
    creases = _wrinkles(sketch, len(height), texel, spec) * (1 - regions.lips)
    height -= creases
    height += 0.08 * brows
    return Relief(
        height.astype(np.float32), np.clip(pores, 0, 1).astype(np.float32), np.clip(creases / 0.5, 0, 1).astype(np.float32)
    )


def _pores(places: np.ndarray, texel: float, spec: FaceSpec) -> np.ndarray:
    """Pits (M,) 0 to 1 on a jittered grid."""
    spacing = 1.7
    # A pit is about half a spacing wide; below two texels it could only alias.
    shown = float(smoothstep(0.9, 0.4, np.float64(texel)))
    return shown * np.exp(-((cells(places, spacing, stream(spec.seed, "pores")) / 0.24) ** 2))


def _grain(points: np.ndarray, places: np.ndarray, texel: float, spec: FaceSpec) -> np.ndarray:
    """Fine texture (M,): raised cells between crossing furrows, rougher with age."""
    rng = stream(spec.seed, "grain")
    shown = float(smoothstep(0.7, 0.3, np.float64(texel)))
    furrows = shown * smoothstep(0.35, 0.75, cells(places, 1.1, rng))
    return (octaves(points, 3.0, 3, 2 * texel, rng) - 1.2 * furrows) * (0.7 + 0.6 * spec.age)


def _lip_creases(points: np.ndarray, lips: np.ndarray, texel: float, spec: FaceSpec) -> np.ndarray:
    """Vertical furrows of the lips, mm, at points (K,3) with their share (K,) of lip."""
    if texel > 0.8:
        return np.zeros(len(points), dtype=np.float32)
    squeezed = points * np.float32([1.0, 0.22, 0.5])
    furrow = np.abs(smooth_noise(squeezed, 1.5, stream(spec.seed, "lip creases")))
    return lips * (0.05 * np.minimum(furrow, 1.0) - 0.03)


def _wrinkles(sketch: Sketch, count: int, texel: float, spec: FaceSpec) -> np.ndarray:
    """Depth of wrinkles (count,), mm: none in youth but faint lines, deep ones in age."""
    rng = stream(spec.seed, "wrinkles")
    depth = np.zeros(count)
    age = float(smoothstep(0.1, 1.0, np.float64(spec.age)))
    for curve, deep, wide in _wrinkle_curves(rng, age):
        index, distance, along = sketch.near(curve, 3 * wide + texel)
        width = max(wide, 0.7 * texel)
        taper = smoothstep(0, 0.3, along) * smoothstep(1, 0.6, along)
        # A narrow line that widens to the texel keeps its volume.
        profile = deep * (wide / width) * taper * np.exp(-((distance / width) ** 2))
        depth[index] = np.maximum(depth[index], profile)
    return depth


def _wrinkle_curves(rng: np.random.Generator, age: float):
    """Polylines (K,2) in the frontal plane of the template (mm), their depth and half width (mm)."""

    def wavy(x: np.ndarray, y: np.ndarray, sway: float) -> np.ndarray:
        phase, pitch = rng.uniform(0, 2 * np.pi), rng.uniform(14, 26)
        return np.stack([x, y + sway * np.sin(x / pitch + phase)], axis=1)

    for k in range(5):  # forehead
        reach, shift = rng.uniform(24, 40), rng.normal(0, 4)
        x = np.linspace(-reach, reach, 40) + shift
        y = 36 + 8.5 * k + rng.normal(0, 1.2) + 2.5 * np.cos(x / 16 + rng.normal(0, 0.3))
        yield wavy(x, y, 0.8), (0.02 + 0.40 * age) * rng.uniform(0.4, 1), rng.uniform(0.7, 1.1)
    for side in (-1.0, 1.0):
        for k in range(6):  # crow's feet
            angle = np.radians(-34 + 13 * k + rng.normal(0, 4))
            start = np.array([47.0, 1.0]) + rng.normal(0, 0.8, 2)
            t = np.linspace(0, rng.uniform(10, 19), 12)
            bow = 0.012 * (k - 2.5) * t**2
            curve = start + np.stack([t * np.cos(angle), t * np.sin(angle) + bow], axis=1)
            yield curve * [side, 1], (0.01 + 0.30 * age) * rng.uniform(0.4, 1), rng.uniform(0.5, 0.8)
        for k in range(3):  # under the eye
            x = np.linspace(17 + 1.5 * k, 42 - k, 24)
            y = -10.5 - 3.2 * k - 3.0 * np.sin(np.pi * (x - 15) / 30) + rng.normal(0, 0.4)
            yield wavy(x, y, 0.3) * [side, 1], (0.02 + 0.20 * age) * rng.uniform(0.5, 1), rng.uniform(0.5, 0.8)
        t = np.linspace(0, 1, 24)  # nose to mouth
        fold = np.stack([17 + 14 * t + 2 * np.sin(np.pi * t), -35 - 34 * t], axis=1)
        yield fold * [side, 1], (0.03 + 0.50 * age) * rng.uniform(0.7, 1), 1.5
        fold = np.stack([27 + 3 * t, -72 - 20 * t], axis=1)  # below the mouth's corner
        yield fold * [side, 1], 0.40 * age * rng.uniform(0.5, 1), 1.2
        t = np.linspace(0, 1, 12)  # between the brows
        frown = np.stack([5.5 + 1.5 * t + rng.normal(0, 0.6), 12 + 16 * t], axis=1)
        yield frown * [side, 1], (0.01 + 0.35 * age) * rng.uniform(0.3, 1), 0.9

"""The painted height of the skin: unevenness, pores, furrows, creases of the lips, wrinkles, brow hair; in millimetres."""

from __future__ import annotations

import dataclasses

import numpy as np

from .noise import octaves, smooth_noise
from .pores import draw_fine_relief
from .regions import Regions
from .spec import FaceSpec, stream
from .strokes import Sketch
from .wrinkles import draw_crinkle, draw_folds

UNDULATION_MM = 0.17
"""Standard deviation of the unevenness at 2 to 9 mm: fat, muscle and follicles under the skin.

With it the specular normals lie about 3 degrees from those of the smooth mesh, as those of a
scanned face do from its multi-view-stereo mesh."""

PORE_MM, FURROW_MM = 0.10, 0.034
"""Depths of a large pore and of a furrow."""


@dataclasses.dataclass(frozen=True)
class Relief:
    """`height` (M,) mm over the smooth mesh; `pores`, `furrows` and `creases` (M,) 0 to 1, for the colour in their depth."""

    height: np.ndarray
    pores: np.ndarray
    furrows: np.ndarray
    creases: np.ndarray


def draw_relief(
    regions: Regions, places: np.ndarray, sketch: Sketch, brows: np.ndarray, texel: float, spec: FaceSpec
) -> Relief:
    """Relief at the texels of the chart.

    `places` (M,2) are chart coordinates in mm, `texel` the side of a texel in mm; detail
    finer than that is averaged or left out.
    """
    rough = np.float32(0.7 + 0.6 * spec.age)
    fine = draw_fine_relief(regions, places, texel, spec)
    height = -PORE_MM * fine.pores - FURROW_MM * rough * fine.furrows
    bare = (1 - regions.lips) * (1 - 0.85 * regions.upper_lid)
    height += 0.022 * rough * bare * octaves(regions.points, 3.0, 3, 2 * texel, stream(spec.seed, "grain"))
    # Natural skin has undulations of its own; stronger ones become dark lumps where light grazes.
    undulation = UNDULATION_MM if spec.detail == "smooth" else 0.3 * UNDULATION_MM
    height += undulation * octaves(regions.points, 9.0, 3, 2 * texel, stream(spec.seed, "undulation"))
    lips = regions.lips > 0
    height[lips] += _lip_creases(regions.points[lips], regions.lips[lips], texel, spec)
    folds = draw_folds(sketch, len(height), texel, spec) * (1 - regions.lips)
    crinkle = draw_crinkle(regions, texel, spec)
    height -= folds + crinkle
    height += 0.08 * brows
    return Relief(
        height=height.astype(np.float32),
        pores=np.clip(fine.pores, 0, 1),
        furrows=np.clip(fine.furrows, 0, 1),
        creases=np.clip((folds + crinkle) / 0.5, 0, 1).astype(np.float32),
    )


def _lip_creases(points: np.ndarray, lips: np.ndarray, texel: float, spec: FaceSpec) -> np.ndarray:
    """Vertical furrows of the lips, mm, at points (K,3) with their share (K,) of lip."""
    if texel > 0.8:
        return np.zeros(len(points), dtype=np.float32)
    squeezed = points * np.float32([1.0, 0.22, 0.5])
    furrow = np.abs(smooth_noise(squeezed, 1.5, stream(spec.seed, "lip creases")))
    return lips * (0.05 * np.minimum(furrow, 1.0) - 0.03)

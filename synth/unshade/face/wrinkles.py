"""Wrinkles: single folds drawn as curves, and the crinkle of ageing skin between them; depths in millimetres.

Places and their order of appearance follow the clinical scales of facial ageing (Lemperle
et al. 2001: forehead, glabella, crow's feet, nasolabial, marionette, upper lip; depths of
0.05 mm for the finest to 0.8 mm for the deepest grade).
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from .noise import smooth_noise
from .regions import Regions, pair, smoothstep
from .spec import FaceSpec, stream
from .strokes import Sketch


@dataclasses.dataclass(frozen=True)
class Fold:
    """One wrinkle: polyline (K,2) in the frontal plane of the template (mm), depth and half width (mm)."""

    curve: np.ndarray
    depth: float
    width: float


def draw_folds(sketch: Sketch, count: int, texel: float, spec: FaceSpec) -> np.ndarray:
    """Depth (count,) mm of the folds at the texels: faint lines in youth, deep ones in age; below 0 on their swollen rims."""
    rng = stream(spec.seed, "wrinkles")
    depth = np.zeros(count)
    for fold in _folds(rng, _onset(spec)):
        index, distance, along = sketch.near(fold.curve, 4.5 * fold.width + texel)
        # A line narrower than a texel is drawn wider and shallower: its volume stays.
        width = max(fold.width, 0.7 * texel)
        strength = fold.depth * fold.width / width * _taper(along, rng)
        groove = np.exp(-((distance / width) ** 1.5))
        swelling = 0.2 * np.exp(-(((distance - 2.2 * width) / (1.1 * width)) ** 2))
        depth[index] += strength * (groove - swelling)
    return depth.astype(np.float32)


def draw_crinkle(regions: Regions, texel: float, spec: FaceSpec) -> np.ndarray:
    """Depth (M,) mm of fine crossing lines of dry, ageing skin: cheeks, under the eyes, round the mouth."""
    points, age = regions.points, _onset(spec)
    amount = np.clip(regions.cheek + 1.2 * regions.under_eye + 0.7 * regions.perioral + 0.35 * regions.temple, 0, 1.3)
    amount *= (1 - regions.lips) * np.float32(0.008 + 0.05 * age**1.5) / np.float32(np.hypot(1, texel / 0.45))
    lines = np.zeros(len(points), dtype=np.float32)
    there = np.flatnonzero(amount > 0.002)
    x, y, z = points[there].T
    for slope, name in ((-62.0, "crinkle down"), (24.0, "crinkle across")):
        along, across = np.cos(np.radians(slope)), np.sin(np.radians(slope))
        aligned = np.stack(
            [0.34 * (np.abs(x) * along + y * across), y * along - np.abs(x) * across, 0.5 * z + 200 * (x > 0)], axis=1
        )
        # Lines are where smooth noise, drawn out along them, changes its sign.
        lines[there] += np.exp(-((smooth_noise(aligned.astype(np.float32), 1.5, stream(spec.seed, name)) / 0.5) ** 2))
    return amount * lines


def _onset(spec: FaceSpec) -> float:
    return float(smoothstep(0.1, 1.0, np.float64(spec.age)))


def _taper(along: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Strength along a fold: 0 at its ends, uneven between."""
    uneven = np.interp(along, np.linspace(0, 1, 9), rng.uniform(0.45, 1.15, 9))
    return uneven * smoothstep(0, 0.3, along) * smoothstep(1, 0.65, along)


def _folds(rng: np.random.Generator, age: float) -> Iterator[Fold]:
    def wavy(x: np.ndarray, y: np.ndarray, sway: float) -> np.ndarray:
        phase, pitch = rng.uniform(0, 2 * np.pi, 2), rng.uniform(14, 26)
        return np.stack(
            [x, y + sway * (np.sin(x / pitch + phase[0]) + 0.5 * np.sin(2.7 * x / pitch + phase[1]))], axis=1
        )

    for k in range(6):  # forehead: each line is in two or three pieces that miss each other a little
        level = 33 + 7.5 * k + rng.normal(0, 1.5)
        deep, arch = (0.015 + 0.36 * age) * rng.uniform(0.25, 1) * (1 - 0.09 * k), rng.normal(2.5, 0.8)
        ends = np.cumsum(np.r_[rng.uniform(-44, -30), rng.uniform(22, 40, 3)])
        for left, right in pairwise(ends):
            x = np.linspace(left - 4, min(right, 44.0) + 4, 26)
            yield Fold(
                wavy(x, level + rng.normal(0, 1.0) + arch * np.cos(x / 17), 0.7),
                deep * rng.uniform(0.5, 1),
                rng.uniform(0.55, 1.0),
            )
    for side in (-1.0, 1.0):
        mirror = np.array([side, 1.0])
        for k in range(7):  # crow's feet
            angle = np.radians(-38 + 12 * k + rng.normal(0, 4))
            start = np.array([46.5, 0.5]) + rng.normal(0, 0.9, 2)
            t = np.linspace(0, rng.uniform(9, 20), 12)
            bow = 0.012 * (k - 3) * t**2
            curve = start + np.stack([t * np.cos(angle), t * np.sin(angle) + bow], axis=1)
            yield Fold(curve * mirror, (0.01 + 0.26 * age) * rng.uniform(0.3, 1), rng.uniform(0.4, 0.7))
        for k in range(4):  # under the eye
            x = np.linspace(16 + 1.5 * k, 42 - k, 24)
            y = -10.0 - 2.8 * k - 3.0 * np.sin(np.pi * (x - 15) / 30) + rng.normal(0, 0.4)
            yield Fold(wavy(x, y, 0.3) * mirror, (0.02 + 0.17 * age) * rng.uniform(0.4, 1), rng.uniform(0.4, 0.7))
        t = np.linspace(0, 1, 24)  # nose to mouth
        curve = np.stack([17 + 14 * t + 2 * np.sin(np.pi * t), -35 - 34 * t], axis=1)
        yield Fold(curve * mirror, (0.03 + 0.50 * age) * rng.uniform(0.7, 1), 1.5)
        curve = np.stack([26.5 + 2.5 * t, -72 - 19 * t], axis=1)  # below the mouth's corner
        yield Fold(curve * mirror, 0.38 * age * rng.uniform(0.5, 1), 1.2)
        t = np.linspace(0, 1, 12)  # between the brows
        curve = np.stack([5.5 + 1.5 * t + rng.normal(0, 0.6) + 0.8 * np.sin(2 * t), 10 + 15 * t], axis=1)
        yield Fold(curve * mirror, (0.01 + 0.32 * age) * rng.uniform(0.3, 1), 0.8)
        for place in np.sort(rng.uniform(2.5, 20, 5)):  # above the upper lip
            curve = np.stack([place + 0.12 * place * t, -56.0 - 0.012 * place**2 + rng.uniform(4, 8) * t], axis=1)
            yield Fold(curve * mirror, 0.16 * age**2 * rng.uniform(0.2, 1), rng.uniform(0.35, 0.55))


def slackness(regions: Regions, spec: FaceSpec) -> np.ndarray:
    """How much (M,) 0 to 1 pores and furrows are drawn out where ageing skin hangs: the cheeks."""
    sagging = pair(regions.points, (40, -46, 2), (18, 20, 28))
    return sagging * np.float32(0.35 + 0.65 * _onset(spec))

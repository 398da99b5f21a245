"""Many fine curves on the skin, grown over the surface and drawn all at once: hairs and vessels."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np

from .texels import Texels

_STEP_TEXELS = 0.7
"""Distance of the points that stand for a strand's length."""

_BATCH = 12000
"""Strands drawn at a time, to bound memory."""


@dataclasses.dataclass(frozen=True)
class Strands:
    """Paths (K,S,2) in texels (column, row; centres at +.5), root first; `width` (K,) mm at the root, `tone` (K,) of each."""

    paths: np.ndarray
    width: np.ndarray
    tone: np.ndarray


@dataclasses.dataclass(frozen=True)
class Ground:
    """The chart as triangles: `uv` (C,2), `triangles` (F,3), their `area` (F,) on the template in mm2."""

    uv: np.ndarray
    triangles: np.ndarray
    area: np.ndarray


class Field:
    """The chart's texels as ground for strands."""

    def __init__(self, texels: Texels, nearest: tuple[np.ndarray, np.ndarray], points: np.ndarray):
        """`points` (M,3) template mm of the texels; `nearest` those of `Texels.nearest_inside`."""
        self.texels, self.size = texels, len(texels.inside)
        self.points = texels.image(points)[nearest]
        self.down, self.across = (np.gradient(self.points, axis=axis) for axis in (0, 1))

    def _at(self, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        cell = np.clip(places.astype(np.int64), 0, self.size - 1)
        return cell[:, 1], cell[:, 0]

    def roots(self, per_cm2: float, weight: np.ndarray, ground: Ground, rng: np.random.Generator) -> np.ndarray:
        """Places (K,2) in texels, `per_cm2` strands on a square centimetre of the template where the `weight` (C,) is 1.

        They stay where they are when the texture's size changes.
        """
        mass = ground.area * weight[ground.triangles].mean(axis=1)
        total = mass.sum(dtype=np.float64)
        count = int(per_cm2 * total / 100)
        if not count:
            return np.empty((0, 2))
        corner = ground.uv[ground.triangles[rng.choice(len(mass), count, p=mass / total)]]
        # Even over the triangle (Turk 1990).
        s, t = np.sqrt(rng.random((count, 1))), rng.random((count, 1))
        place = (1 - s) * corner[:, 0] + s * (1 - t) * corner[:, 1] + s * t * corner[:, 2]
        return np.stack([place[:, 0], 1 - place[:, 1]], axis=1) * self.size

    def grow(
        self,
        roots: np.ndarray,
        length: np.ndarray,
        towards: Callable[[np.ndarray], np.ndarray],
        turns: np.ndarray,
        steps: int = 8,
    ) -> np.ndarray:
        """Paths (K,steps+1,2) of `length` (K,) mm that follow `towards`, a direction (K,3) at template points (K,3).

        `turns` (K,steps) radians turn each step away from it, within the surface.
        """
        paths = [roots]
        for k in range(steps):
            at = self._at(paths[-1])
            down, across = self.down[at], self.across[at]
            wish = towards(self.points[at])
            e, f, g = ((a * b).sum(axis=1) for a, b in ((across, across), (across, down), (down, down)))
            a, d = (wish * across).sum(axis=1), (wish * down).sum(axis=1)
            area = np.maximum(e * g - f * f, 1e-12)
            move = np.stack([g * a - f * d, e * d - f * a], axis=1) / area[:, None]
            cos, sin = np.cos(turns[:, k]), np.sin(turns[:, k])
            move = np.stack([cos * move[:, 0] - sin * move[:, 1], sin * move[:, 0] + cos * move[:, 1]], axis=1)
            on_surface = np.linalg.norm(move[:, :1] * across + move[:, 1:] * down, axis=1)
            paths.append(paths[-1] + move * (length / steps / np.maximum(on_surface, 1e-9))[:, None])
        return np.stack(paths, axis=1)

    def draw(self, strands: Strands, taper: float = 0.7) -> tuple[np.ndarray, np.ndarray]:
        """Layers (M,) of strands over each texel (1: covered once on average) and their mean tone (M,), 0 where there are none.

        Strands lose `taper` of their width on the way to the tip; a bilinear foot spreads each
        point over four texels.
        """
        layers, tones = np.zeros(self.size**2), np.zeros(self.size**2)
        for start in range(0, len(strands.paths), _BATCH):
            self._splat(strands, slice(start, start + _BATCH), taper, layers, tones)
        inside = self.texels.inside.ravel()
        layers, tones = layers[inside], tones[inside]
        return layers.astype(np.float32), (tones / np.maximum(layers, 1e-9)).astype(np.float32)

    def _splat(self, strands: Strands, part: slice, taper: float, layers: np.ndarray, tones: np.ndarray) -> None:
        paths = strands.paths[part]
        if not len(paths):
            return
        pieces = np.linalg.norm(np.diff(paths, axis=1), axis=2)
        count = max(2, int(np.ceil(pieces.max() / _STEP_TEXELS)))
        fraction = (np.arange(count) + 0.5) / count
        ahead = paths[:, 1:, None] - paths[:, :-1, None]
        places = (paths[:, :-1, None] + fraction[:, None] * ahead).reshape(-1, 2)
        along = ((np.arange(paths.shape[1] - 1)[:, None] + fraction) / (paths.shape[1] - 1)).ravel()
        at = self._at(places)
        across, down = self.across[at], self.down[at]
        step = np.repeat(ahead / count, count, axis=2).reshape(-1, 2)
        length = np.linalg.norm(step[:, :1] * across + step[:, 1:] * down, axis=1)
        width = (strands.width[part, None] * (1 - taper * along**2)).ravel()
        # Texels that each point stands for: its piece of the strand over a texel's surface.
        area = length * width / np.maximum(np.linalg.norm(np.cross(across, down), axis=1), 1e-9)
        tone = np.repeat(strands.tone[part], along.size)
        corner = np.floor(places - 0.5).astype(np.int64)
        within = places - 0.5 - corner
        for dx in (0, 1):
            for dy in (0, 1):
                foot = (within[:, 0] if dx else 1 - within[:, 0]) * (within[:, 1] if dy else 1 - within[:, 1])
                column, row = corner[:, 0] + dx, corner[:, 1] + dy
                valid = (column >= 0) & (row >= 0) & (column < self.size) & (row < self.size)
                index, amount = (row * self.size + column)[valid], (area * foot)[valid]
                layers += np.bincount(index, amount, minlength=layers.size)
                tones += np.bincount(index, amount * tone[valid], minlength=tones.size)

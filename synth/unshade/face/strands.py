"""Many fine curves on the skin, grown over the surface and drawn all at once: hairs and vessels."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np

from .regions import Regions
from .texels import Texels

_STEP_TEXELS = 0.9
"""Largest distance of the points that stand for a strand's length."""

_TELLING_MM = 0.33
"""Side of the texels on which strands are told apart, where the texture's are larger."""

_BATCH = 1 << 20
"""Points drawn at a time, to bound memory."""


@dataclasses.dataclass(frozen=True)
class Strands:
    """Paths (K,S,2) in texels (column, row; centres at +.5), root first; `width` (K,) mm at the root, `tone` (K,) of each."""

    paths: np.ndarray
    width: np.ndarray
    tone: np.ndarray


@dataclasses.dataclass(frozen=True)
class Ground:
    """Skin on which strands are rooted: `corners` (F,3,2) UV of its triangles in the painted chart, their `triangles`
    (F,3) as indices into `sites`, their `area` (F,) on the template in mm2, and its `name` in random streams.

    `elsewhere` (F,) bool, if any: triangles that are not in the painted chart. Their strands are drawn to keep the others
    the same as in the chart that has them all.
    """

    corners: np.ndarray
    triangles: np.ndarray
    area: np.ndarray
    sites: Regions
    name: str = ""
    elsewhere: np.ndarray | None = None


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

    def at(self, places: np.ndarray) -> np.ndarray:
        """Template points (K,3) at places (K,2) in texels; any for those elsewhere."""
        return self.points[self._at(np.nan_to_num(places))]

    def roots(self, per_cm2: float, weight: np.ndarray, ground: Ground, rng: np.random.Generator) -> np.ndarray:
        """Places (K,2) in texels, `per_cm2` strands on a square centimetre of the template where the `weight` (C,) is 1.

        They stay where they are when the texture's size changes; those elsewhere are NaN.
        """
        mass = ground.area * weight[ground.triangles].mean(axis=1)
        total = mass.sum(dtype=np.float64)
        count = int(per_cm2 * total / 100)
        if not count:
            return np.empty((0, 2))
        chosen = rng.choice(len(mass), count, p=mass / total)
        corner = ground.corners[chosen]
        # Even over the triangle (Turk 1990).
        s, t = np.sqrt(rng.random((count, 1))), rng.random((count, 1))
        place = (1 - s) * corner[:, 0] + s * (1 - t) * corner[:, 1] + s * t * corner[:, 2]
        if ground.elsewhere is not None:
            place[ground.elsewhere[chosen]] = np.nan
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

    def strands(
        self,
        roots: np.ndarray,
        length: np.ndarray,
        towards: Callable[[np.ndarray], np.ndarray],
        turns: np.ndarray,
        width: np.ndarray,
        tone: np.ndarray,
    ) -> Strands:
        """Strands grown from those of the `roots` (K,2) that lie in this chart; all else as for `grow` and `Strands`."""
        here = np.isfinite(roots[:, 0])
        return Strands(self.grow(roots[here], length[here], towards, turns[here]), width[here], tone[here])

    def draw(self, strands: Strands, taper: float) -> tuple[np.ndarray, np.ndarray]:
        """Layers (M,) of strands over each texel (1: covered once on average) and their mean tone (M,), 0 where there are none.

        Strands lose `taper` of their width on the way to the tip; a bilinear foot spreads each
        point over four texels.
        """
        layers, tones = (picture[self.texels.inside] for picture in self._drawn([strands], taper, 1))
        return layers.astype(np.float32), (tones / np.maximum(layers, 1e-9)).astype(np.float32)

    def cover(self, groups: list[Strands], opacity: float, texel: float) -> tuple[np.ndarray, np.ndarray]:
        """Share (M,) of each texel of `texel` mm that strands cover, of which one layer hides 1 - exp(-`opacity`), and the
        mean tone (M,) of what covers it.

        Strands that lie side by side in a coarse texel hide more of it than such that lie on one another, so they are
        drawn on texels fine enough to tell them apart.
        """
        fine = max(1, round(texel / _TELLING_MM))
        layers, tones = self._drawn(groups, 0.7, fine)
        cover = 1 - np.exp(-opacity * layers)
        tones = cover * tones / np.maximum(layers, 1e-9)
        blocks = (self.size, fine, self.size, fine)
        cover, tones = (picture.reshape(blocks).mean(axis=(1, 3))[self.texels.inside] for picture in (cover, tones))
        return cover.astype(np.float32), (tones / np.maximum(cover, 1e-9)).astype(np.float32)

    def _drawn(self, groups: list[Strands], taper: float, fine: int) -> np.ndarray:
        """Layers and their summed tones (2,N,N) on a grid `fine` times as fine as the texels."""
        side = fine * self.size + 2
        # A margin of a texel catches feet outside the picture.
        layers, tones = np.zeros((2, side**2))
        for strands in groups:
            pieces = fine * np.linalg.norm(np.diff(strands.paths, axis=1), axis=2).max(axis=1, initial=0.0)
            # Strands of like length are drawn together, with as many points.
            order = np.argsort(pieces, kind="stable")
            start = 0
            while start < len(order):
                count = max(2, int(np.ceil(pieces[order[start]] / _STEP_TEXELS)))
                most = max(1, _BATCH // (count * strands.paths.shape[1]))
                part = order[start : start + most]
                part = part[: np.searchsorted(pieces[part], max(1.25 * count, 2) * _STEP_TEXELS, side="right")]
                count = max(count, int(np.ceil(pieces[part[-1]] / _STEP_TEXELS)))
                self._splat(
                    strands.paths[part], strands.width[part], strands.tone[part], count, taper, fine, layers, tones
                )
                start += len(part)
        return np.stack([picture.reshape(side, side)[1:-1, 1:-1] for picture in (layers, tones)])

    def _splat(
        self, paths, width, tone, count: int, taper: float, fine: int, layers: np.ndarray, tones: np.ndarray
    ) -> None:
        """Adds strands, each of whose pieces is `count` points, to `layers` and `tones`."""
        ahead = np.diff(paths, axis=1)
        at = self._at((paths[:, :-1] + 0.5 * ahead).reshape(-1, 2))
        across, down = self.across[at], self.down[at]
        step = ahead.reshape(-1, 2) / count
        length = np.linalg.norm(step[:, :1] * across + step[:, 1:] * down, axis=1)
        e, f, g = ((a * b).sum(axis=1) for a, b in ((across, across), (across, down), (down, down)))
        # Texels that each point stands for: its part of the strand over a texel's surface.
        share = fine**2 * length / np.maximum(np.sqrt(np.maximum(e * g - f * f, 0)), 1e-9)
        fraction = (np.arange(count) + 0.5) / count
        along = (np.arange(ahead.shape[1])[:, None] + fraction) / ahead.shape[1]
        area = share.reshape(len(paths), -1, 1) * width[:, None, None] * (1 - taper * along**2)
        side = fine * self.size + 2
        places = fine * (paths[:, :-1, None] + fraction[:, None] * ahead[:, :, None]) + 0.5
        places = np.clip(places, 0, side - 1.001)
        corner = places.astype(np.int32)
        right, low = np.moveaxis(places - corner, -1, 0)
        first = corner[..., 1] * side + corner[..., 0]
        tone = np.broadcast_to(tone[:, None, None], first.shape)
        for dy, dx in ((0, 0), (0, 1), (1, 0), (1, 1)):
            amount = area * (right if dx else 1 - right) * (low if dy else 1 - low)
            index = (first + (dy * side + dx)).ravel()
            layers += np.bincount(index, amount.ravel(), minlength=layers.size)
            tones += np.bincount(index, (amount * tone).ravel(), minlength=layers.size)

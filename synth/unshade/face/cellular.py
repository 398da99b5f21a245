"""Cellular patterns over the chart: jittered points with a random number each, and distances to them.

The points are anchored in the chart, which is the same template place in every face and at
every texture size; what is finer than a texel is averaged over it, not left out.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator

import numpy as np

_PERIOD = 512
"""Cells after which a pattern repeats: more than any pattern has across the chart."""

_BATCH = 1 << 17
"""Texels worked on at a time, so that they stay in the processor's cache."""


@dataclasses.dataclass(frozen=True)
class Grain:
    """Which way a pattern runs at each texel: `along` (M,2) unit vectors of the chart, `stretch` (M,) 1 or more.

    Distances along count `stretch` times less than those across.
    """

    along: np.ndarray
    stretch: np.ndarray


class Cells:
    """One point per cell of a square grid of `spacing` mm."""

    def __init__(self, spacing: float, rng: np.random.Generator):
        self.spacing = spacing
        self.jitter = rng.random((_PERIOD, _PERIOD, 2), dtype=np.float32)
        self.lot = rng.random((_PERIOD, _PERIOD), dtype=np.float32)

    def neighbours(self, places: np.ndarray, grain: Grain | None) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Squared distance (mm2) and random number (M,) of the nine points around places (M,2) mm."""
        scaled = (places / np.float32(self.spacing)).astype(np.float32)
        cell = np.floor(scaled).astype(np.int32)
        within = scaled - cell
        for dx in (-1, 0, 1):
            column = (cell[:, 0] + dx) % _PERIOD
            for dy in (-1, 0, 1):
                row = (cell[:, 1] + dy) % _PERIOD
                offset = self.jitter[column, row] + np.float32([dx, dy]) - within
                squared = np.einsum("ij,ij->i", offset, offset)
                if grain is not None:
                    along = np.einsum("ij,ij->i", offset, grain.along)
                    # The area of a pattern's elements is kept: shorter across as they get longer.
                    squared = squared * grain.stretch + along * along * (1 / grain.stretch - grain.stretch)
                yield squared * np.float32(self.spacing**2), self.lot[column, row]


def _batches(count: int) -> Iterator[slice]:
    return (slice(start, min(start + _BATCH, count)) for start in range(0, count, _BATCH))


def pits(
    places: np.ndarray,
    cells: Cells,
    radii: tuple[float, float],
    fraction: float,
    texel: float,
    grain: Grain | None = None,
) -> np.ndarray:
    """Round pits (M,) f32 at `fraction` of the cells' points: sum of Gaussians of height 1 at most.

    A pit's radius (mm, where it is down to 1/e) and its strength grow with its random number,
    over `radii`; the mean over a texel of `texel` mm stands for what is finer.
    """
    total = np.empty(len(places), dtype=np.float32)
    blur = np.float32((0.6 * texel) ** 2)
    for part in _batches(len(places)):
        own = None if grain is None else Grain(grain.along[part], grain.stretch[part])
        depth = np.zeros(part.stop - part.start, dtype=np.float32)
        for squared, lot in cells.neighbours(places[part], own):
            size = np.clip(lot / np.float32(fraction), 0, 1)
            reach = np.float32(radii[0]) + size * np.float32(radii[1] - radii[0])
            reach *= reach
            strength = (0.3 + 0.7 * size * size) * (lot < fraction)
            depth += strength * (reach / (reach + blur)) * np.exp(-squared / (reach + blur))
        total[part] = depth
    return total


def furrows(places: np.ndarray, cells: Cells, width: float, texel: float, grain: Grain | None = None) -> np.ndarray:
    """The net of furrows (M,) 0 to 1 between the cells, `width` mm wide, as their mean over a texel."""
    total = np.empty(len(places), dtype=np.float32)
    sharp = 0.0
    blurred = np.float32(np.hypot(width, 1.2 * texel))
    for part in _batches(len(places)):
        own = None if grain is None else Grain(grain.along[part], grain.stretch[part])
        first = np.full(part.stop - part.start, np.inf, dtype=np.float32)
        second = first.copy()
        for squared, _ in cells.neighbours(places[part], own):
            np.minimum(second, np.maximum(first, squared), out=second)
            np.minimum(first, squared, out=first)
        # Across an edge the two distances differ by about twice the way to it.
        edge = np.sqrt(second) - np.sqrt(first)
        total[part] = np.exp(-((edge / blurred) ** 2))
        sharp += float(np.exp(-((edge / np.float32(width)) ** 2)).sum(dtype=np.float64))
    # Wider furrows meet: their share of the skin stays that of the narrow ones.
    return total * np.float32(sharp / max(float(total.sum(dtype=np.float64)), 1e-9))

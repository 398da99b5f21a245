"""Whether two noisy pictures have the same expectation: z-tests, and what they can see.

Each statistic has its use. The pooled one sees a bias of the whole picture far below the
noise of any pixel; the regional one a bias of one place; the one per pixel only gross
defects of single pixels, since it must hold out against the noise of each: its power is
stated so that nobody takes its silence for agreement. All are of luminance. Light's
channels share their paths, so their noise is taken as fully correlated: that bounds the
variance from above whatever the correlation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import stats

from ..layers import Layers
from ..lights import LUMINANCE

FALSE_ALARM = 1e-3
"""Chance that one statistic of two pictures of equal expectation rejects, regions and pixels
together (Sidak)."""

BLOCK = 8
"""Edge of a region in pixels."""

_MIN_SEEN = 24
"""Pixels that a block must show of the object to count as a region."""


@dataclass(frozen=True)
class Estimate:
    """Luminance [H, W], variance of its mean [H, W], and the number of passes behind the variance."""

    mean: np.ndarray
    variance: np.ndarray
    passes: int

    @classmethod
    def of_layers(cls, layers: Layers, passes: int) -> Estimate:
        """A picture with the variance that it states itself."""
        deviation = np.sqrt(layers.variance.astype(float)) @ LUMINANCE
        return cls(layers.total.astype(float) @ LUMINANCE, deviation**2, passes)

    @classmethod
    def of_runs(cls, pictures: list[np.ndarray]) -> Estimate:
        """The mean of independent pictures [H, W, 3], with the variance that they show."""
        runs = np.stack(pictures).astype(float) @ LUMINANCE
        return cls(runs.mean(0), runs.var(0, ddof=1) / len(runs), len(runs))


@dataclass(frozen=True)
class Comparison:
    """Two estimates, compared where ``seen`` [H, W]."""

    ours: Estimate
    theirs: Estimate
    seen: np.ndarray

    @property
    def pooled(self) -> float:
        """z of the whole picture."""
        return float(self._difference[self.seen].sum() / np.sqrt(self._variance[self.seen].sum()))

    @property
    def regional(self) -> np.ndarray:
        """z of every region."""
        return self._sums(self._difference) / np.sqrt(self._sums(self._variance))

    @property
    def per_pixel(self) -> np.ndarray:
        """p-values of the pixels seen: Welch's t-test, since few passes estimate each variance."""
        a, b = self.ours.variance[self.seen], self.theirs.variance[self.seen]
        variance = np.maximum(a + b, 1e-30)
        freedom = variance**2 / (a**2 / (self.ours.passes - 1) + b**2 / (self.theirs.passes - 1) + 1e-60)
        t = self._difference[self.seen] / np.sqrt(variance)
        return 2 * stats.t.sf(np.abs(t), np.maximum(freedom, 1))

    def rejections(self) -> list[str]:
        """One sentence for each statistic that rejects: its value, and the bias in per cent."""
        found = []
        if abs(self.pooled) > _threshold(1):
            found.append(f"pooled z = {self.pooled:+.1f}, a bias of {100 * self.bias:+.2f} %")
        z = self.regional
        if np.abs(z).max() > _threshold(len(z)):
            worst = int(np.abs(z).argmax())
            bias = self._sums(self._difference)[worst] / self._sums(self.theirs.mean)[worst]
            found.append(f"regional z = {z[worst]:+.1f} in region {worst} of {len(z)}, a bias of {100 * bias:+.1f} %")
        p = self.per_pixel
        if p.min() < _sidak(len(p)):
            row, column = np.argwhere(self.seen)[int(p.argmin())]
            found.append(f"p = {p.min():.0e} of the pixel in row {row}, column {column}")
        return found

    @property
    def bias(self) -> float:
        """Relative difference of the pictures' means."""
        return float(self._difference[self.seen].sum() / self.theirs.mean[self.seen].sum())

    def pooled_power(self, bias: float) -> float:
        """Chance that the pooled statistic finds a relative bias of the whole picture."""
        shift = bias * self.theirs.mean[self.seen].sum() / np.sqrt(self._variance[self.seen].sum())
        return _power(shift, _threshold(1))

    def regional_power(self, bias: float) -> float:
        """Chance that a relative bias of one region is found, for the noisiest region."""
        shift = bias * self._sums(self.theirs.mean) / np.sqrt(self._sums(self._variance))
        return float(_power(shift, _threshold(len(shift))).min())

    def pixel_bias(self) -> float:
        """Relative bias of a single pixel that is found every other time, in the median."""
        noise = np.sqrt(self._variance[self.seen]) / self.theirs.mean[self.seen].clip(1e-9)
        freedom = self.ours.passes + self.theirs.passes - 2
        return float(np.median(noise) * stats.t.isf(_sidak(int(self.seen.sum())) / 2, freedom))

    @property
    def _difference(self) -> np.ndarray:
        return self.ours.mean - self.theirs.mean

    @property
    def _variance(self) -> np.ndarray:
        return self.ours.variance + self.theirs.variance

    def _sums(self, values: np.ndarray) -> np.ndarray:
        """Sums over the pixels seen of each region, row by row."""
        height, width = (n // BLOCK for n in self.seen.shape)
        cut = np.s_[: height * BLOCK, : width * BLOCK]
        seen = self.seen[cut].reshape(height, BLOCK, width, BLOCK)
        blocks = np.where(seen, values[cut].reshape(height, BLOCK, width, BLOCK), 0).sum((1, 3))
        return blocks[seen.sum((1, 3)) >= _MIN_SEEN]


def _sidak(count: int) -> float:
    return -np.expm1(np.log1p(-FALSE_ALARM) / count)


def _threshold(count: int) -> float:
    """|z| beyond which one of ``count`` tests rejects."""
    return float(stats.norm.isf(_sidak(count) / 2))


def _power(shift, threshold: float):
    return stats.norm.sf(threshold - shift) + stats.norm.cdf(-threshold - shift)

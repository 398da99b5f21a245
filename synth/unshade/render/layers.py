"""A rendered picture: its two layers, and how noisy it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Layers:
    """One rendered picture: arrays [height, width, 3], linear Rec.709 radiance, float32."""

    diffuse: np.ndarray
    specular: np.ndarray
    variance: np.ndarray
    """Variance of the mean of the total."""
    half: np.ndarray | None = None
    """The total of one half of the samples, independent of the other, float16: its rounding is far below its noise.
    None where they were not so split."""

    @property
    def total(self) -> np.ndarray:
        """The picture: the exact sum of its layers."""
        return self.diffuse + self.specular

    def channels(self) -> dict[str, np.ndarray]:
        """The EXR channels that describe how the picture came about."""
        halves = {} if self.half is None else {"half": self.half.astype(np.float32)}
        return {"diffuse": self.diffuse, "specular": self.specular, "variance": self.variance, **halves}

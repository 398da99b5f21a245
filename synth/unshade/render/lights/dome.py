"""Even light from all directions."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..split import LambertLight
from .conventions import LATLONG, rgb


@dataclass(frozen=True)
class Dome:
    """Even radiance (grey) from all directions, as the full sphere of a light stage."""

    radiance: float = 1.0
    lambert_light = LambertLight.FROM_SURFACE

    def scaled(self, factor: float) -> Dome:
        return Dome(self.radiance * factor)

    def turned(self, rotation: np.ndarray) -> Dome:
        return self

    def irradiance(self, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
        return np.full((len(points), 3), math.pi * self.radiance)

    def brightest(self) -> np.ndarray:
        return np.full(3, self.radiance)

    def emitters(self) -> dict[str, Any]:
        return {"dome": {"type": "constant", "radiance": rgb(self.radiance)}}

    def latlong(self) -> np.ndarray:
        return np.full((*LATLONG, 3), self.radiance, np.float32)

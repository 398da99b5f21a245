"""A light as small as a bare LED.

A ball and not Mitsuba's point: a point has no solid angle, so it has no radiance that a
lat-long picture or a highlight could show, and no scattered path ever meets it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...scene_file.light import PointLight
from ..split import LambertLight
from .conventions import LATLONG, around, deposit, rgb


@dataclass(frozen=True)
class Ball:
    """A small ball that shines evenly: centre [3] and radius (m), radiance."""

    centre: np.ndarray
    radius: float
    radiance: float
    lambert_light = LambertLight.TOWARDS_LIGHT

    def scaled(self, factor: float) -> Ball:
        return replace(self, radiance=self.radiance * factor)

    def turned(self, rotation: np.ndarray) -> Ball:
        return replace(self, centre=rotation @ self.centre)

    def irradiance(self, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
        """Exact wherever the whole ball stands above the surface's horizon."""
        to_light = self.centre - points
        distance2 = np.einsum("ij,ij->i", to_light, to_light)
        cosine = (np.einsum("ij,ij->i", to_light, normals) / np.sqrt(distance2)).clip(0)
        return np.repeat((self.radiance * math.pi * self.radius**2 / distance2 * cosine)[:, None], 3, 1)

    def brightest(self) -> np.ndarray:
        return np.full(3, self.radiance)

    def emitters(self) -> dict[str, Any]:
        return {
            "ball": {
                "type": "sphere",
                "center": self.centre.tolist(),
                "radius": self.radius,
                "emitter": {"type": "area", "radiance": rgb(self.radiance)},
                "bsdf": {"type": "diffuse", "reflectance": rgb(0.0)},
            }
        }

    def latlong(self) -> np.ndarray:
        picture = np.zeros((*LATLONG, 3))
        sine2 = self.radius**2 / float(self.centre @ self.centre)
        solid = 2 * math.pi * sine2 / (1 + math.sqrt(1 - sine2))
        deposit(picture, self.centre, np.full(3, self.radiance * solid))
        return picture.astype(np.float32)


def point(settings: PointLight) -> Ball:
    place = around(settings.azimuth_degrees, settings.elevation_degrees, settings.distance_metres)
    return Ball(place, settings.radius_metres, 1.0)

"""A clear day: Mitsuba's ``sunsky`` turned to our axes, with a ground below.

The plugin's own axes are z up, and it is black below the horizon. So its sky (Hosek and
Wilkie 2012, "An Analytic Model for Full Spectral Sky-Dome Radiance", with their sun) is
read off it into a lat-long picture, whose lower half is the ground's even radiance; the
sun becomes a disc of the plugin's mean radiance, as sharp as the real one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

from ...scene_file.light import Sun
from ...vectors import frame
from ..split import LambertLight
from .conventions import LATLONG, LUMINANCE, around, deposit, directions, rgb
from .envmap import Environment

APERTURE_DEGREES = 0.5358
"""The sun's angular diameter, the plugin's default."""

_DISTANCE = 1000.0
"""Metres to the disc: over a head its direction then varies by less than 0.01 degrees."""

_RINGS = 16
"""Rings of equal solid angle over which the disc's radiance is averaged."""


@dataclass(frozen=True)
class SunSky:
    """Sky and ground at infinity, and the sun: unit direction to it [3] and RGB radiance [3]."""

    sky: Environment
    direction: np.ndarray
    sun: np.ndarray
    lambert_light = LambertLight.BLEND

    def scaled(self, factor: float) -> SunSky:
        return replace(self, sky=self.sky.scaled(factor), sun=self.sun * factor)

    def turned(self, rotation: np.ndarray) -> SunSky:
        return replace(self, sky=self.sky.turned(rotation), direction=rotation @ self.direction)

    def irradiance(self, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
        cosine = (normals @ self.direction).clip(0)
        return self.sky.irradiance(points, normals) + cosine[:, None] * self.sun * _projected()

    def brightest(self) -> np.ndarray:
        return max(self.sun, self.sky.brightest(), key=lambda radiance: float(radiance @ LUMINANCE))

    def emitters(self) -> dict[str, Any]:
        scale = _DISTANCE * math.tan(math.radians(APERTURE_DEGREES / 2))
        place = (self.direction * _DISTANCE).tolist()
        up = [0.0, 1.0, 0.0] if abs(self.direction[1]) < 0.9 else [1.0, 0.0, 0.0]
        to_world = mi.ScalarTransform4f().look_at(origin=place, target=[0.0, 0.0, 0.0], up=up).scale(scale)
        return self.sky.emitters() | {
            "sun": {
                "type": "disk",
                "to_world": to_world,
                "emitter": {"type": "area", "radiance": rgb(self.sun)},
                "bsdf": {"type": "diffuse", "reflectance": rgb(0.0)},
            }
        }

    def latlong(self) -> np.ndarray:
        picture = self.sky.latlong().astype(float)
        deposit(picture, self.direction, self.sun * _projected())
        return picture.astype(np.float32)


def sun_sky(settings: Sun) -> SunSky:
    direction = around(settings.azimuth_degrees, settings.elevation_degrees, 1.0)
    towards, _ = directions(*LATLONG, 1)
    upper = towards[..., 1] > 0
    picture = np.zeros((*LATLONG, 3))
    picture[upper] = _plugin_radiance(settings, direction, towards[upper], sun=False)
    sun = _plugin_radiance(settings, direction, _disc(direction), sun=True).mean(0)
    above = Environment(picture.astype(np.float32))
    up = np.array([[0.0, 1.0, 0.0]])
    falls = above.irradiance(np.zeros((1, 3)), up)[0] + sun * _projected() * direction[1]
    picture[~upper] = settings.ground_albedo / math.pi * falls
    return SunSky(Environment(picture.astype(np.float32)), direction, sun)


def _projected() -> float:
    """Projected solid angle of the disc on a surface that faces it (sr)."""
    return math.pi * math.sin(math.radians(APERTURE_DEGREES / 2)) ** 2


def _disc(direction: np.ndarray) -> np.ndarray:
    """Directions [N, 3] spread evenly over the sun's disc."""
    side, other = frame(direction)
    count = _RINGS**2
    angle = np.radians(APERTURE_DEGREES / 2) * np.sqrt((np.arange(count) + 0.5) / count)[:, None]
    turn = (np.arange(count) * math.pi * (3 - math.sqrt(5)))[:, None]
    return np.cos(angle) * direction + np.sin(angle) * (np.cos(turn) * side + np.sin(turn) * other)


def _plugin_radiance(settings: Sun, sun_direction: np.ndarray, towards: np.ndarray, sun: bool) -> np.ndarray:
    """Radiance [N, 3] of Mitsuba's sunsky plugin in directions [N, 3] of the world, with or without its sun."""
    emitter = mi.load_dict(
        {
            "type": "sunsky",
            "turbidity": settings.turbidity,
            "albedo": settings.ground_albedo,
            "sun_direction": _z_up(sun_direction).tolist(),
            "sun_aperture": APERTURE_DEGREES,
            "sun_scale": 1.0 if sun else 0.0,
        }
    )
    if not dr.is_jit_v(mi.Float):
        return np.array([_seen(emitter, direction) for direction in -_z_up(towards)])
    si = dr.zeros(mi.SurfaceInteraction3f, len(towards))
    si.wi = mi.Vector3f(np.ascontiguousarray(-_z_up(towards).T, dtype=np.float32))
    return np.array(emitter.eval(si), dtype=np.float64).T


def _seen(emitter, wi: np.ndarray) -> np.ndarray:
    si = dr.zeros(mi.SurfaceInteraction3f)
    si.wi = mi.Vector3f(*wi.tolist())
    return np.array(emitter.eval(si), dtype=np.float64)


def _z_up(towards: np.ndarray) -> np.ndarray:
    """Directions [..., 3] turned so that our +Y is the plugin's +z."""
    return np.stack([towards[..., 0], -towards[..., 2], towards[..., 1]], -1)

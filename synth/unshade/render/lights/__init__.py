"""Lights as plain data: what Mitsuba emits, what falls on a face, what a lat-long shows.

One file per kind; every kind has ``scaled``, ``turned`` (by a rotation of the world [3, 3]), ``irradiance``
(RGB [N, 3] at points [N, 3] m with unit normals), ``brightest`` (its largest radiance, RGB), ``emitters`` and ``latlong``.
Each light starts with its own relative radiance and is scaled by `exposed`, so that the
largest unoccluded irradiance (Rec.709 luminance) over the front-facing normals of the
face is pi: a white Lambert surface there has radiance 1. Directions and lat-long pictures
follow Mitsuba, see `conventions`.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...errors import SceneError
from ...scene_file import Light
from .conventions import LATLONG, LUMINANCE
from .dome import Dome
from .envmap import Environment, environment
from .panels import Panel, Panels, flash, key, studio, two_colours
from .point import Ball, point
from .sphere import StagePattern, gradient, pattern
from .sun import SunSky, sun_sky

AnyLight = Dome | Panels | Environment | SunSky | Ball

__all__ = [
    "LATLONG", "LUMINANCE", "AnyLight", "Ball", "Dome", "Environment", "Panel", "Panels", "StagePattern", "SunSky",
    "environment", "exposed", "flash", "in_head_axes", "largest_irradiance", "studio", "unexposed",
]  # fmt: skip

_MODELS = {
    "dome": lambda light: Dome(),
    "studio": lambda light: studio(),
    "flash": lambda light: flash(),
    "envmap": environment,
    "key": lambda light: key(light.settings),
    "two-colour": lambda light: two_colours(light.settings),
    "sun": lambda light: sun_sky(light.settings),
    "point": lambda light: point(light.settings),
    "gradient": lambda light: gradient(light.settings),
    "pattern": lambda light: pattern(light.settings),
}


def unexposed(light: Light) -> AnyLight:
    """The light of a scene file with its own relative radiance."""
    return _MODELS[light.kind](light)


def exposed(light: Light, vertices: np.ndarray, normals: np.ndarray) -> AnyLight:
    """The light of a scene file, scaled for the chart's vertices [V, 3] and unit normals."""
    model = unexposed(light)
    if isinstance(model, StagePattern):
        # Part of a sphere that has radiance 1 where it is on: its irradiance is pi already.
        return in_head_axes(model.scaled(light.exposure), light)
    # A light that moves with respect to the head has one exposure: that of a head that faces the camera.
    largest = largest_irradiance(model, vertices, normals)
    if not largest > 0:
        raise SceneError(f"light {light.name!r} does not reach the face's front; turn it or choose another")
    return in_head_axes(model.scaled(light.exposure * math.pi / largest), light)


def in_head_axes(model: Any, light: Light) -> Any:
    """The model of a light, in the axes in which the light stands still, turned to those of the head."""
    return model if light.to_head is None else model.turned(np.reshape(light.to_head, (3, 3)))


def largest_irradiance(model: AnyLight, vertices: np.ndarray, normals: np.ndarray) -> float:
    """Rec.709 luminance of the largest unoccluded irradiance over the chart's front-facing normals."""
    front = normals[:, 2] > 0
    irradiance = model.irradiance(vertices[front].astype(float), normals[front].astype(float))
    return float((irradiance @ LUMINANCE).max())

"""Rectangular area lights: softboxes and flashes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import mitsuba as mi
import numpy as np

from ...scene_file.light import KeyLight, TwoColours
from ..rigs import EMILY_OFFSET
from ..split import LambertLight
from .conventions import LATLONG, LUMINANCE, around, averaged, deposit, directions, grey, rgb


@dataclass(frozen=True)
class Panel:
    """A rectangle that shines evenly to its front: centre, half edges and radiance.

    ``right`` x ``up`` points the way the light goes. The radiance is one number (white) or
    linear RGB [3].
    """

    centre: np.ndarray
    right: np.ndarray
    up: np.ndarray
    radiance: float | np.ndarray

    @classmethod
    def facing_head(cls, centre, width: float, height: float, radiance: float | np.ndarray) -> Panel:
        """A panel of ``width`` x ``height`` metres that faces the origin."""
        centre = np.asarray(centre, float)
        forward = -centre / np.linalg.norm(centre)
        right = np.cross([0.0, 1.0, 0.0], forward)
        right /= np.linalg.norm(right)
        return cls(centre, right * width / 2, np.cross(forward, right) * height / 2, radiance)

    def turned(self, rotation: np.ndarray) -> Panel:
        return replace(self, **{name: rotation @ getattr(self, name) for name in ("centre", "right", "up")})

    @property
    def forward(self) -> np.ndarray:
        normal = np.cross(self.right, self.up)
        return normal / np.linalg.norm(normal)


_CELLS = 12
"""Cells along each edge of a panel when its irradiance is summed."""

_FINE = 4
"""Points along each edge of a texel of the lat-long picture."""

_MIN_POINTS = 64
"""A panel that meets fewer points of the lat-long picture is entered as one direction."""


@dataclass(frozen=True)
class Panels:
    """Area lights at a finite distance."""

    panels: tuple[Panel, ...]
    lambert_light = LambertLight.TOWARDS_LIGHT

    def scaled(self, factor: float) -> Panels:
        return Panels(tuple(replace(p, radiance=p.radiance * factor) for p in self.panels))

    def turned(self, rotation: np.ndarray) -> Panels:
        return Panels(tuple(panel.turned(rotation) for panel in self.panels))

    def irradiance(self, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
        channels = 1 if all(grey(panel.radiance) for panel in self.panels) else 3
        total = np.zeros((len(points), channels))
        steps = (np.arange(_CELLS) + 0.5) / _CELLS * 2 - 1
        for panel in self.panels:
            cell = 4 * np.linalg.norm(np.cross(panel.right, panel.up)) / _CELLS**2
            strength = np.broadcast_to(panel.radiance, (channels,)) * cell
            for a in steps:
                for b in steps:
                    to_light = panel.centre + a * panel.right + b * panel.up - points
                    distance2 = np.einsum("ij,ij->i", to_light, to_light)
                    here = np.einsum("ij,ij->i", to_light, normals).clip(0)
                    there = (-to_light @ panel.forward).clip(0)
                    total += strength * here[:, None] * there[:, None] / (distance2**2)[:, None]
        return np.repeat(total, 3 // channels, 1)

    def brightest(self) -> np.ndarray:
        radiances = [np.broadcast_to(panel.radiance, (3,)) for panel in self.panels]
        return max(radiances, key=lambda radiance: float(radiance @ LUMINANCE))

    def emitters(self) -> dict[str, Any]:
        return {f"panel{i}": _rectangle(panel) for i, panel in enumerate(self.panels)}

    def latlong(self) -> np.ndarray:
        towards, row = directions(*LATLONG, _FINE)
        picture = np.zeros((*LATLONG, 3))
        whites = np.zeros(towards.shape[:-1])
        for panel in self.panels:
            inside = _met(panel, towards)
            if inside.sum() < _MIN_POINTS:
                deposit(picture, panel.centre, np.broadcast_to(panel.radiance, (3,)) * _solid_angle(panel))
            elif grey(panel.radiance):
                whites += panel.radiance * inside
            else:
                picture += averaged(inside.astype(float), row, _FINE)[..., None] * panel.radiance
        return (averaged(whites, row, _FINE)[..., None] + picture).astype(np.float32)


def studio() -> Panels:
    """Key, fill and two rim softboxes around the head (metres; the face looks along +Z).

    Four, because the strata of a pixel's samples then fall on the panels evenly: with
    three, the odd sample doubles the noise.
    """
    return Panels(
        (
            Panel.facing_head(around(40, 30, 1.5), 0.7, 0.7, 1.0),
            Panel.facing_head(around(-55, 5, 1.6), 1.0, 1.2, 0.2),
            Panel.facing_head(around(-140, 30, 1.4), 0.4, 1.0, 0.8),
            Panel.facing_head(around(150, 35, 1.4), 0.4, 1.0, 0.6),
        )
    )


def flash() -> Panels:
    """The flash of Digital Emily 2: place and 1.75 : 1 shape from its public scene."""
    place = EMILY_OFFSET + [0.127, 0.428, 1.259]
    return Panels((Panel.facing_head(place, 0.14, 0.08, 1.0),))


def key(settings: KeyLight) -> Panels:
    place = around(settings.azimuth_degrees, settings.elevation_degrees, settings.distance_metres)
    return Panels((Panel.facing_head(place, settings.size_metres, settings.size_metres, 1.0),))


def two_colours(settings: TwoColours) -> Panels:
    """The softbox at the left hand (+X), then its mirror image at the right."""
    size = settings.size_metres
    sides = ((settings.azimuth_degrees, settings.left), (-settings.azimuth_degrees, settings.right))
    return Panels(
        tuple(
            Panel.facing_head(
                around(azimuth, settings.elevation_degrees, settings.distance_metres), size, size, np.array(colour)
            )
            for azimuth, colour in sides
        )
    )


def _met(panel: Panel, towards: np.ndarray) -> np.ndarray:
    """Which unit directions [..., 3] from the head's centre meet the panel's front."""
    facing = towards @ panel.forward
    distance = panel.centre @ panel.forward / np.where(facing < 0, facing, -1)
    offset = towards * distance[..., None] - panel.centre
    inside = (facing < 0) & (distance > 0)
    for edge in (panel.right, panel.up):
        inside &= np.abs(offset @ edge) <= edge @ edge
    return inside


def _solid_angle(panel: Panel) -> float:
    """Solid angle (sr) of a small panel that faces the head's centre, seen from there."""
    return 4 * np.linalg.norm(np.cross(panel.right, panel.up)) / float(panel.centre @ panel.centre)


def _rectangle(panel: Panel) -> dict[str, Any]:
    columns = np.eye(4)
    columns[:3] = np.stack([panel.right, panel.up, panel.forward, panel.centre], 1)
    return {
        "type": "rectangle",
        "to_world": mi.ScalarTransform4f(columns),
        "emitter": {"type": "area", "radiance": rgb(panel.radiance)},
        # A softbox does not reflect light of the head.
        "bsdf": {"type": "diffuse", "reflectance": rgb(0.0)},
    }

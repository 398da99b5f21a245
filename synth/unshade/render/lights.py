"""Lights as plain data: what Mitsuba emits, what falls on a face, what a lat-long shows.

Each light starts with its own relative radiance and is scaled by `exposed`, so that the
largest unoccluded irradiance (Rec.709 luminance) over the front-facing normals of the
face is pi: a white Lambert surface there has radiance 1. Directions and lat-long pictures
follow Mitsuba: d = (sin t sin p, cos t, -sin t cos p) with p = 2 pi u at column centres
u = (i + .5)/W, and t = pi v with rows at v = j/(H - 1), so that the first and last row
lie on the poles.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import mitsuba as mi
import numpy as np

from ..errors import SceneError
from ..scene_file import Light
from .pictures import read_rgb
from .rigs import EMILY_OFFSET
from .split import LambertLight

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
LATLONG = (256, 512)
"""Height and width of a light's lat-long picture, unless it is an environment map."""


@dataclass(frozen=True)
class Dome:
    """The same radiance from everywhere, as the full sphere of a light stage."""

    radiance: float = 1.0
    lambert_light = LambertLight.FROM_SURFACE

    def scaled(self, factor: float) -> Dome:
        return Dome(self.radiance * factor)

    def irradiance(self, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
        return np.full((len(points), 3), math.pi * self.radiance)

    def emitters(self) -> dict[str, Any]:
        return {"dome": {"type": "constant", "radiance": _rgb(self.radiance)}}

    def latlong(self) -> np.ndarray:
        return np.full((*LATLONG, 3), self.radiance, np.float32)


@dataclass(frozen=True)
class Panel:
    """A rectangle that shines evenly to its front: centre, half edges and radiance.

    ``right`` x ``up`` points the way the light goes.
    """

    centre: np.ndarray
    right: np.ndarray
    up: np.ndarray
    radiance: float

    @classmethod
    def facing_head(cls, centre, width: float, height: float, radiance: float) -> Panel:
        """A panel of ``width`` x ``height`` metres that faces the origin."""
        centre = np.asarray(centre, float)
        forward = -centre / np.linalg.norm(centre)
        right = np.cross([0.0, 1.0, 0.0], forward)
        right /= np.linalg.norm(right)
        return cls(centre, right * width / 2, np.cross(forward, right) * height / 2, radiance)

    @property
    def forward(self) -> np.ndarray:
        normal = np.cross(self.right, self.up)
        return normal / np.linalg.norm(normal)


_CELLS = 12
"""Cells along each edge of a panel when its irradiance is summed."""


@dataclass(frozen=True)
class Panels:
    """Area lights at a finite distance."""

    panels: tuple[Panel, ...]
    lambert_light = LambertLight.TOWARDS_LIGHT

    def scaled(self, factor: float) -> Panels:
        return Panels(tuple(replace(p, radiance=p.radiance * factor) for p in self.panels))

    def irradiance(self, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
        total = np.zeros(len(points))
        steps = (np.arange(_CELLS) + 0.5) / _CELLS * 2 - 1
        for panel in self.panels:
            cell = 4 * np.linalg.norm(np.cross(panel.right, panel.up)) / _CELLS**2
            for a in steps:
                for b in steps:
                    to_light = panel.centre + a * panel.right + b * panel.up - points
                    distance2 = np.einsum("ij,ij->i", to_light, to_light)
                    here = np.einsum("ij,ij->i", to_light, normals).clip(0)
                    there = (-to_light @ panel.forward).clip(0)
                    total += panel.radiance * cell * here * there / distance2**2
        return np.repeat(total[:, None], 3, 1)

    def emitters(self) -> dict[str, Any]:
        return {f"panel{i}": _rectangle(panel) for i, panel in enumerate(self.panels)}

    def latlong(self) -> np.ndarray:
        fine = 4
        directions, row = _directions(*LATLONG, fine)
        picture = np.zeros(directions.shape[:-1])
        for panel in self.panels:
            facing = directions @ panel.forward
            distance = panel.centre @ panel.forward / np.where(facing < 0, facing, -1)
            offset = directions * distance[..., None] - panel.centre
            inside = (facing < 0) & (distance > 0)
            for edge in (panel.right, panel.up):
                inside &= np.abs(offset @ edge) <= edge @ edge
            picture += panel.radiance * inside
        height, width = LATLONG
        columns = picture.reshape(len(row), width, fine).mean(2)
        sums = np.zeros((height, width))
        np.add.at(sums, row, columns)
        picture = sums / np.bincount(row, minlength=height)[:, None]
        return np.repeat(picture[..., None], 3, 2).astype(np.float32)


@dataclass(frozen=True)
class Environment:
    """A lat-long picture [H, W, 3] float32 at infinity."""

    picture: np.ndarray
    lambert_light = LambertLight.BLEND

    def scaled(self, factor: float) -> Environment:
        return Environment((self.picture * factor).astype(np.float32))

    def irradiance(self, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
        directions, energy = self._blocks()
        total = np.zeros((len(normals), 3))
        for start in range(0, len(normals), 4096):
            part = slice(start, start + 4096)
            total[part] = (normals[part] @ directions.T).clip(0) @ energy
        return total

    def _blocks(self) -> tuple[np.ndarray, np.ndarray]:
        """Mean directions and energies (radiance x solid angle, RGB) of blocks of texels.

        A block is at most 3 degrees wide: over it the cosine is as good as linear.
        """
        height, width = self.picture.shape[:2]
        direction, _ = _directions(height, width, 1)
        edges = np.pi * (np.arange(height + 1) - 0.5).clip(0, height - 1) / (height - 1)
        solid = (2 * np.pi / width) * (np.cos(edges[:-1]) - np.cos(edges[1:]))
        energy = self.picture.astype(np.float64) * solid[:, None, None]
        weight = energy @ LUMINANCE + 1e-12 * solid[:, None]
        for axis, most in ((0, 64), (1, 128)):
            starts = np.unique(np.arange(most) * energy.shape[axis] // most)
            moment = np.add.reduceat(direction * weight[..., None], starts, axis)
            energy, weight = (np.add.reduceat(a, starts, axis) for a in (energy, weight))
            direction = moment / weight[..., None]
        direction = direction / np.linalg.norm(direction, axis=-1, keepdims=True)
        return direction.reshape(-1, 3), energy.reshape(-1, 3)

    def emitters(self) -> dict[str, Any]:
        return {"environment": {"type": "envmap", "bitmap": mi.Bitmap(self.picture)}}

    def latlong(self) -> np.ndarray:
        return self.picture


AnyLight = Dome | Panels | Environment


def studio() -> Panels:
    """Key, fill and two rim softboxes around the head (metres; the face looks along +Z).

    Four, because the strata of a pixel's samples then fall on the panels evenly: with
    three, the odd sample doubles the noise.
    """
    return Panels(
        (
            Panel.facing_head(_around(40, 30, 1.5), 0.7, 0.7, 1.0),
            Panel.facing_head(_around(-55, 5, 1.6), 1.0, 1.2, 0.2),
            Panel.facing_head(_around(-140, 30, 1.4), 0.4, 1.0, 0.8),
            Panel.facing_head(_around(150, 35, 1.4), 0.4, 1.0, 0.6),
        )
    )


def flash() -> Panels:
    """The flash of Digital Emily 2: place and 1.75 : 1 shape from its public scene."""
    place = EMILY_OFFSET + [0.127, 0.428, 1.259]
    return Panels((Panel.facing_head(place, 0.14, 0.08, 1.0),))


def environment(light: Light) -> Environment:
    """A light's lat-long file: negatives to 0, clamped, turned about +Y."""
    picture = read_rgb(light.path)
    height, width = picture.shape[:2]
    if height < 3 or width < 3:
        raise SceneError(f"{light.path}: an environment map of {width} x {height} is too small; use 3 x 3 or more")
    picture = picture.clip(0, light.clamp)
    if not picture.any():
        raise SceneError(f"{light.path}: the environment map is black; use one with light in it")
    # Turning +Z towards +X lowers the azimuth, so a texel is read from further right.
    shift = light.rotation_degrees / 360 * width
    whole = math.floor(shift)
    near = np.roll(picture, -whole, 1)
    turned = near + (np.roll(near, -1, 1) - near) * (shift - whole)
    return Environment(turned.astype(np.float32))


def exposed(light: Light, vertices: np.ndarray, normals: np.ndarray) -> AnyLight:
    """The light of a scene file, scaled for the chart's vertices [V, 3] and unit normals."""
    models = {"dome": Dome, "studio": studio, "flash": flash}
    model = models[light.kind]() if light.kind in models else environment(light)
    front = normals[:, 2] > 0
    irradiance = model.irradiance(vertices[front].astype(float), normals[front].astype(float))
    largest = float((irradiance @ LUMINANCE).max())
    if not largest > 0:
        raise SceneError(f"light {light.name!r} does not reach the face's front; turn it or choose another")
    return model.scaled(light.exposure * math.pi / largest)


def _around(azimuth_degrees: float, elevation_degrees: float, distance: float) -> np.ndarray:
    """A place seen from the head: azimuth 0 in front of the face, positive towards +X."""
    azimuth, elevation = np.radians([azimuth_degrees, elevation_degrees])
    level = math.cos(elevation)
    return distance * np.array(
        [level * math.sin(azimuth), math.sin(elevation), level * math.cos(azimuth)]
    )


def _directions(height: int, width: int, fine: int) -> tuple[np.ndarray, np.ndarray]:
    """Unit directions [rows, width * fine, 3] of ``fine`` x ``fine`` points per texel, and
    the texel row of each; texels on the poles are half as high."""
    v = (np.arange((height - 1) * fine) + 0.5) / fine if fine > 1 else np.arange(height)
    row = np.floor(v + 0.5).astype(int)
    theta = np.pi * v / (height - 1)
    phi = 2 * np.pi * (np.arange(width * fine) + 0.5) / (width * fine)
    t, p = np.meshgrid(theta, phi, indexing="ij")
    return np.stack([np.sin(t) * np.sin(p), np.cos(t), -np.sin(t) * np.cos(p)], -1), row


def _rectangle(panel: Panel) -> dict[str, Any]:
    columns = np.eye(4)
    columns[:3] = np.stack([panel.right, panel.up, panel.forward, panel.centre], 1)
    return {
        "type": "rectangle",
        "to_world": mi.ScalarTransform4f(columns),
        "emitter": {"type": "area", "radiance": _rgb(panel.radiance)},
        # A softbox takes no part in the interreflection of the head.
        "bsdf": {"type": "diffuse", "reflectance": _rgb(0.0)},
    }


def _rgb(value: float) -> dict[str, Any]:
    return {"type": "rgb", "value": [value] * 3}

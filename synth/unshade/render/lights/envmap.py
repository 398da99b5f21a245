"""Light from infinitely far, as a lat-long picture."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import mitsuba as mi
import numpy as np

from ...errors import SceneError
from ...files.pictures import read_light
from ...scene_file import Light
from ...vectors import unit
from ..split import LambertLight
from .conventions import LUMINANCE, bilinear, directions, solid_angles


@dataclass(frozen=True)
class Environment:
    """A lat-long picture [H, W, 3] float32 at infinity; ``rotation`` [3, 3] takes its axes to the head's."""

    picture: np.ndarray
    rotation: np.ndarray | None = None
    lambert_light = LambertLight.BLEND

    def scaled(self, factor: float) -> Environment:
        return replace(self, picture=(self.picture * factor).astype(np.float32))

    def turned(self, rotation: np.ndarray) -> Environment:
        return replace(self, rotation=rotation if self.rotation is None else rotation @ self.rotation)

    def irradiance(self, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
        if self.rotation is not None:
            normals = normals @ self.rotation
        towards, energy = self._blocks()
        total = np.zeros((len(normals), 3))
        for start in range(0, len(normals), 4096):
            part = slice(start, start + 4096)
            cosine = normals[part] @ towards.T
            total[part] = cosine.clip(0, out=cosine) @ energy
        return total

    def _blocks(self) -> tuple[np.ndarray, np.ndarray]:
        """Mean directions and energies (radiance x solid angle, RGB) of blocks of texels.

        A block is at most 3 degrees wide: over it the cosine is as good as linear.
        """
        height, width = self.picture.shape[:2]
        direction, _ = directions(height, width, 1)
        solid = solid_angles(height, width)
        energy = self.picture.astype(np.float64) * solid[:, None, None]
        weight = energy @ LUMINANCE + 1e-12 * solid[:, None]
        for axis, blocks in ((0, 64), (1, 128)):
            starts = np.unique(np.arange(blocks) * energy.shape[axis] // blocks)
            moment = np.add.reduceat(direction * weight[..., None], starts, axis)
            energy, weight = (np.add.reduceat(a, starts, axis) for a in (energy, weight))
            direction = moment / weight[..., None]
        return unit(direction).reshape(-1, 3), energy.reshape(-1, 3)

    def brightest(self) -> np.ndarray:
        texels = self.picture.reshape(-1, 3).astype(float)
        return texels[(texels @ LUMINANCE).argmax()]

    def emitters(self) -> dict[str, Any]:
        emitter: dict[str, Any] = {"type": "envmap", "bitmap": mi.Bitmap(self.picture)}
        if self.rotation is not None:
            to_world = np.eye(4)
            to_world[:3, :3] = self.rotation
            emitter["to_world"] = mi.ScalarTransform4f(to_world)
        return {"environment": emitter}

    def latlong(self) -> np.ndarray:
        if self.rotation is None:
            return self.picture
        return bilinear(self.picture, directions(*self.picture.shape[:2], 1)[0] @ self.rotation)


def environment(light: Light) -> Environment:
    """A light's lat-long file: negatives to 0, clamped, turned about +Y."""
    picture = read_light(light.path)
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
    rotated = near + (np.roll(near, -1, 1) - near) * (shift - whole)
    return Environment(rotated.astype(np.float32))

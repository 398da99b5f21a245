"""The light that a solver found: cells on a sphere around the head, or infinitely far."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import mitsuba as mi
import numpy as np

from ...errors import MapsError
from ..pictures import read_light
from ..split import LambertLight
from .conventions import LATLONG, averaged, directions
from .envmap import Environment

_FINE = 4


@dataclass(frozen=True)
class CellSphere:
    """Cells of equal polar and azimuthal angle [rows, 2 rows, 3] on a sphere of ``radius`` (m) around the origin,
    each of one radiance, lat-long in Mitsuba's convention."""

    cells: np.ndarray
    radius: float
    lambert_light = LambertLight.BLEND

    def emitters(self) -> dict[str, Any]:
        # The sphere's own azimuth turns about +Y from -Z towards -X: against that of a lat-long.
        axes = np.eye(4)
        axes[:3, :3] = self.radius * np.stack([[0, 0, -1], [-1, 0, 0], [0, 1, 0]], 1)
        texture = {
            "type": "bitmap",
            "bitmap": mi.Bitmap(np.ascontiguousarray(self.cells[:, ::-1], np.float32)),
            "raw": True,
            "filter_type": "nearest",
            "wrap_mode": "repeat",
        }
        return {
            "cells": {
                "type": "sphere",
                "to_world": mi.ScalarTransform4f(axes),
                "flip_normals": True,
                "emitter": {"type": "area", "radiance": texture},
                "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.0}},
            }
        }


def found_light(maps: Path) -> CellSphere | Environment | None:
    """The light of a maps folder, in the exposure in which its albedo gives the photographs; None without one.

    Raises `MapsError` or `PictureError`.
    """
    path = maps / "light.exr"
    if not path.is_file():
        return None
    cells = read_light(path).clip(0)
    record = _record(maps / "solve.json")
    scale, distance = record.get("diffuse_scale", 1.0), record.get("light_distance")
    for name, value in (("diffuse_scale", scale), ("light_distance", distance)):
        if value is not None and not (isinstance(value, (int, float)) and 0 < value < math.inf):
            raise MapsError(f"{maps / 'solve.json'}: {name} is {value!r}; it must be a positive number: solve again")
    # What the albedo was multiplied with, the light is divided by.
    cells = (cells / scale).astype(np.float32)
    if distance is None:
        return Environment(_latlong(cells))
    return CellSphere(cells, float(distance))


def _record(path: Path) -> dict[str, Any]:
    try:
        record = json.loads(path.read_bytes()) if path.is_file() else {}
    except (OSError, ValueError) as error:
        raise MapsError(f"{path}: cannot be read: {error}; solve again") from error
    return record if isinstance(record, dict) else {}


def _latlong(cells: np.ndarray) -> np.ndarray:
    """Texels of Mitsuba's lat-long [H, W, 3] that show cells."""
    towards, row = directions(*LATLONG, _FINE)
    polar = np.arccos(towards[..., 1].clip(-1, 1)) / np.pi
    azimuth = np.arctan2(towards[..., 0], -towards[..., 2]) / (2 * np.pi) % 1
    rows, columns = cells.shape[:2]
    fine = cells[(polar * rows).astype(int).clip(0, rows - 1), (azimuth * columns).astype(int).clip(0, columns - 1)]
    return np.stack([averaged(fine[..., channel], row, _FINE) for channel in range(3)], -1).astype(np.float32)

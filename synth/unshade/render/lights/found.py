"""The light that a solver found: cells on a sphere around the head, or infinitely far."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import mitsuba as mi
import numpy as np

from ...errors import MapsError
from ...files.pictures import read_light
from ..split import LambertLight
from .conventions import LATLONG, averaged, directions
from .envmap import Environment

_FINE = 4

_FACETS = 96
"""Facets around the sphere and from pole to pole, at least: flat ones, within a thousandth of its radius."""


@dataclass(frozen=True)
class CellSphere:
    """Cells of equal polar and azimuthal angle [rows, 2 rows, 3] on a sphere of ``radius`` (m) around the origin,
    each of one radiance, lat-long in Mitsuba's convention; ``rotation`` [3, 3] takes their axes to the head's."""

    cells: np.ndarray
    radius: float
    rotation: np.ndarray | None = None
    lambert_light = LambertLight.BLEND

    def turned(self, rotation: np.ndarray) -> CellSphere:
        return replace(self, rotation=rotation if self.rotation is None else rotation @ self.rotation)

    def emitters(self) -> dict[str, Any]:
        """A mesh: the radiance of Mitsuba's own sphere, where it varies, is lost on one side of nearby points."""
        texture = {
            "type": "bitmap",
            "bitmap": mi.Bitmap(np.ascontiguousarray(self.cells, np.float32)),
            "raw": True,
            "filter_type": "nearest",
            "wrap_mode": "clamp",
        }
        properties = mi.Properties()
        properties["emitter"] = mi.load_dict({"type": "area", "radiance": texture})
        properties["bsdf"] = mi.load_dict({"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.0}})
        points, uv, triangles = self._tessellated()
        mesh = mi.Mesh("cells", len(points), len(triangles), props=properties, has_vertex_texcoords=True)
        parameters = mi.traverse(mesh)
        parameters["vertex_positions"] = points.astype(np.float32).ravel()
        parameters["vertex_texcoords"] = uv.astype(np.float32).ravel()
        parameters["faces"] = triangles.astype(np.uint32).ravel()
        parameters.update()
        return {"cells": mesh}

    def _tessellated(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Points, texture coordinates and triangles that face inwards; every cell has whole ones."""
        rows, columns = (count * max(1, -(-_FACETS // count)) for count in self.cells.shape[:2])
        v, u = np.meshgrid(np.arange(rows + 1) / rows, np.arange(columns + 1) / columns, indexing="ij")
        t, p = math.pi * v, 2 * math.pi * u
        points = self.radius * np.stack([np.sin(t) * np.sin(p), np.cos(t), -np.sin(t) * np.cos(p)], -1)
        if self.rotation is not None:
            points = points @ self.rotation.T
        corner = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
        a, b, c, d = corner, corner + 1, corner + columns + 1, corner + columns + 2
        # At the poles a quadrangle is one triangle.
        triangles = np.concatenate([np.stack([a, d, b], 1)[columns:], np.stack([a, c, d], 1)[:-columns]])
        return points.reshape(-1, 3), np.stack([u, v], -1).reshape(-1, 2), triangles


def light_files(maps: Path) -> dict[str, Path]:
    """The files of the lights of a maps folder by the names of the frames' lights; that of all frames has no name."""
    path = maps / "light.exr"
    return {"": path} if path.is_file() else {file.stem: file for file in sorted((maps / "light").glob("*.exr"))}


def found_lights(maps: Path) -> dict[str, CellSphere | Environment]:
    """The lights of a maps folder by `light_files`, in the exposure in which its albedo gives the photographs.

    Raises `MapsError` or `PictureError`.
    """
    return {name: _found_light(maps, path) for name, path in light_files(maps).items()}


def _found_light(maps: Path, path: Path) -> CellSphere | Environment:
    cells = read_light(path).clip(0)
    record = _record(maps / "solve.json")
    scale, distance = record.get("diffuse_scale", 1.0), record.get("light_distance")
    for name, value in (("diffuse_scale", scale), ("light_distance", distance)):
        if value is not None and not (isinstance(value, (int, float)) and 0 < value < math.inf):
            raise MapsError(f"{maps / 'solve.json'}: {name} is {value!r}; it must be a positive number: solve again")
    # The light is divided by the factor of the albedo.
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

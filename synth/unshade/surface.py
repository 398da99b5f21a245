"""The maps of a face on their mesh, with what every export needs of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from . import _native
from .errors import CaptureError, MapsError
from .face.texels import Texels, rasterise
from .importing.chart_mesh import smooth_normals
from .render.relight import read_maps
from .render.scene import ChartMaps
from .render.skin_bsdf import LOBE_ALPHAS, LOBE_WEIGHTS, MIN_ALPHA
from .vectors import unit

_RIM = 1e-4
"""How far rounding may carry UV out of the unit square."""


@dataclass(frozen=True)
class Mesh:
    """Triangles: ``vertices`` (V,3) f32 m, ``normals`` (V,3) f32 unit, ``uv`` (V,2) f32, v up, ``triangles`` (F,3) i64."""

    vertices: np.ndarray
    normals: np.ndarray
    uv: np.ndarray
    triangles: np.ndarray


@dataclass(frozen=True)
class Surface:
    """Maps on a mesh. ``maps`` may lack all but the diffuse albedo; each property spells out its default."""

    mesh: Mesh
    maps: ChartMaps

    @property
    def size(self) -> int:
        """Texels along a side of the diffuse albedo, and of all that is exported."""
        return len(self.maps.diffuse_albedo)

    @cached_property
    def texels(self) -> Texels:
        """Which triangle covers each texel."""
        # A triangle without area covers none.
        with np.errstate(divide="ignore", invalid="ignore"):
            return rasterise(self.mesh.uv.astype(np.float64), self.mesh.triangles, self.size)

    def spread(self, values: np.ndarray) -> np.ndarray:
        """Values (M,...) at the texels as a picture, each texel outside the chart like its nearest inside."""
        return self.texels.image(values)[self.texels.nearest_inside()]

    @cached_property
    def mesh_normal(self) -> np.ndarray:
        """Interpolated normals (N,N,3) of the mesh, unit."""
        return self.spread(unit(self.texels.sample(self.mesh.normals)))

    @property
    def specular_albedo(self) -> np.ndarray:
        """Reflectance at normal incidence (N,N); 0 without a map."""
        albedo = self.maps.specular_albedo
        return np.zeros((self.size, self.size), np.float32) if albedo is None else resized(albedo, self.size)

    @cached_property
    def diffuse_normal(self) -> np.ndarray:
        """Unit normals (N,N,3) in object space; the mesh's own where the map holds no direction."""
        return self._normal(self.maps.diffuse_normal)

    @cached_property
    def specular_normal(self) -> np.ndarray:
        """As `diffuse_normal`, for the highlights."""
        return self._normal(self.maps.specular_normal)

    @property
    def roughness(self) -> np.ndarray:
        """GGX alphas of both lobes and the share of the first (N,N,3), within what the renderer takes."""
        if self.maps.roughness is None:
            return np.broadcast_to(np.float32([*LOBE_ALPHAS, LOBE_WEIGHTS[0]]), (self.size, self.size, 3))
        roughness = resized(self.maps.roughness, self.size)
        return np.concatenate([roughness[..., :2].clip(MIN_ALPHA, 1), roughness[..., 2:].clip(0, 1)], -1)

    def _normal(self, normals: np.ndarray | None) -> np.ndarray:
        if normals is None:
            return self.mesh_normal
        normals = resized(normals, self.size)
        length = np.linalg.norm(normals, axis=-1, keepdims=True)
        known = length > 1e-4
        return np.where(known, normals / np.where(known, length, 1), self.mesh_normal).astype(np.float32)


def read_surface(maps: Path, capture: Path | None, mesh: Path | None, warn: Callable[[str], None]) -> Surface:
    """The maps of a folder on the mesh of their capture, or on an OBJ. Raises `MapsError`, `CaptureError`."""
    if capture is not None:
        found = _native.Capture(capture).mesh
        shape = Mesh(found["vertices"], found["normals"], found["uvs"], found["triangles"].astype(np.int64))
    elif mesh is not None:
        shape = read_shape(mesh)
    else:
        raise CaptureError(
            f"{maps}: maps have no mesh of their own; name their capture with --capture, or an OBJ with --mesh"
        )
    where = capture / "mesh.obj" if capture else mesh
    if not all(np.isfinite(values).all() for values in (shape.vertices, shape.normals, shape.uv)):
        raise CaptureError(f"{where}: holds numbers that are not finite; export the mesh again")
    if shape.uv.size and (shape.uv.min() < -_RIM or shape.uv.max() > 1 + _RIM):
        raise CaptureError(f"{where}: its UV leave the unit square; use one tile, the one that the maps were made for")
    surface = Surface(replace(shape, uv=shape.uv.clip(0, 1)), read_maps(maps, warn))
    if not surface.texels.inside.any():
        raise CaptureError(f"{where}: its UV cover no texel of the maps; use the mesh that the maps were made for")
    return surface


def read_shape(path: Path) -> Mesh:
    """Reads an OBJ with UV and one mesh. Raises `CaptureError`."""
    try:
        objects = _native.read_obj(path.read_bytes())
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise CaptureError(f"{path}: cannot be read: {reason}; name an OBJ with triangles and UV") from error
    shapes = [each for each in objects if len(each["triangles"])]
    if len(shapes) != 1:
        raise CaptureError(f"{path}: holds {len(shapes)} meshes; keep the one that the maps belong to")
    shape = shapes[0]
    if shape["uv"] is None:
        raise CaptureError(f"{path}: has corners without UV (line {shape['line_without_uv']}); export the mesh with UV")
    normals = shape["normals"]
    if normals is None:
        normals = smooth_normals(shape["vertices"], shape["triangles"])
    vertices, normals, uv = (values.astype(np.float32) for values in (shape["vertices"], unit(normals), shape["uv"]))
    return Mesh(vertices, normals, uv, shape["triangles"])


def resized(picture: np.ndarray, size: int) -> np.ndarray:
    """A map (M,M,...) at the texel centres of another size, bilinear, clamped at the border."""
    if len(picture) == size:
        return picture
    place = ((np.arange(size) + 0.5) * len(picture) / size - 0.5).clip(0, len(picture) - 1)
    low = np.floor(place).astype(int)
    high = np.minimum(low + 1, len(picture) - 1)
    fraction = (place - low).astype(np.float32)
    across = fraction.reshape(-1, *[1] * (picture.ndim - 2))
    rows = picture[low] + (picture[high] - picture[low]) * fraction.reshape(-1, *[1] * (picture.ndim - 1))
    return rows[:, low] + (rows[:, high] - rows[:, low]) * across


def require_maps(surface: Surface, maps: Path) -> None:
    """Raises `MapsError` for maps that no asset can hold."""
    if surface.size > 8192:
        raise MapsError(
            f"{maps}: maps of {surface.size} texels are larger than other programs take; export 8192 or less"
        )

"""Exact visibility: what pixel centres see, and which texels the cameras see.

Pixel-filtered pictures do not show whether a surface is in view; single rays do.
"""

from __future__ import annotations

from dataclasses import dataclass

import drjit as dr
import mitsuba as mi
import numpy as np

from ..camera.camera import Camera
from ..face import Chart
from ..face.texels import rasterise
from ..vectors import triangle_normals, unit
from .scene import HeadScene

_LIFT = 2e-5
"""Metres between a texel and the start of its ray to a camera: clear of its own triangle."""


@dataclass(frozen=True)
class CentreView:
    """The chart at the pixel centres of a camera."""

    mask: np.ndarray
    """[H, W] bool: the chart is the first surface."""
    uv: np.ndarray
    """[H, W, 2] texture coordinates, v up; 0 outside the mask."""
    position: np.ndarray
    """[H, W, 3] metres; 0 outside the mask."""


def view_through_centres(head: HeadScene, camera: Camera) -> CentreView:
    """Casts one ray through every pixel centre."""
    directions = camera.pixel_directions()
    origins = np.broadcast_to(camera.position, directions.shape)
    if dr.is_jit_v(mi.Float):
        si = head.dark.ray_intersect(_rays(origins, directions))
        seen = si.is_valid() & (si.shape == mi.ShapePtr(head.chart))
        mask, uv, position = np.array(seen), np.array(si.uv).T, np.array(si.p).T
    else:
        hits = [head.dark.ray_intersect(_rays(o, d)) for o, d in zip(origins, directions)]
        mask = np.array([si.is_valid() and si.shape == head.chart for si in hits])
        uv, position = np.array([si.uv for si in hits]), np.array([si.p for si in hits])
    uv = np.where(mask[:, None], [0, 1] + uv * [1, -1], 0)
    position = np.where(mask[:, None], position, 0)
    shape = (camera.height, camera.width)
    return CentreView(mask.reshape(shape), uv.reshape(*shape, 2), position.reshape(*shape, 3))


def nearest_texels(picture: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """Values of a map [N, N, ...] (row 0 at v = 1) at texture coordinates [..., 2]."""
    size = picture.shape[0]
    column = (uv[..., 0] * size).astype(int).clip(0, size - 1)
    row = ((1 - uv[..., 1]) * size).astype(int).clip(0, size - 1)
    return picture[row, column]


class TexelVisibility:
    """Counts, per texel of the chart, the views that see its centre."""

    def __init__(self, head: HeadScene, chart: Chart, size: int) -> None:
        self._head = head
        self._texels = rasterise(chart.uv.astype(float), chart.triangles, size)
        self._points = self._texels.sample(chart.vertices).astype(float)
        self._normals = unit(triangle_normals(chart.vertices.astype(float), chart.triangles[self._texels.triangle]))

    def seen_by(self, camera: Camera, mask: np.ndarray) -> np.ndarray:
        """[N, N] bool: the texel faces the camera, nothing lies between, and the pixel it
        falls into belongs to ``mask`` [H, W]."""
        towards = camera.position - self._points
        distance = np.linalg.norm(towards, axis=1, keepdims=True)
        towards /= distance
        seen = (towards * self._normals).sum(1) > 0
        column, row = np.floor(camera.project(self._points)).astype(int).T
        seen &= (column >= 0) & (column < camera.width) & (row >= 0) & (row < camera.height)
        seen[seen] = mask[row[seen], column[seen]]
        starts = self._points[seen] + _LIFT * self._normals[seen]
        seen[seen] = ~self._blocked(starts, towards[seen], distance[seen, 0])
        return self._texels.image(seen)

    def _blocked(self, origins: np.ndarray, directions: np.ndarray, distance: np.ndarray) -> np.ndarray:
        if not len(origins):
            return np.zeros(0, bool)
        scene = self._head.dark
        if dr.is_jit_v(mi.Float):
            rays = _rays(origins, directions)
            rays.maxt = mi.Float(distance.astype(np.float32))
            return np.array(scene.ray_test(rays))
        blocked = []
        for origin, direction, reach in zip(origins, directions, distance):
            ray = _rays(origin, direction)
            ray.maxt = float(reach)
            blocked.append(scene.ray_test(ray))
        return np.array(blocked)


def _rays(origins: np.ndarray, directions: np.ndarray):
    """Rays of arrays [N, 3], or one ray of arrays [3]."""
    if origins.ndim == 1:
        return mi.Ray3f(mi.Point3f(*map(float, origins)), mi.Vector3f(*map(float, directions)))
    points, vectors = (np.ascontiguousarray(a.T, dtype=np.float32) for a in (origins, directions))
    return mi.Ray3f(mi.Point3f(points), mi.Vector3f(vectors))

"""The skin as points: the chart's texels and the vertices of the parts that scatter.

Parts with one colour per vertex (rest of the head, mouth, sockets) are tissue like the
chart; parts with a texture (the eyes) stay opaque in every tier.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import drjit as dr
import mitsuba as mi
import numpy as np

from ...face.texels import Texels, rasterise
from ...vectors import triangle_normals, unit
from ..scene import HeadScene

TEXEL = 0.8e-3
"""Metres between the points on the chart. The blue profile of skin spreads over about as much
(2.5 scale radii of 0.35 mm in the mean); the gathering costs its inverse fourth power."""
_MIN_TEXELS, _MAX_TEXELS = 64, 1024
"""Bounds of the texels along the chart's edge."""


@dataclass(frozen=True)
class Mesh:
    """A shape of the scene as arrays: vertices (V,3), normals (V,3), triangles (F,3)."""

    name: str
    vertices: np.ndarray
    normals: np.ndarray
    triangles: np.ndarray

    @classmethod
    def of(cls, shape) -> Mesh:
        parameters = mi.traverse(shape)
        positions, normals = (np.array(parameters[f"vertex_{k}"]).reshape(-1, 3) for k in ("positions", "normals"))
        return cls(shape.id(), positions, normals, np.array(parameters["faces"]).reshape(-1, 3))

    @cached_property
    def doubled(self) -> np.ndarray:
        """Triangle normals (F,3) f64, as long as twice the triangle's area."""
        return triangle_normals(self.vertices.astype(float), self.triangles)


def scattering_parts(head: HeadScene) -> list:
    """The shapes beside the chart that light enters, in the order of their names."""
    return sorted((s for s in head.dark.shapes() if s.has_attribute("vertex_diffuse")), key=lambda s: s.id())


@dataclass(frozen=True)
class SkinPoints:
    """M points: T texels of the chart (see ``texels``), then the vertices of ``parts``.

    `positions` (M,3) m, `facing` (M,3) unit normals of the mesh, `normals` (M,3) unit
    diffuse normals, `areas` (M,) m2 of the surface each stands for.
    """

    positions: np.ndarray
    facing: np.ndarray
    normals: np.ndarray
    areas: np.ndarray
    texels: Texels
    parts: tuple[Mesh, ...]

    @classmethod
    def of(cls, head: HeadScene) -> SkinPoints:
        chart = Mesh.of(head.chart)
        uv = [0, 1] + [1, -1] * np.array(mi.traverse(head.chart)["vertex_texcoords"]).reshape(-1, 2).astype(float)
        flat = _doubled_uv(uv, chart.triangles)
        stretch = np.linalg.norm(chart.doubled, axis=1)
        edge = math.sqrt(stretch.sum() / flat.sum())
        size = int(np.clip(math.ceil(edge / TEXEL), _MIN_TEXELS, _MAX_TEXELS))
        texels = rasterise(uv, chart.triangles, size)
        smooth = unit(texels.sample(chart.normals))
        parts = tuple(Mesh.of(shape) for shape in scattering_parts(head))
        areas = np.divide(stretch, flat, out=np.zeros_like(flat), where=flat > 0)[texels.triangle] / size**2
        return cls(
            positions=np.concatenate([texels.sample(chart.vertices), *(p.vertices for p in parts)]),
            facing=np.concatenate([unit(chart.doubled[texels.triangle]), *(p.normals for p in parts)]).astype(
                np.float32
            ),
            normals=np.concatenate([_diffuse_normals(head, texels, smooth), *(p.normals for p in parts)]).astype(
                np.float32
            ),
            areas=np.concatenate([areas, *map(_vertex_areas, parts)]).astype(np.float32),
            texels=texels,
            parts=parts,
        )

    def albedo(self, head: HeadScene) -> np.ndarray:
        """Diffuse albedo (M,3) that the head has now."""
        chart = np.array(head.skin.diffuse.eval(_at_texels(self.texels))).T
        colours = [np.array(mi.traverse(s)["vertex_diffuse"]).reshape(-1, 3) for s in scattering_parts(head)]
        return np.concatenate([chart, *colours]).astype(np.float32)


def _doubled_uv(uv: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    a, b, c = (uv[triangles[:, k]] for k in range(3))
    u, v = b - a, c - a
    return np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])


def _at_texels(texels: Texels):
    """Interactions at the texels' centres: enough of them for a texture."""
    size = len(texels.inside)
    row, column = np.nonzero(texels.inside)
    si = dr.zeros(mi.SurfaceInteraction3f, len(row))
    si.uv = mi.Point2f(
        mi.Float((column + 0.5).astype(np.float32) / size), mi.Float((row + 0.5).astype(np.float32) / size)
    )
    return si


def _diffuse_normals(head: HeadScene, texels: Texels, smooth: np.ndarray) -> np.ndarray:
    """Unit diffuse normals [N, 3] at the texels: the map's, or ``smooth`` where it holds no direction."""
    if head.skin.diffuse_normal is None:
        return smooth
    mapped = np.array(head.skin.diffuse_normal.eval_3(_at_texels(texels))).T
    length = np.linalg.norm(mapped, axis=1, keepdims=True)
    return np.where(length > 1e-4, mapped / np.maximum(length, 1e-4), smooth)


def _vertex_areas(mesh: Mesh) -> np.ndarray:
    """A third of each triangle goes to each of its corners."""
    third = np.linalg.norm(mesh.doubled, axis=1) / 6
    return np.bincount(mesh.triangles.ravel(), np.repeat(third, 3), minlength=len(mesh.vertices))

"""Geometry of one face in the world, and the parts a renderer meets."""

from __future__ import annotations

import dataclasses

import numpy as np

from .head import Head, fit_sphere

EYES_TO_ORIGIN = 0.07
"""The world's origin lies this far (m) behind the midpoint of the eyes' centres: near the centre of the head."""


@dataclasses.dataclass(frozen=True)
class Chart:
    """The mesh given to solvers: smooth, one UV island, one uv per vertex.

    `vertices` (V,3) f32 m, `normals` (V,3) f32 unit, `uv` (V,2) f32, `triangles` (F,3) u32.
    """

    vertices: np.ndarray
    normals: np.ndarray
    uv: np.ndarray
    triangles: np.ndarray


@dataclasses.dataclass(frozen=True)
class Part:
    """An occluder beside the chart.

    `vertices` (V,3) f32 m, `normals` (V,3) f32 unit, `triangles` (F,3) u32. Without `uv`,
    `diffuse` (V,3) f32 linear Rec.709 and `specular` (V,) f32 (0 to 0.05) hold one value per
    vertex; with `uv` (V,2) f32 they are textures (H,W,3) and (H,W), row 0 at v = 1.
    """

    name: str
    vertices: np.ndarray
    normals: np.ndarray
    triangles: np.ndarray
    diffuse: np.ndarray
    specular: np.ndarray
    uv: np.ndarray | None = None


@dataclasses.dataclass(frozen=True)
class Geometry:
    """Subdivided joined mesh in world metres: `positions` and `normals` (V,3) f64; `eyes` (2,4) spheres, left first."""

    positions: np.ndarray
    normals: np.ndarray
    eyes: np.ndarray


def place(head: Head, base: np.ndarray) -> Geometry:
    """Subdivide base positions (B,3) and put the head at the origin.

    Normals are those of the joined mesh, so parts meet without a seam.
    """
    eyes = np.stack([fit_sphere(base[e]) for e in head.eyes])
    origin = eyes[:, :3].mean(axis=0) - [0, 0, EYES_TO_ORIGIN]
    eyes[:, :3] -= origin
    positions = head.refine(base) - origin
    triangles = np.concatenate([head.part_chart, head.part_rest, head.part_mouth, head.part_sockets])
    return Geometry(positions, vertex_normals(positions, triangles), eyes)


def vertex_normals(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Unit normals (V,3), triangles weighted by their angle at the vertex (Thuermer & Wuethrich 1998)."""
    corner = positions[triangles]
    face = unit(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]))
    total = np.zeros_like(positions)
    for k in range(3):
        a = unit(corner[:, (k + 1) % 3] - corner[:, k])
        b = unit(corner[:, (k + 2) % 3] - corner[:, k])
        weighted = face * np.arccos(np.clip((a * b).sum(axis=1), -1, 1))[:, None]
        for axis in range(3):
            total[:, axis] += np.bincount(triangles[:, k], weighted[:, axis], minlength=len(positions))
    return unit(total)


def unit(vectors: np.ndarray) -> np.ndarray:
    """Vectors scaled to length 1; zero vectors stay zero."""
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-30)


def part_mesh(geometry: Geometry, triangles: np.ndarray) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Subdivided vertices of a part and the mesh fields of its `Part`."""
    used, local = np.unique(triangles, return_inverse=True)
    return used, dict(
        vertices=geometry.positions[used].astype(np.float32),
        normals=geometry.normals[used].astype(np.float32),
        triangles=local.reshape(-1, 3).astype(np.uint32),
    )

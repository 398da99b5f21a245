"""Unit vectors, and the normals of triangle meshes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray


def unit(vectors: NDArray[Any]) -> NDArray[Any]:
    """Vectors (..., 3) scaled to length 1; zero vectors stay zero."""
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-30)


def away(azimuth: float, elevation: float) -> NDArray[np.float64]:
    """The unit vector (3,) away from the face: azimuth 0 in front of it, positive towards +X (rad)."""
    level = math.cos(elevation)
    return np.array([level * math.sin(azimuth), math.sin(elevation), level * math.cos(azimuth)])


def frame(direction: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Two unit vectors (3,) across a unit vector and each other."""
    side = np.cross(direction, [1.0, 0.0, 0.0] if abs(direction[0]) < 0.9 else [0.0, 1.0, 0.0])
    side /= np.linalg.norm(side)
    return side, np.cross(direction, side)


def triangle_normals(vertices: NDArray[Any], triangles: NDArray[Any]) -> NDArray[Any]:
    """Normals (F, 3) of triangles, counter-clockwise from outside; their lengths are twice the triangles' areas."""
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    return np.cross(b - a, c - a)


def twice_areas(vertices: NDArray[Any], triangles: NDArray[Any]) -> NDArray[Any]:
    """Twice the areas (F,) of triangles."""
    return np.linalg.norm(triangle_normals(vertices, triangles), axis=1)


def vertex_normals(positions: NDArray[Any], triangles: NDArray[Any]) -> NDArray[Any]:
    """Unit normals (V, 3), triangles weighted by their angle at the vertex (Thuermer & Wuethrich 1998)."""
    corner = positions[triangles]
    face = unit(triangle_normals(positions, triangles))
    total = np.zeros_like(positions)
    for k in range(3):
        a = unit(corner[:, (k + 1) % 3] - corner[:, k])
        b = unit(corner[:, (k + 2) % 3] - corner[:, k])
        weighted = face * np.arccos(np.clip((a * b).sum(axis=1), -1, 1))[:, None]
        for axis in range(3):
            total[:, axis] += np.bincount(triangles[:, k], weighted[:, axis], minlength=len(positions))
    return unit(total)

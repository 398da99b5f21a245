"""The head as one closed surface, which a medium can fill.

Chart and the parts that scatter are generated from one mesh, so their rims share vertices
to the bit: they are welded there. Open rims (the cut through the shoulders) are capped.
"""

from __future__ import annotations

from dataclasses import dataclass

import igl
import numpy as np

from ...errors import SceneError
from ...vectors import vertex_normals
from .surface import Mesh


@dataclass(frozen=True)
class Body:
    """Closed surface: `vertices` (V,3) f32 m, `triangles` (F,3) u32, facing outward."""

    vertices: np.ndarray
    triangles: np.ndarray

    @property
    def normals(self) -> np.ndarray:
        return vertex_normals(self.vertices.astype(float), self.triangles).astype(np.float32)


def close(meshes: list[Mesh]) -> Body:
    """Weld and cap. Raises `SceneError` where inside and outside cannot be distinguished."""
    vertices = np.concatenate([mesh.vertices for mesh in meshes])
    starts = np.cumsum([0] + [len(mesh.vertices) for mesh in meshes])
    triangles = np.concatenate([mesh.triangles.astype(np.int64) + start for mesh, start in zip(meshes, starts)])
    vertices, welded = np.unique(vertices, axis=0, return_inverse=True)
    triangles = welded.reshape(-1)[triangles]
    a, b, c = triangles.T
    triangles = triangles[(a != b) & (b != c) & (c != a)]
    vertices, triangles = _capped(vertices, triangles)
    if faults := _unpaired(triangles):
        raise SceneError(
            f'tier = "volume" needs a closed head, but {faults} edges of its mesh have no partner that runs the other way; '
            'fix the mesh (one surface, no flipped or doubled triangles), or set tier = "diffusion"'
        )
    return Body(vertices, triangles.astype(np.uint32))


def _capped(vertices: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Fans from the middle of every open rim."""
    directed = {(int(i), int(j)) for i, j in _edges(triangles)}
    centres, fans = [], []
    for loop in igl.boundary_loop_all(np.asfortranarray(triangles.astype(np.int32))):
        loop = np.asarray(loop)
        following = np.roll(loop, -1)
        # A cap runs along the rim against the triangles that end there.
        if (int(loop[0]), int(following[0])) in directed:
            loop, following = following, loop
        fans.append(np.stack([loop, following, np.full(len(loop), len(vertices) + len(centres))], axis=1))
        centres.append(vertices[loop].mean(axis=0, keepdims=True))
    if not fans:
        return vertices, triangles
    return np.concatenate([vertices, *centres]).astype(np.float32), np.concatenate([triangles, *fans])


def _edges(triangles: np.ndarray) -> np.ndarray:
    return np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])


def _unpaired(triangles: np.ndarray) -> int:
    """Directed edges that do not have exactly one partner in the other direction."""
    edges = _edges(triangles)
    span = int(triangles.max()) + 1
    forth, counts = np.unique(edges[:, 0] * span + edges[:, 1], return_counts=True)
    back = np.unique(edges[:, 1] * span + edges[:, 0])
    return int((counts > 1).sum() + np.setxor1d(forth, back).size)

"""The head as one closed surface, which a medium can fill.

Chart and the parts that scatter are generated from one mesh, so their rims share vertices
to the bit: they are welded there. A chart that is cut finer, to carry its relief, has more
vertices along its rims: the parts' triangles there are cut to match. Open rims (the cut
through the shoulders) are capped.
"""

from __future__ import annotations

import itertools
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
    """Weld, match and cap; the first of ``meshes`` may be the finer one. Raises `SceneError` where inside and outside
    cannot be distinguished."""
    vertices = np.concatenate([mesh.vertices for mesh in meshes])
    starts = np.cumsum([0] + [len(mesh.vertices) for mesh in meshes])
    triangles = np.concatenate([mesh.triangles.astype(np.int64) + start for mesh, start in zip(meshes, starts)])
    vertices, welded = _welded(vertices)
    triangles = welded[triangles]
    count = len(meshes[0].triangles)
    vertices, others = _matched(vertices, triangles[:count], triangles[count:])
    triangles = np.concatenate([triangles[:count], others])
    a, b, c = triangles.T
    triangles = triangles[(a != b) & (b != c) & (c != a)]
    vertices, triangles = _capped(vertices, triangles)
    if faults := _unpaired(triangles):
        raise SceneError(
            f'tier = "volume" needs a closed head, but {faults} edges of its mesh have no partner that runs the other way; '
            'fix the mesh (one surface, no flipped or doubled triangles), or set tier = "diffusion"'
        )
    return Body(vertices, triangles.astype(np.uint32))


def _welded(vertices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Different rows in lexicographic order, and the row of each: `numpy.unique`, which takes minutes for millions."""
    order = np.lexsort(vertices.T[::-1])
    ordered = vertices[order]
    new = np.concatenate([[True], (ordered[1:] != ordered[:-1]).any(1)])
    rows = np.empty(len(vertices), np.int64)
    rows[order] = np.cumsum(new) - 1
    return ordered[new], rows


def _matched(vertices: np.ndarray, fine: np.ndarray, coarse: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """``vertices`` with new ones, and ``coarse`` triangles [M, 3] whose edges have all vertices of the rims of ``fine``.

    A triangle with more vertices than its corners becomes a fan from its middle.
    """
    shared = np.zeros(len(vertices), bool)
    shared[coarse] = True
    between: dict[tuple[int, int], list[int]] = {}
    for loop in igl.boundary_loop_all(np.asfortranarray(fine.astype(np.int32))):
        loop = np.asarray(loop)
        ends = np.flatnonzero(shared[loop])
        if not len(ends):
            continue
        loop, ends = np.roll(loop, -ends[0]), [*(ends - ends[0]), len(loop)]
        for start, end in itertools.pairwise(ends):
            inner = loop[start + 1 : end].tolist()
            if inner:
                corners = int(loop[start]), int(loop[end % len(loop)])
                between[corners], between[corners[::-1]] = inner, inner[::-1]
    if not between:
        return vertices, coarse
    ends = np.isin(coarse, np.unique(list(between)))
    touching = np.flatnonzero(ends.sum(1) >= 2)
    middles, fans = [], []
    for a, b, c in coarse[touching].tolist():
        rim = [v for edge in ((a, b), (b, c), (c, a)) for v in (edge[0], *between.get(edge, ()))]
        if len(rim) > 3:
            middle = len(vertices) + len(middles)
            middles.append(vertices[[a, b, c]].mean(0, keepdims=True))
            fans += [(v, w, middle) for v, w in zip(rim, [*rim[1:], rim[0]])]
        else:
            fans.append((a, b, c))
    kept = np.delete(coarse, touching, axis=0)
    return np.concatenate([vertices, *middles]), np.concatenate([kept, np.array(fans, np.int64).reshape(-1, 3)])


def _capped(vertices: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Fans from the middle of every open rim."""
    edges = _edges(triangles)
    centres, fans = [], []
    for loop in igl.boundary_loop_all(np.asfortranarray(triangles.astype(np.int32))):
        loop = np.asarray(loop)
        following = np.roll(loop, -1)
        # A cap runs along the rim against the triangles that end there.
        if (edges == (loop[0], following[0])).all(1).any():
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
    # Sorted: `numpy.unique` takes minutes for millions.
    forth = np.sort(edges[:, 0] * span + edges[:, 1])
    back = np.sort(edges[:, 1] * span + edges[:, 0])
    doubled = forth[1:] == forth[:-1]
    if not doubled.any() and (forth == back).all():
        return 0
    return int(doubled.sum() + np.setxor1d(forth, back).size)

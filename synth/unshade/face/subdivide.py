"""Catmull-Clark subdivision of a quad mesh as one sparse matrix."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp


def catmull_clark(quads: np.ndarray, vertex_count: int) -> tuple[sp.csr_matrix, np.ndarray]:
    """One level: matrix (new x old vertices) and quads (4 per quad, corner by corner).

    Rules of Catmull & Clark 1978; an open boundary becomes a cubic B-spline curve
    (1/8, 3/4, 1/8). New vertices are the old ones, then edges, then faces.
    Every vertex must belong to a quad.
    """
    faces = len(quads)
    sides = np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2)
    edges, edge_of_side = np.unique(np.sort(sides, axis=1), axis=0, return_inverse=True)
    edge_of_side = edge_of_side.reshape(faces, 4)
    count = len(edges)
    inner = (np.bincount(edge_of_side.ravel(), minlength=count) == 2).astype(float)

    def matrix(value: float, rows: np.ndarray, columns: np.ndarray, shape: tuple[int, int]) -> sp.csr_matrix:
        return sp.csr_matrix((np.full(rows.size, value), (rows.ravel(), columns.ravel())), shape=shape)

    face_rows = np.repeat(np.arange(faces), 4)
    edge_rows = np.repeat(np.arange(count), 2)
    face_point = matrix(0.25, face_rows, quads, (faces, vertex_count))
    midpoint = matrix(0.5, edge_rows, edges, (count, vertex_count))
    edge_faces = matrix(1.0, edge_of_side, face_rows, (count, faces))
    edge_point = sp.diags(1 - 0.5 * inner) @ midpoint + sp.diags(0.25 * inner) @ edge_faces @ face_point

    vertex_faces = matrix(1.0, quads, face_rows, (vertex_count, faces))
    vertex_edges = matrix(1.0, edges, edge_rows, (vertex_count, count))
    valence = np.asarray(vertex_faces.sum(axis=1)).ravel()
    boundary_edges = vertex_edges @ sp.diags(1 - inner)
    boundary_valence = np.asarray(boundary_edges.sum(axis=1)).ravel()
    smooth = (boundary_valence == 0).astype(float)
    vertex_point = (
        sp.diags(smooth / valence**2) @ (vertex_faces @ face_point + 2 * vertex_edges @ midpoint)
        + sp.diags(smooth * (valence - 3) / valence)
        + sp.diags(0.5 * (1 - smooth))
        + sp.diags(0.5 * (1 - smooth) / np.maximum(boundary_valence, 1)) @ boundary_edges @ midpoint
    )
    edge_id = vertex_count + edge_of_side
    face_id = vertex_count + count + np.arange(faces)
    finer = [np.stack([quads[:, k], edge_id[:, k], face_id, edge_id[:, k - 1]], axis=1) for k in range(4)]
    refine = sp.vstack([vertex_point, edge_point, face_point]).tocsr()
    return refine, np.stack(finer, axis=1).reshape(-1, 4)


def subdivide(quads: np.ndarray, vertex_count: int, levels: int) -> tuple[sp.csr_matrix, np.ndarray]:
    """`levels` of Catmull-Clark: matrix (new x old) and quads (4**levels per quad, in the order of the old ones)."""
    total = sp.identity(vertex_count, format="csr")
    for _ in range(levels):
        refine, quads = catmull_clark(quads, total.shape[0])
        total = refine @ total
    total.sort_indices()
    return total.tocsr(), quads


def triangulate(quads: np.ndarray) -> np.ndarray:
    """Two triangles per quad, (2F,3), along the diagonal from corner 0 to corner 2."""
    return np.stack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]], axis=1).reshape(-1, 3)

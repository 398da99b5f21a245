"""One object of a mesh file."""

from __future__ import annotations

import dataclasses

import numpy as np


@dataclasses.dataclass(frozen=True)
class Piece:
    """One object of a file, in the file's units and axes.

    `vertices` (V,3) f64, `triangles` (F,3) i64, `uv` (V,2) f64 (v up) and `normals` (V,3)
    f64 where the file has them. Vertices are split where uvs or normals are. `parts` are its
    materials (or the object) in words, `part_of` (F,) i64 the part of each triangle.
    """

    name: str
    vertices: np.ndarray
    triangles: np.ndarray
    uv: np.ndarray | None
    normals: np.ndarray | None
    parts: list[str]
    part_of: np.ndarray

"""Which side of a head's chart is its outside: exporters turn normals and triangles round, wholly or here and there."""

from __future__ import annotations

import warnings

import numpy as np

from .placement import middle
from .spec import HeadFiles, MeshWarning


def oriented_outwards(
    points: np.ndarray, triangles: np.ndarray, normals: np.ndarray | None, head: HeadFiles
) -> tuple[np.ndarray, np.ndarray | None]:
    """Triangles (F,3) and normals (V,3) or None, all facing outwards.

    Warns, with numbers, of those that do not in the file: neighbours are wound alike, closed
    surfaces face away from their inside, open ones from the middle of the head.
    """
    from unshade import _native

    inward, against, one_sided = _native.outward_turns(
        points - middle(points),
        np.ascontiguousarray(triangles, np.int64),
        None if normals is None else np.ascontiguousarray(normals),
    )
    said = []
    if inward.any():
        triangles = np.where(inward[:, None], triangles[:, [0, 2, 1]], triangles)
        said.append(f"{int(inward.sum())} of {len(triangles)} triangles")
    if normals is not None and against.any():
        normals = np.where(against[:, None], -normals, normals)
        said.append(f"{int(against.sum())} of {len(normals)} normals")
    if said:
        warnings.warn(
            f"{head.mesh}: {' and '.join(said)} point inwards; flipped them outwards",
            MeshWarning,
            stacklevel=2,
        )
    if one_sided:
        text = f"{one_sided} of {len(triangles)} triangles are on one-sided (twisted) surfaces; fix the mesh there"
        warnings.warn(f"{head.mesh}: {text}", MeshWarning, stacklevel=2)
    return triangles, normals

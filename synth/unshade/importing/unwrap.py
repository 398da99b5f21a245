"""Texture coordinates for a mesh that has none, by xatlas."""

from __future__ import annotations

import numpy as np
import xatlas
from numpy.typing import NDArray

_PAGE, _PADDING = 1024, 8
"""Texels along the side of the page and between islands."""


def unwrap(
    vertices: NDArray[np.float64], triangles: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """Returns for each vertex of the unwrapped mesh its row in ``vertices``, triangles (F, 3), and UV (V, 2), v up.

    Islands are as few as xatlas makes them: every seam costs a solve accuracy. Takes a minute for 100,000 triangles.
    """
    atlas = xatlas.Atlas()
    atlas.add_mesh(vertices.astype(np.float32), triangles.astype(np.uint32))
    charts, packing = xatlas.ChartOptions(), xatlas.PackOptions()
    charts.max_cost, charts.max_iterations = 32.0, 1
    packing.resolution, packing.padding, packing.create_image = _PAGE, _PADDING, False
    atlas.generate(chart_options=charts, pack_options=packing)
    rows, corners, uv = atlas[0]
    return rows.astype(np.int64), corners.astype(np.int64), uv.astype(float)

"""Relief as geometry: the chart's surface raised by the painted height, so that it shadows itself."""

from __future__ import annotations

import math

import igl
import numpy as np
from scipy.ndimage import map_coordinates
from scipy.spatial import cKDTree

from ..vectors import unit
from .chart import boundary_loops, signed_areas
from .geometry import Chart
from .regions import smoothstep

_MOST_TRIANGLES = 8_000_000
"""More are not cut: those of a wide chart of 1024 texels."""

_SEAM_MM = 2.0
"""Over this distance from its rims (lids, mouth, outer rim) the surface sinks back to the smooth one: there other
parts of the head meet it."""


def displaced(chart: Chart, height: np.ndarray) -> Chart:
    """The chart raised along its normals by ``height`` [N, N] in metres, bilinear, row 0 at v = 1.

    Its triangles are cut in four, where they lie, until over half of its area they are smaller than half a
    texel, or there would be too many. UV are those of the chart; so are the normals, which a normal map replaces.
    """
    texels = np.sort(np.abs(signed_areas(chart.uv.astype(float), chart.triangles.astype(np.int64)))) * height.size
    median = texels[np.searchsorted(np.cumsum(texels), texels.sum() / 2)]
    most = math.floor(math.log(_MOST_TRIANGLES / len(chart.triangles), 4))
    levels = max(0, min(math.ceil(math.log(2 * median, 4)), most))
    corners = np.column_stack([chart.vertices, chart.normals, chart.uv]).astype(np.float64)
    fine, triangles = igl.upsample(corners, chart.triangles.astype(np.int64), levels)
    positions, normals, uv = fine[:, :3], unit(fine[:, 3:6]), fine[:, 6:]
    at = np.stack([1 - uv[:, 1], uv[:, 0]]) * len(height) - 0.5
    raised = map_coordinates(height.astype(np.float64), at, order=1, mode="nearest")
    rims = np.concatenate(boundary_loops(triangles))
    to_rim = cKDTree(positions[rims]).query(positions, distance_upper_bound=1e-3 * _SEAM_MM)[0]
    raised *= smoothstep(0, _SEAM_MM, 1e3 * to_rim)
    return Chart(
        vertices=(positions + raised[:, None] * normals).astype(np.float32),
        normals=normals.astype(np.float32),
        uv=uv.astype(np.float32),
        triangles=triangles.astype(np.uint32),
    )

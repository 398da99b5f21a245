"""From the perfect chart to the one that solvers get."""

from __future__ import annotations

import numpy as np

from ..errors import SceneError
from ..face import Chart
from ..scene_file import CapturedMesh
from ..vectors import vertex_normals
from .bumps import bump_heights
from .decimate import decimate
from .smooth import smoothed


def degrade(chart: Chart, spec: CapturedMesh, seed: int) -> Chart:
    """The chart smoothed, with bumps, and decimated, in that order, as stereo and its mesher do.

    Vertices keep their texture coordinates, so the maps of both meshes correspond; no
    triangle is flipped in UV, and holes stay holes. The chart itself where nothing is wrong
    with it. Equal seeds give equal bytes. Raises `SceneError` where the mesh cannot be
    decimated as far as that.
    """
    if spec == CapturedMesh():
        return chart
    rng = np.random.default_rng(seed)
    triangles = chart.triangles.astype(np.int64)
    positions = chart.vertices.astype(float)
    # Vertices at the two sides of a UV seam are one point of the surface, and must move as one.
    point_of = np.unique(chart.vertices, axis=0, return_inverse=True)[1].ravel()
    if spec.smoothing_mm:
        positions = smoothed(positions, triangles, spec.smoothing_mm / 1000)
    if spec.bumps_mm:
        heights = bump_heights(positions, triangles, spec.bumps_mm / 1000, spec.bumps_wavelength_mm / 1000, rng)
        positions = positions + heights[:, None] * _normals(positions, triangles, point_of)
    kept = np.arange(len(positions))
    if spec.vertex_share < 1:
        target = round(spec.vertex_share * len(positions))
        seam = np.bincount(point_of)[point_of] > 1
        kept, triangles = decimate(positions, chart.uv.astype(float), triangles, target, seam, rng)
        if len(kept) > target:
            raise SceneError(
                f"vertex_share in [captured_mesh] is {spec.vertex_share:g}, but without folding the chart or closing a hole "
                f"{len(kept) / len(positions):.3f} of the vertices remain; use at least that"
            )
    normals = _normals(positions[kept], triangles, point_of[kept])
    return Chart(
        positions[kept].astype(np.float32),
        normals.astype(np.float32),
        chart.uv[kept],
        triangles.astype(chart.triangles.dtype),
    )


def _normals(positions: np.ndarray, triangles: np.ndarray, point_of: np.ndarray) -> np.ndarray:
    """Unit normals (V,3) of the surface without its UV seams."""
    _, first, point = np.unique(point_of, return_index=True, return_inverse=True)
    return vertex_normals(positions[first], point.ravel()[triangles])[point.ravel()]

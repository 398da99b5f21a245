"""How far a captured mesh is from the true surface."""

from __future__ import annotations

import igl
import numpy as np

from ..face import Chart
from ..face.chart import signed_areas


def deviation(perfect: Chart, captured: Chart) -> dict[str, float | int]:
    """Size of the captured mesh, and distances between its surface and the perfect one (mm).

    ``to_truth`` goes from the captured vertices, ``from_truth`` from the perfect ones (which
    meet what decimation cut away) to the nearest point of the other surface.
    """
    there, back = 1000 * _distances(captured, perfect), 1000 * _distances(perfect, captured)
    return {
        "vertices": len(captured.vertices),
        "triangles": len(captured.triangles),
        "vertex_share": round(len(captured.vertices) / len(perfect.vertices), 6),
        "uv_flips": int((signed_areas(captured.uv.astype(float), captured.triangles) <= 0).sum()),
        "mean_distance_to_truth_mm": round(float(there.mean()), 6),
        "max_distance_to_truth_mm": round(float(there.max()), 6),
        "mean_distance_from_truth_mm": round(float(back.mean()), 6),
        "max_distance_from_truth_mm": round(float(back.max()), 6),
    }


def _distances(start: Chart, surface: Chart) -> np.ndarray:
    squared, _, _ = igl.point_mesh_squared_distance(
        start.vertices.astype(float), surface.vertices.astype(float), surface.triangles.astype(np.int64)
    )
    return np.sqrt(squared)

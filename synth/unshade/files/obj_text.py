"""The chart as a Wavefront OBJ file."""

from __future__ import annotations

import numpy as np

from ..face import Chart


def obj_text(chart: Chart) -> str:
    """Triangles with one uv and one normal per vertex; nine digits give back every float32."""
    lines = ["# face chart: metres, +Y up, looking along +Z"]
    for keyword, values in (("v", chart.vertices), ("vt", chart.uv), ("vn", chart.normals)):
        form = keyword + " %.9g" * values.shape[1]
        lines += [form % tuple(row) for row in values.astype(np.float64).tolist()]
    corners = np.repeat(chart.triangles.astype(np.int64) + 1, 3, axis=1)
    lines += ["f %d/%d/%d %d/%d/%d %d/%d/%d" % tuple(row) for row in corners.tolist()]
    return "\n".join(lines) + "\n"

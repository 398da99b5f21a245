"""`build_face`: from a specification to everything a renderer needs."""

from __future__ import annotations

import dataclasses

import numpy as np

from .cache import load_head
from .geometry import Chart, Part, part_mesh, place
from .identity import shape
from .spec import FaceSpec
from .texels import rasterise


@dataclasses.dataclass(frozen=True)
class Maps:
    """Truth maps (N,N,...), texel row 0 at v = 1; every texel holds a value, those outside the chart their nearest one's.

    `diffuse_albedo` (N,N,3) f32 linear Rec.709; `specular_albedo` (N,N) f32, reflectance at
    normal incidence, 0 to 0.05; `specular_normal` and `diffuse_normal` (N,N,3) f32 unit
    vectors in object space (= world); `labels` (N,N) u8, see `labels.Label`;
    `inside` (N,N) bool: the texel's centre lies in the chart.
    """

    diffuse_albedo: np.ndarray
    specular_albedo: np.ndarray
    specular_normal: np.ndarray
    diffuse_normal: np.ndarray
    labels: np.ndarray
    inside: np.ndarray


@dataclasses.dataclass(frozen=True)
class Face:
    """A face in the world: metres, right-handed, +Y up, looking along +Z.

    The origin lies 70 mm behind the midpoint of the eyes' centres, near the centre of
    the head. `parts` are the occluders: `rest` (of head, neck and shoulders), `mouth`,
    `sockets`, `eye_left`, `eye_right` (the person's own left: +X).
    """

    spec: FaceSpec
    chart: Chart
    parts: list[Part]
    maps: Maps


def build_face(spec: FaceSpec) -> Face:
    """Shape and paint one face. Equal specifications give equal bytes.

    Raises `FaceError` where the head data is missing.
    """
    head = load_head()
    geometry = place(head, shape(head, spec))
    used, mesh = part_mesh(geometry, head.part_chart)
    chart = Chart(uv=head.chart_uv.astype(np.float32), **mesh)
    texels = rasterise(head.chart_uv, head.chart_triangles, spec.texture_size)
    normal = texels.sample(geometry.normals[used])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    rows, columns = texels.nearest_inside()
    normal = texels.image(normal)[rows, columns]
    size = texels.inside.shape
    maps = Maps(
        np.full((*size, 3), 0.4, np.float32), np.full(size, 0.03, np.float32), normal, normal,
        texels.inside.astype(np.uint8), texels.inside,
    )  # fmt: skip
    parts = []
    for name in ("rest", "mouth", "sockets"):
        used, mesh = part_mesh(geometry, getattr(head, f"part_{name}"))
        parts.append(Part(name=name, diffuse=np.full((len(used), 3), 0.4, np.float32), specular=np.full(len(used), 0.03, np.float32), **mesh))
    return Face(spec, chart, parts, maps)

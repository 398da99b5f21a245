"""All truth maps of one face, painted texel by texel over the chart."""

from __future__ import annotations

import dataclasses

import numpy as np

from .geometry import Geometry, unit
from .hair import HairStyle, beard_cover, draw_brows, scalp_cover, scalp_grain
from .head import Head
from .labels import Label
from .normals import DIFFUSION_MM, relief_normals, smoothed, tangents
from .regions import Regions, find_regions, pair, sample_masks, smoothstep
from .relief import draw_relief
from .skin import chart_colour, draw_marks
from .spec import FaceSpec
from .strokes import Sketch
from .texels import Texels, rasterise


@dataclasses.dataclass(frozen=True)
class Maps:
    """Truth maps (N,N,...), texel row 0 at v = 1.

    Every texel holds a value, those outside the chart their nearest one's, so that a bilinear
    lookup at the rim meets no black. `diffuse_albedo` (N,N,3) f32 linear Rec.709;
    `specular_albedo` (N,N) f32, reflectance at normal incidence, 0 to 0.05; `specular_normal`
    and `diffuse_normal` (N,N,3) f32 unit vectors in object space (= world); `labels` (N,N) u8,
    ids of `Label`, 0 outside; `inside` (N,N) bool: the texel's centre lies in the chart.
    """

    diffuse_albedo: np.ndarray
    specular_albedo: np.ndarray
    specular_normal: np.ndarray
    diffuse_normal: np.ndarray
    labels: np.ndarray
    inside: np.ndarray


# Detail of the chart fades out over this distance (mm) from its outer rim.
_RIM_FADE_MM = 18.0


def paint_maps(head: Head, geometry: Geometry, style: HairStyle, spec: FaceSpec) -> Maps:
    """Paint the chart of a face placed as `geometry`."""
    uv, triangles, vertices = head.chart_uv, head.chart_triangles, head.chart_vertices
    texels = rasterise(uv, triangles, spec.texture_size)
    nearest = texels.nearest_inside()
    scale = chart_scale(head)
    texel = scale / spec.texture_size

    points = texels.sample(head.template[vertices])
    regions = find_regions(points, sample_masks(head, texels.sample(head.native_uv)))
    sites = find_regions(head.template[vertices].astype(np.float32), sample_masks(head, head.native_uv))
    positions, normals = geometry.positions[vertices], geometry.normals[vertices]
    rims = _rims(texels, positions, geometry.eyes, head.rim_mm, regions)
    sketch = Sketch(points, (points[:, 2] > -30) & (rims["outer"] > 0))
    cover = {
        "brow": draw_brows(sketch, len(points), texel, spec),
        "scalp": scalp_cover(points, style, spec.seed),
        "beard": beard_cover(points, regions.lips, style),
    }
    places = texels.sample(uv) * np.float32(scale)
    relief = draw_relief(regions, places, sketch, cover["brow"], texel, spec)
    marks = draw_marks(points, texels, sites, uv, texel, spec)
    labels = _labels(regions, cover)
    cover["scalp"] = cover["scalp"] * (1 - rims["outer"] * (1 - scalp_grain(points, 2 * texel, spec.seed)))
    diffuse, specular = chart_colour(regions, relief, marks, cover, rims, texel, style, spec)

    smooth = unit(texels.sample(normals))
    du, dv = (texels.sample(t) for t in tangents(positions, uv, triangles))
    metres = 1e-3 * relief.height * rims["outer"]
    blurred = smoothed(metres, texels, DIFFUSION_MM / texel)

    def extended(values: np.ndarray) -> np.ndarray:
        return texels.image(values)[nearest]

    return Maps(
        diffuse_albedo=extended(diffuse),
        specular_albedo=extended(specular),
        specular_normal=extended(relief_normals(metres, texels, nearest, smooth, du, dv)),
        diffuse_normal=extended(relief_normals(blurred, texels, nearest, smooth, du, dv)),
        labels=texels.image(labels),
        inside=texels.inside,
    )


def chart_scale(head: Head) -> float:
    """Template millimetres per unit of UV, in the mean over the chart's area."""
    corner, flat = head.template[head.part_chart], head.chart_uv[head.chart_triangles]
    area = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1).sum()
    return float(np.sqrt(area / np.abs(np.cross(flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0])).sum()))


def _rims(texels: Texels, positions: np.ndarray, eyes: np.ndarray, rim_mm: np.ndarray, regions: Regions) -> dict[str, np.ndarray]:
    """`outer`: 0 at the chart's outer rim to 1 inside; `lash`, `wet`: dark line and moist edge of the lids' margins.

    The margin is found on the face itself: there the skin lifts off the eyeball.
    """
    gaps = [np.linalg.norm(positions - eye[:3], axis=1) - eye[3] for eye in eyes]
    gap = texels.sample(1000 * np.minimum(*gaps))
    socket = pair(regions.points, (29, 0, 12), (17, 9, 14)) > 0.25
    upper = smoothstep(-2.0, 2.0, regions.points[:, 1])
    lash = socket * smoothstep(0.3, 0.8, gap) * smoothstep(2.0, 1.2, gap) * (0.35 + 0.65 * upper)
    wet = socket * smoothstep(0.8, 0.2, gap) * (1 - 0.6 * upper)
    return {
        "outer": smoothstep(0, _RIM_FADE_MM, texels.sample(rim_mm)).astype(np.float32),
        "lash": lash.astype(np.float32),
        "wet": wet.astype(np.float32),
    }


def _labels(regions: Regions, cover: dict[str, np.ndarray]) -> np.ndarray:
    """Region ids (M,) u8; where regions overlap the later one of this list wins."""
    labels = np.full(len(regions.points), Label.SKIN, dtype=np.uint8)
    for label, where in (
        (Label.EAR, regions.ears > 0.5),
        (Label.EYELID, regions.lids > 0.5),
        (Label.NOSE, regions.nose > 0.40),
        (Label.LIPS, regions.lips > 0.5),
        (Label.SCALP, cover["scalp"] > 0.5),
        (Label.BROW, cover["brow"] > 0.3),
    ):
        labels[where] = label
    return labels

"""All truth maps of one face, painted texel by texel over the chart."""

from __future__ import annotations

import dataclasses

import numpy as np

from ..vectors import unit
from .canvas import Canvas, has_surround
from .geometry import Geometry
from .hair import HairStyle, beard_cover, draw_brows, scalp_cover, scalp_grain
from .labels import Label
from .lids import margin_distance
from .natural import draw_natural
from .normals import DIFFUSION_MM, relief_normals, smoothed, tangents
from .pores import stubble_roots
from .regions import Regions, find_regions, sample_masks, smoothstep
from .relief import draw_relief
from .roughness import MIN_ALPHA, draw_roughness
from .skin import SPECULAR_LIMIT, Pigments, base_pigments, chart_colour, draw_marks
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
    ids of `Label`, 0 outside; `inside` (N,N) bool: the texel's centre lies in the chart;
    `roughness` (N,N,3) f32: GGX alphas of the two specular lobes and the share of the first; `height` (N,N) f32: the
    relief over the smooth mesh in metres, which the specular normals show, but none on the lids, which are too
    thin to be moved (None for a head without).
    """

    diffuse_albedo: np.ndarray
    specular_albedo: np.ndarray
    specular_normal: np.ndarray
    diffuse_normal: np.ndarray
    labels: np.ndarray
    inside: np.ndarray
    roughness: np.ndarray
    height: np.ndarray | None = None


# Detail of the chart fades out over this distance (mm) from its outer rim.
_RIM_FADE_MM = 18.0
_MARK_FADE_MM = 5.0

# Between these distances (mm) from the eyeballs skin comes to be more than a lid.
_LID_MM = (3.0, 7.0)


def paint_maps(canvas: Canvas, geometry: Geometry, style: HairStyle, spec: FaceSpec) -> Maps:
    """Paint a chart of a face placed as `geometry`."""
    uv, triangles, vertices, sites = canvas.uv, canvas.triangles, canvas.vertices, canvas.sites
    texels = rasterise(uv, triangles, spec.texture_size)
    nearest = texels.nearest_inside()
    texel = canvas.scale / spec.texture_size

    # Slowly varying quantities are computed at the vertices and interpolated.
    coarse = base_pigments(sites, spec)
    melanin, blood, scalp, x, y, z, s, t, u, v = texels.sample(
        np.column_stack(
            [
                coarse.melanin,
                coarse.blood,
                scalp_cover(sites.points, style, spec.seed),
                sites.points,
                canvas.native_uv,
                uv,
            ]
        )
    ).T
    points = np.stack([x, y, z], axis=1)
    regions = find_regions(points, sample_masks(np.stack([s, t], axis=1)))
    positions, normals = geometry.positions[vertices], geometry.normals[vertices]
    rims = _rims(canvas, texels, positions, geometry, regions, spec)
    front = (z > -30) & (y > -100) & (y < 85) & (np.abs(x) < 70)
    sketch = Sketch(points, front & canvas.is_face)
    brow, brow_outline = draw_brows(sketch, points, texel, spec)
    cover = {"brow": brow, "scalp": scalp, "beard": beard_cover(regions, style)}
    labels = _labels(regions, scalp, brow_outline)
    places = np.stack([u, v], axis=1) * np.float32(canvas.scale)
    relief = draw_relief(regions, places, sketch, brow, texel, spec)
    shaven = np.flatnonzero(cover["beard"])
    cover["beard"][shaven] = np.minimum(cover["beard"][shaven] * stubble_roots(places[shaven], texel, spec), 1.8)
    marks = draw_marks(points, texels, sites, uv, texel, spec)
    hairy = np.flatnonzero(scalp)
    stubble = 1 - rims["outer"][hairy] * (1 - scalp_grain(points[hairy], 2 * texel, spec.seed))
    cover["scalp"] = scalp.copy()
    cover["scalp"][hairy] *= stubble
    pigments, fade = Pigments(melanin, blood), rims["outer"]
    natural = None
    if spec.detail == "natural":
        natural = draw_natural(regions, canvas, texels, nearest, relief.pores, rims["edge"], texel, style, spec)
        pigments, marks = natural.pigments(pigments, fade), np.zeros_like(marks)
        # Hair is strands; between them the skin is in their shade.
        cover["scalp"] = 0.85 * cover["scalp"]
        relief = dataclasses.replace(relief, height=relief.height + natural.height)
    diffuse, specular = chart_colour(regions, pigments, relief, marks, cover, rims, texel, style, spec)
    roughness = draw_roughness(regions, relief, cover, rims, texel, spec)
    if natural is not None:
        diffuse, specular = natural.colour(diffuse, style, fade), natural.specular(specular, fade)
        roughness = natural.roughness(roughness, fade)
    if spec.specular_scale != 1:
        specular = np.clip(np.float32(spec.specular_scale) * specular, 0, SPECULAR_LIMIT)
    if spec.roughness_scale != 1:
        scales = np.float32([spec.roughness_scale, spec.roughness_scale, 1])
        roughness = np.clip(roughness * scales, MIN_ALPHA, 1)

    smooth = unit(texels.sample(normals))
    du, dv = (texels.sample(t) for t in tangents(positions, uv, triangles))
    metres = 1e-3 * relief.height * rims["relief"]
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
        roughness=extended(roughness),
        height=extended((metres * _thick(texels.sample(positions), geometry.eyes)).astype(np.float32)),
    )


def _thick(positions: np.ndarray, eyes: np.ndarray) -> np.ndarray:
    """0 where skin at positions (M,3) m lies close over an eyeball, 1 where it can be raised and sunk."""
    over = [1000 * (np.linalg.norm(positions - eye[:3], axis=1) - eye[3]) for eye in eyes]
    return smoothstep(*_LID_MM, np.minimum(*over))


def _rims(
    canvas: Canvas, texels: Texels, positions: np.ndarray, geometry: Geometry, regions: Regions, spec: FaceSpec
) -> dict[str, np.ndarray]:
    """`outer`: 0 at the chart's outer rim to 1 inside, or 1 where a painted surround goes on; `relief` the same for the
    height, and `edge` for single marks, which a rim would cut; `lash`, `wet`: dark line and moist edge of the lids.
    """
    outer = texels.sample(canvas.rim_mm)
    rims = {"outer": smoothstep(0, _RIM_FADE_MM, outer), "edge": smoothstep(0, _MARK_FADE_MM, outer)}
    rims["relief"] = rims["outer"]
    if has_surround(spec):
        rims["outer"] = np.ones_like(outer)
        # As geometry the chart's relief has to end at its rim, where the smooth rest of the head begins.
        rims["relief"] = rims["relief"] if spec.displacement else rims["outer"]
    if not canvas.is_face:
        return rims | {"lash": np.zeros_like(outer), "wet": np.zeros_like(outer)}
    lid = texels.sample(1000 * margin_distance(positions, canvas.triangles, geometry.eyes))
    upper = smoothstep(-3.0, 2.0, regions.points[:, 1])
    width = 0.55 + 0.75 * upper
    lash = (0.45 + 0.55 * upper) * smoothstep(width, 0.4 * width, lid) * smoothstep(0.0, 0.25, lid + 0.25 * upper)
    wet = (1 - upper) * smoothstep(0.9, 0.3, lid)
    return rims | {"lash": lash, "wet": wet}


def _labels(regions: Regions, scalp: np.ndarray, brow: np.ndarray) -> np.ndarray:
    """Region ids (M,) u8; where regions overlap the later one of this list wins."""
    labels = np.full(len(regions.points), Label.SKIN, dtype=np.uint8)
    for label, where in (
        (Label.EAR, regions.ears > 0.5),
        (Label.EYELID, regions.lids > 0.5),
        (Label.NOSE, regions.nose_outline > 0.5),
        (Label.LIPS, regions.lips > 0.5),
        (Label.SCALP, scalp > 0.5),
        (Label.BROW, brow > 0.5),
    ):
        labels[where] = label
    return labels

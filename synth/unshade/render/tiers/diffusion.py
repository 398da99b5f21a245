"""Tier ``diffusion``: light is baked over the skin, blurred by a profile, and looked up.

Radiance of the diffuse layer = albedo / pi x blurred irradiance: the albedo is applied
after scattering ("post-scatter"), so that under even light the ratio of exitance to
irradiance is the albedo map itself, sharp as it was painted.
"""

from __future__ import annotations

from dataclasses import dataclass

import drjit as dr
import mitsuba as mi
import numpy as np

from ...scene_file import Render, passes_for
from ..passes import seed_of
from ..scene import HeadScene, LitHead
from ..split import split_radiance
from . import gather, irradiance
from .surface import SkinPoints


@dataclass(frozen=True)
class BakedIrradiance:
    """Blurred irradiance of a head in a light, ``bakes`` times independently."""

    points: SkinPoints
    blurred: gather.Blurred
    bakes: int


def bake(
    head: HeadScene, lit: LitHead, points: SkinPoints, render: Render, seed: int, progress=None
) -> BakedIrradiance:
    """As many paths per point as a pixel has samples, one bake for each pass of a picture."""
    passes = passes_for(render.samples)
    light = irradiance.bake(
        lit, points, bakes=passes, samples=render.samples // passes, depth=render.depth,
        seed=seed_of("irradiance", seed), progress=progress,
    )  # fmt: skip
    open_ = ~irradiance.shut_in(lit, points, seed_of("shut in", seed))
    path = np.array(render.subsurface_mm) * 1e-3
    return BakedIrradiance(points, gather.blur(light, points, points.albedo(head), path, open_), passes)


def estimator(head: HeadScene, lit: LitHead, baked: BakedIrradiance, depth: int):
    """Function of sampler, ray and pass that gives the layers of `passes.render_estimate`."""
    lookup = _Lookup(head, baked)

    def estimate(sampler, ray, number):
        diffuse, specular = split_radiance(
            lit.scene, lit.dark, sampler, ray, dr.opaque(mi.UInt32, depth), lit.lambert_light
        )
        pi = lit.dark.ray_intersect_preliminary(ray, coherent=True)
        si = pi.compute_surface_interaction(ray, +mi.RayFlags.All)
        skin, light = lookup(pi, si, number)
        albedo = si.bsdf(ray).eval_diffuse_reflectance(si, skin)
        # One-sided, as the skin material is.
        seen = dr.dot(si.n, ray.d) < 0
        return dr.select(skin, dr.select(seen, albedo * light * dr.inv_pi, 0), diffuse), specular

    return estimate


class _Lookup:
    """Blurred irradiance where a ray met the skin: bilinear on the chart, barycentric on the parts."""

    def __init__(self, head: HeadScene, baked: BakedIrradiance) -> None:
        points, values = baked.points, baked.blurred.irradiance
        self._chart = mi.ShapePtr(head.chart)
        self._size = len(points.texels.inside)
        count = len(points.texels.triangle)
        rows, columns = points.texels.nearest_inside()
        # [bakes, N, N]: texels outside the chart repeat their nearest one.
        pictures = [points.texels.image(values[:count, k])[rows, columns].reshape(-1, 3) for k in range(baked.bakes)]
        self._texels = mi.Color3f(np.ascontiguousarray(np.concatenate(pictures).T))
        self._parts = []
        start = count
        shapes = {shape.id(): shape for shape in head.dark.shapes()}
        for part in points.parts:
            end = start + len(part.vertices)
            light = np.ascontiguousarray(values[start:end].transpose(2, 1, 0).reshape(3, -1))
            faces = mi.UInt32(np.ascontiguousarray(part.triangles.ravel(), dtype=np.uint32))
            self._parts.append((mi.ShapePtr(shapes[part.name]), len(part.vertices), faces, mi.Color3f(light)))
            start = end

    def __call__(self, pi, si, number):
        """Whether the place is skin, and its irradiance in bake ``number``."""
        skin = si.is_valid() & (si.shape == self._chart)
        light = self._on_chart(si.uv, number, skin)
        for shape, count, faces, values in self._parts:
            here = si.is_valid() & (si.shape == shape)
            light = dr.select(here, self._on_part(pi, count, faces, values, number, here), light)
            skin |= here
        return skin, light

    def _on_chart(self, uv, number, active):
        size = self._size
        at = uv * size - 0.5
        low = dr.floor(at)
        weight = at - low
        total = mi.Color3f(0)
        for dx in (0, 1):
            for dy in (0, 1):
                x, y = (mi.UInt32(dr.clip(low[i] + d, 0, size - 1)) for i, d in ((0, dx), (1, dy)))
                corner_weight = (weight.x if dx else 1 - weight.x) * (weight.y if dy else 1 - weight.y)
                total += corner_weight * dr.gather(mi.Color3f, self._texels, (number * size + y) * size + x, active)
        return total

    @staticmethod
    def _on_part(pi, count, faces, values, number, active):
        corner = [dr.gather(mi.UInt32, faces, 3 * pi.prim_index + k, active) + number * count for k in range(3)]
        a, b, c = (dr.gather(mi.Color3f, values, k, active) for k in corner)
        u, v = pi.prim_uv
        return a * (1 - u - v) + b * u + c * v

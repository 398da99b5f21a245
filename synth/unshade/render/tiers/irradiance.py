"""Irradiance at points of the skin, with interreflection, by path tracing.

What light does between two places of the surface is that of the opaque tier; only the
first reflection is left to the profile.
"""

from __future__ import annotations

import math

import drjit as dr
import mitsuba as mi
import numpy as np

from ..passes import seed_of
from ..scene import LitHead
from ..split import LambertLight
from .surface import SkinPoints

_MAX_LANES = 1 << 21
"""Rays in flight, which bounds memory."""
_PROBES = 16
"""Rays that decide whether a point is shut in."""
CONTACT = 2e-3
"""Metres: nearer surfaces count as touching."""


def bake(
    lit: LitHead, points: SkinPoints, *, bakes: int, samples: int, depth: int, seed: int, progress=None
) -> np.ndarray:
    """Irradiance (M, bakes, 3) f32 of independent bakes with ``samples`` paths each.

    ``depth`` counts path segments from the camera, as in the opaque tier.
    """
    count = len(points.positions)
    step = max(1, _MAX_LANES // (bakes * samples))
    later = mi.load_dict({"type": "path", "max_depth": depth - 1, "rr_depth": 1 << 20, "hide_emitters": True})
    strips = []
    for start in range(0, count, step):
        if progress is not None:
            progress(start, count)
        strips.append(_bake_strip(lit, later, points, slice(start, start + step), bakes, samples, seed_of(seed, start)))
    return np.concatenate(strips)


def shut_in(lit: LitHead, points: SkinPoints, seed: int) -> np.ndarray:
    """(M,) bool: the point lies within another shape (the rim of the lids in the eyeball) or
    touches other skin (the inside of closed lips).

    Most rays from there meet a triangle from behind, or within `CONTACT`. What light comes out
    of the flesh at such a place goes in again opposite, so it has no surface of its own.
    """
    sampler, si, normal = _interactions(points, slice(None), _PROBES, seed)
    wo = mi.Frame3f(normal).to_world(mi.warp.square_to_cosine_hemisphere(sampler.next_2d()))
    hit = lit.dark.ray_intersect(si.spawn_ray(wo))
    stopped = hit.is_valid() & ((dr.dot(hit.n, wo) > 0) | (hit.t < CONTACT))
    return np.array(dr.block_reduce(dr.ReduceOp.Add, mi.Float(stopped), _PROBES)) > _PROBES / 2


def _bake_strip(lit, later, points, part, bakes, samples, seed) -> np.ndarray:
    sampler, si, normal = _interactions(points, part, bakes * samples, seed, samples)
    value = _irradiance(lit, later, sampler, si, normal)
    dr.eval(value)
    sums = [np.array(dr.block_reduce(dr.ReduceOp.Add, value[c], samples)) for c in range(3)]
    return (np.stack(sums, -1).reshape(-1, bakes, 3) / samples).astype(np.float32)


def _interactions(points: SkinPoints, part: slice, repeats: int, seed: int, strata: int | None = None):
    """Sampler, and every point ``repeats`` times with its diffuse normal."""
    positions = points.positions[part]
    lanes = len(positions) * repeats
    sampler = mi.load_dict({"type": "multijitter", "sample_count": strata or repeats})
    sampler.set_samples_per_wavefront(strata or repeats)
    sampler.seed(seed, lanes)
    index = dr.arange(mi.UInt32, lanes) // dr.opaque(mi.UInt32, repeats)
    si = dr.zeros(mi.SurfaceInteraction3f, lanes)
    si.p, si.n, normal = (
        dr.gather(kind, kind(np.ascontiguousarray(table[part].T)), index)
        for kind, table in ((mi.Point3f, points.positions), (mi.Normal3f, points.facing), (mi.Normal3f, points.normals))
    )
    si.sh_frame = mi.Frame3f(si.n)
    return sampler, si, normal


def _irradiance(lit: LitHead, later, sampler, si, normal):
    """One sample of the irradiance for every lane, sampled by the `LambertLight`."""
    scene, way = lit.scene, lit.lambert_light
    total = mi.Color3f(0)
    light, radiance = scene.sample_emitter_direction(si, sampler.next_2d(), True)
    cosine = dr.fmax(dr.dot(normal, light.d), 0)
    ahead = (light.pdf > 0) & (dr.dot(si.n, light.d) > 0)
    if way is not LambertLight.FROM_SURFACE:
        weight = _mis(light.pdf, cosine * dr.inv_pi) if way is LambertLight.BLEND else mi.Float(1)
        total += dr.select(ahead, radiance * cosine * weight, 0)
    wo = mi.Frame3f(normal).to_world(mi.warp.square_to_cosine_hemisphere(sampler.next_2d()))
    ray = si.spawn_ray(wo)
    ahead = dr.dot(si.n, wo) > 0
    if way is not LambertLight.TOWARDS_LIGHT:
        hit = scene.ray_intersect(ray, ahead)
        towards = mi.DirectionSample3f(scene, hit, si)
        met = towards.emitter.eval(hit, ahead)
        weight = mi.Float(1)
        if way is LambertLight.BLEND:
            weight = _mis(dr.dot(normal, wo) * dr.inv_pi, scene.pdf_emitter_direction(si, towards, ahead))
        total += dr.select(ahead, met * weight * math.pi, 0)
    reflected, _, _ = later.sample(scene, sampler, mi.RayDifferential3f(ray), None, ahead)
    return total + dr.select(ahead, mi.Color3f(reflected) * math.pi, 0)


def _mis(pdf, other):
    """Power heuristic (Veach 1995)."""
    a, b = pdf * pdf, other * other
    return dr.select(a > 0, a / dr.select(a > 0, a + b, 1), 0)

"""Path tracing that splits every picture into its diffuse and specular layer.

The split is taken at the first surface: a path belongs to the diffuse layer by the share
that the Lambert term has in its first scattering, with all interreflection behind it. It
is what cross- and parallel-polarised photographs separate, without their noise; the
layers add up to the picture in one pass.
"""

from __future__ import annotations

from enum import Enum

import drjit as dr
import mitsuba as mi


def _fraction(part, whole):
    """part / whole, 0 to 1 whatever the rounding."""
    return dr.select(whole > 0, dr.fmin(part / dr.select(whole > 0, whole, 1), 1), 0)


def _mis(pdf, other):
    """Power heuristic (Veach 1995)."""
    a, b = pdf * pdf, other * other
    return dr.select(a > 0, a / dr.select(a > 0, a + b, 1), 0)


def _lambert_weight(lambert_light, blend, towards_light, from_surface):
    """The weight of one way of sampling, given its weight in each case."""
    if lambert_light is LambertLight.BLEND:
        return blend
    return mi.Float(towards_light if lambert_light is LambertLight.TOWARDS_LIGHT else from_surface)


class LambertLight(Enum):
    """How light that arrives directly at the Lambert term of the first surface is sampled.

    Either way of sampling alone is right, and so is any blend. The choice that suits the light best
    halves the noise: specular light and bounces always use the blend.
    """

    TOWARDS_LIGHT = 1
    """Compact lights: a direction from the cosine lobe would rarely meet them."""
    BLEND = 2
    """Both, weighed by the power heuristic: environment maps."""
    FROM_SURFACE = 3
    """Even radiance from all directions: only its occlusion is left to chance."""


@dr.syntax
def split_radiance(scene, head, sampler, ray, max_depth, lambert_light):
    """Diffuse and specular radiance (linear RGB) along camera rays.

    ``head`` holds the shapes of ``scene`` without its emitters: cameras look through
    lights, and see black where there is no head. ``max_depth`` counts path segments as
    Mitsuba's ``path`` does (2 is direct light only). ``lambert_light`` is a `LambertLight`.
    """
    everything = mi.BSDFContext()
    lambert = mi.BSDFContext()
    lambert.type_mask = +mi.BSDFFlags.DiffuseReflection
    pi = head.ray_intersect_preliminary(ray, coherent=True)
    active = pi.is_valid()
    ray = mi.Ray3f(ray)
    depth = mi.UInt32(0)
    throughput, diffuse_fraction = mi.Color3f(1), mi.Color3f(1)
    diffuse, specular = mi.Color3f(0), mi.Color3f(0)
    previous = dr.zeros(mi.Interaction3f)
    previous_pdf = mi.Float(1)
    while active:
        si = pi.compute_surface_interaction(ray, +mi.RayFlags.All, active)
        # An emitter met by the last scattering, weighed against sampling it directly.
        towards = mi.DirectionSample3f(scene, si, previous)
        later = active & (depth > 0)
        weight = _mis(previous_pdf, scene.pdf_emitter_direction(previous, towards, later))
        lambert_weight = dr.select(depth == 1, _lambert_weight(lambert_light, weight, 0, 1), weight)
        met = dr.select(later, throughput * towards.emitter.eval(si, later), 0)
        diffuse += diffuse_fraction * met * lambert_weight
        specular += (1 - diffuse_fraction) * met * weight

        following = active & si.is_valid() & (depth + 1 < max_depth)
        bsdf = si.bsdf(ray)
        light, radiance = scene.sample_emitter_direction(si, sampler.next_2d(), True, following)
        lit = following & (light.pdf > 0)
        wo = si.to_local(light.d)
        value, pdf, scattered, albedo = bsdf.eval_pdf_sample(
            everything, si, wo, sampler.next_1d(), sampler.next_2d(), following
        )
        at_first = following & (depth == 0)
        direct_fraction = dr.select(at_first, _fraction(bsdf.eval(lambert, si, wo, at_first), value), diffuse_fraction)
        weight = _mis(light.pdf, pdf)
        lambert_weight = dr.select(depth == 0, _lambert_weight(lambert_light, weight, 1, 0), weight)
        direct = dr.select(lit, throughput * value * radiance, 0)
        diffuse += direct_fraction * direct * lambert_weight
        specular += (1 - direct_fraction) * direct * weight

        scattered_lambert = bsdf.eval(lambert, si, scattered.wo, at_first)
        diffuse_fraction = dr.select(at_first, _fraction(scattered_lambert, albedo * scattered.pdf), diffuse_fraction)
        throughput = throughput * albedo
        previous = mi.Interaction3f(si)
        previous_pdf = scattered.pdf
        active = following & (dr.max(throughput) > 0)
        ray = si.spawn_ray(si.to_world(scattered.wo))
        pi = scene.ray_intersect_preliminary(ray, coherent=False, active=active)
        depth += 1
    return diffuse, specular

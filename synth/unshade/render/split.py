"""Path tracing that splits every picture into its diffuse and specular layer.

The split is taken at the first surface: a path belongs to the diffuse layer by the share
that the Lambert term has in its first scattering, with all interreflection behind it. It
is what cross- and parallel-polarised photographs separate, without their noise; the
layers add up to the picture in one pass.
"""

from __future__ import annotations

import drjit as dr
import mitsuba as mi


def _ratio(part, whole):
    return dr.select(whole > 0, part / dr.select(whole > 0, whole, 1), 0)


def _mis(pdf, other):
    """Power heuristic (Veach 1995)."""
    a, b = pdf * pdf, other * other
    return dr.select(a > 0, a / dr.select(a > 0, a + b, 1), 0)


@dr.syntax
def split_radiance(scene, head, sampler, ray, max_depth):
    """Diffuse and specular radiance (linear RGB) along camera rays.

    ``head`` holds the shapes of ``scene`` without its emitters: cameras look through
    lights, and see black where there is no head. ``max_depth`` counts path segments as
    Mitsuba's ``path`` does (2 is direct light only).
    """
    everything = mi.BSDFContext()
    lambert = mi.BSDFContext()
    lambert.type_mask = +mi.BSDFFlags.DiffuseReflection
    first = head.ray_intersect_preliminary(ray, coherent=True)
    active = first.is_valid()
    pi = first
    ray = mi.Ray3f(ray)
    depth = mi.UInt32(0)
    throughput, share = mi.Color3f(1), mi.Color3f(1)
    diffuse, specular = mi.Color3f(0), mi.Color3f(0)
    previous = dr.zeros(mi.Interaction3f)
    previous_pdf = mi.Float(1)
    while active:
        si = pi.compute_surface_interaction(ray, +mi.RayFlags.All, active)
        # An emitter met by the last scattering, weighed against sampling it directly.
        towards = mi.DirectionSample3f(scene, si, previous)
        later = active & (depth > 0)
        weight = _mis(previous_pdf, scene.pdf_emitter_direction(previous, towards, later))
        met = dr.select(later, throughput * towards.emitter.eval(si, later) * weight, 0)
        diffuse += share * met
        specular += (1 - share) * met

        following = active & si.is_valid() & (depth + 1 < max_depth)
        bsdf = si.bsdf(ray)
        light, radiance = scene.sample_emitter_direction(si, sampler.next_2d(), True, following)
        lit = following & (light.pdf > 0)
        wo = si.to_local(light.d)
        value, pdf, scattered, weight = bsdf.eval_pdf_sample(
            everything, si, wo, sampler.next_1d(), sampler.next_2d(), following
        )
        at_first = following & (depth == 0)
        light_share = dr.select(
            at_first, _ratio(bsdf.eval(lambert, si, wo, at_first), value), share
        )
        direct = dr.select(lit, throughput * value * radiance * _mis(light.pdf, pdf), 0)
        diffuse += light_share * direct
        specular += (1 - light_share) * direct

        scattered_lambert = bsdf.eval(lambert, si, scattered.wo, at_first)
        share = dr.select(at_first, _ratio(scattered_lambert, weight * scattered.pdf), share)
        throughput = throughput * weight
        previous = mi.Interaction3f(si)
        previous_pdf = scattered.pdf
        active = following & (dr.max(throughput) > 0)
        ray = si.spawn_ray(si.to_world(scattered.wo))
        pi = scene.ray_intersect_preliminary(ray, coherent=False, active=active)
        depth += 1
    return diffuse, specular

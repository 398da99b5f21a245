"""The split path tracer for ``scalar_rgb``: the same estimator, one path at a time.

`split.split_radiance` masks what does not apply; without a compiler there is nothing to
call then, so this one branches.
"""

from __future__ import annotations

import mitsuba as mi
import numpy as np

from .split import LambertLight


def split_radiance_scalar(scene, head, sampler, ray, max_depth: int, lambert_light: LambertLight) -> np.ndarray:
    """Diffuse and specular radiance [2, 3] along one camera ray."""
    everything, lambert = mi.BSDFContext(), mi.BSDFContext()
    lambert.type_mask = +mi.BSDFFlags.DiffuseReflection
    layers = np.zeros((2, 3))
    throughput, diffuse_fraction = np.ones(3), np.ones(3)
    si = head.ray_intersect(ray)
    if not si.is_valid():
        return layers
    for depth in range(max_depth - 1):
        bsdf = si.bsdf(ray)
        light, radiance = scene.sample_emitter_direction(si, sampler.next_2d(), True)
        wo = si.to_local(light.d)
        value, pdf, scattered, albedo = bsdf.eval_pdf_sample(everything, si, wo, sampler.next_1d(), sampler.next_2d())
        value, albedo = np.array(value), np.array(albedo)
        if light.pdf > 0:
            direct_fraction = _fraction(bsdf.eval(lambert, si, wo), value) if depth == 0 else diffuse_fraction
            direct = throughput * value * np.array(radiance)
            layers += _weighed(direct, direct_fraction, _mis(light.pdf, pdf), depth, lambert_light, 1, 0)
        if depth == 0:
            diffuse_fraction = _fraction(bsdf.eval(lambert, si, scattered.wo), albedo * scattered.pdf)
        throughput = throughput * albedo
        if throughput.max() <= 0:
            break
        previous = mi.Interaction3f(si)
        ray = si.spawn_ray(si.to_world(scattered.wo))
        si = scene.ray_intersect(ray)
        emitter = si.emitter(scene)
        if emitter is not None:
            towards = mi.DirectionSample3f(scene, si, previous)
            weight = _mis(scattered.pdf, scene.pdf_emitter_direction(previous, towards))
            met = throughput * np.array(emitter.eval(si))
            layers += _weighed(met, diffuse_fraction, weight, depth, lambert_light, 0, 1)
        if not si.is_valid():
            break
    return layers


def _weighed(light, diffuse_fraction, blend, depth, lambert_light, towards_light, from_surface) -> np.ndarray:
    """Layers of some light at a vertex, weighted as for its Lambert term."""
    weight = blend
    if depth == 0 and lambert_light is not LambertLight.BLEND:
        weight = towards_light if lambert_light is LambertLight.TOWARDS_LIGHT else from_surface
    return np.stack([diffuse_fraction * light * weight, (1 - diffuse_fraction) * light * blend])


def _fraction(part, whole: np.ndarray) -> np.ndarray:
    part = np.array(part)
    return np.divide(part, whole, out=np.zeros(3), where=whole > 0).clip(0, 1)


def _mis(pdf: float, other: float) -> float:
    return pdf * pdf / (pdf * pdf + other * other) if pdf > 0 else 0.0

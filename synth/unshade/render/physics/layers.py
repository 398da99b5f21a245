"""Diffuse and specular layer add up to the picture, and each is the picture of its term.

The sum is compared pixel by pixel and without noise: a plain path tracer without
layers follows the same paths with the same random numbers, so only rounding may differ.
The terms are compared with skins that have one term only, by pooled z-tests.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import drjit as dr
import mitsuba as mi
import numpy as np
from scipy.ndimage import binary_erosion

from ..passes import render_layers
from ..probes import view_through_centres
from ..split import LambertLight, split_radiance
from . import specimen
from .noise import lights
from .statistics import Comparison, Estimate
from .verdict import Verdict

ROUNDING = 2e-5
"""Largest relative difference of a pixel's sum: sums of single precision in another order."""

_SUSPECT = "render/split.py: the share of the Lambert term"
_DEPTH = 5
_RUNS = 13
_TERM_SAMPLES = 64


def check_layers(samples: int = 64, split: Callable = split_radiance, render: Callable = render_layers) -> Verdict:
    """Compares sums and terms. ``split`` replaces the tracer of the sums, ``render`` that of the terms."""
    head = specimen.head()
    error = _sum_error(head, samples, split)
    if not error < ROUNDING:
        return Verdict("layers", False, f"a pixel's layers miss its total by {error:.1e} (relative)", _SUSPECT)
    faults, biases = [], []
    for layer, z, bias, power in _terms(head, render):
        biases.append(f"{layer} {100 * bias:+.2f} % (1 % found with chance {power:.3f})")
        # 3.7 sigma: 2e-4 a term.
        if abs(z) > 3.7:
            faults.append(f"the {layer} layer is not that of its term alone, z = {z:+.1f}")
        if power < 0.99:
            faults.append(f"the {layer} layer is too noisy to conclude")
    found = f"every pixel's layers add up within {error:.1e}; against each term alone: {', '.join(biases)}"
    return Verdict("layers", not faults, "; ".join([*faults, found]), _SUSPECT)


def _sum_error(head, samples: int, split: Callable) -> float:
    """Largest relative difference between a pixel's layers and the plain tracer's radiance."""
    camera = specimen.camera()
    lit = head.lit(lights()["sky"])

    def picture(trace: Callable) -> np.ndarray:
        sensor = camera.sensor(samples)
        lanes = camera.width * camera.height * samples
        sampler = mi.load_dict({"type": "independent"})
        sampler.seed(5, lanes)
        index = dr.arange(mi.UInt32, lanes) // samples
        corner = mi.Point2f(mi.Float(index % camera.width), mi.Float(index // camera.width))
        size = mi.Vector2f(camera.width, camera.height)
        ray, _ = sensor.sample_ray(0.0, 0.5, (corner + sampler.next_2d()) / size, mi.Point2f(0.5))
        radiance = trace(sampler, ray)
        channels = [
            dr.block_reduce(dr.ReduceOp.Add, channel, samples) for channel in (radiance.x, radiance.y, radiance.z)
        ]
        return np.stack([np.array(channel, float) for channel in channels], -1)

    def layered(sampler, ray):
        diffuse, specular = split(lit.scene, lit.dark, sampler, ray, mi.UInt32(_DEPTH), LambertLight.BLEND)
        return diffuse + specular

    ours = picture(layered)
    theirs = picture(lambda sampler, ray: _plain_radiance(lit.scene, lit.dark, sampler, ray, mi.UInt32(_DEPTH)))
    return float((np.abs(ours - theirs) / np.maximum(theirs, 1e-3 * theirs.max())).max())


@dr.syntax
def _plain_radiance(scene, head, sampler, ray, max_depth):
    """Path tracing with next-event estimation and the power heuristic, without layers."""
    context = mi.BSDFContext()
    si = head.ray_intersect(ray)
    active = si.is_valid()
    ray = mi.Ray3f(ray)
    depth = mi.UInt32(0)
    throughput, radiance = mi.Color3f(1), mi.Color3f(0)
    previous = dr.zeros(mi.Interaction3f)
    previous_pdf = mi.Float(1)
    while active:
        towards = mi.DirectionSample3f(scene, si, previous)
        later = active & (depth > 0)
        other = scene.pdf_emitter_direction(previous, towards, later)
        met = later & (previous_pdf > 0)
        radiance += dr.select(met, throughput * towards.emitter.eval(si, later) * _heuristic(previous_pdf, other), 0)

        following = active & si.is_valid() & (depth + 1 < max_depth)
        bsdf = si.bsdf(ray)
        light, arriving = scene.sample_emitter_direction(si, sampler.next_2d(), True, following)
        wo = si.to_local(light.d)
        lit = following & (light.pdf > 0)
        value, pdf = bsdf.eval_pdf(context, si, wo, lit)
        radiance += dr.select(lit, throughput * value * arriving * _heuristic(light.pdf, pdf), 0)
        scattered, weight = bsdf.sample(context, si, sampler.next_1d(), sampler.next_2d(), following)
        throughput = throughput * weight
        previous, previous_pdf = mi.Interaction3f(si), scattered.pdf
        active = following & (dr.max(throughput) > 0)
        ray = si.spawn_ray(si.to_world(scattered.wo))
        si = scene.ray_intersect(ray, active)
        depth += 1
    return radiance


def _heuristic(pdf, other):
    return pdf * pdf / dr.fmax(pdf * pdf + other * other, 1e-30)


def _terms(head, render: Callable):
    """Layer, pooled z, relative bias and power to find 1 % against a skin with that term only.

    Compares direct light, since bounces mix the terms, inside the chart.
    """
    camera, light = specimen.camera(), lights()["dome"]
    maps = specimen.varied_maps()
    alone = {
        "diffuse": dataclasses.replace(maps, specular_albedo=None),
        "specular": dataclasses.replace(maps, diffuse_albedo=np.zeros((2, 2, 3), np.float32)),
    }
    inside = binary_erosion(view_through_centres(head, camera).mask)

    def runs(scene, first_seed: int):
        lit = scene.lit(light)
        sensor = camera.sensor(_TERM_SAMPLES)
        return [render(lit, sensor, samples=_TERM_SAMPLES, depth=2, seed=first_seed + k) for k in range(_RUNS)]

    both = runs(head, 0)
    for number, (layer, term) in enumerate(alone.items()):
        ours = Estimate.of_runs([getattr(run, layer) for run in both])
        theirs = Estimate.of_runs([run.total for run in runs(specimen.head(term), 100 * (number + 1))])
        comparison = Comparison(ours, theirs, inside)
        yield layer, comparison.pooled, comparison.bias, comparison.pooled_power(0.01)

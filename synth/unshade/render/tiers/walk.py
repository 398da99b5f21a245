"""Random walks through the flesh: exact transport in a medium without a refractive boundary.

The extinction is the same everywhere and grey within a channel, so free paths are drawn
exactly; the single-scattering albedo varies from place to place, and scattering is
isotropic. A walk follows one channel; a lane walks for red, then green, then blue from the
place where its camera ray met the skin. Light outside the head travels on, enters it again
elsewhere, or is reflected by what is opaque (the eyes): interreflection without end.
"""

from __future__ import annotations

import drjit as dr
import mitsuba as mi

from ..split import LambertLight
from .profile import HIGHEST_ALBEDO

_MAX_STEPS = 4096
"""Flights of a lane, which Russian roulette ends long before."""
_ROULETTE_BELOW = 0.25
"""Weight below which a walk may end: light that has lost most of itself."""
_MAX_CROSSINGS = 16
_LIFT = 1e-6
"""Metres between a surface and the rays that leave it. Mitsuba's own 0.09 mm (in a scene of
metres) would be a tenth of a free path: a loss of ten percent in dark skin."""
_DARK = 1e-5
"""Transmittance that counts as none."""


def single_scattering(albedo):
    """`profile.single_scattering` of a channel, here for lanes."""
    c = dr.clip(albedo, 0, HIGHEST_ALBEDO)
    root = 4.09712 + 4.20863 * c - dr.sqrt(9.59217 + 41.6808 * c + 17.7126 * c * c)
    return 1 - root * root


@dr.syntax
def walk(scene, body, medium, extinction, sampler, start, direction, active, way):
    """Radiance (linear RGB) that leaves the skin at ``start`` (interaction) against ``direction``.

    ``scene`` holds the closed ``body``, opaque shapes and emitters; ``medium`` is an
    `AlbedoGrid`; ``extinction`` holds 1/m per channel; ``way`` is a `LambertLight`: which of
    scattering and emitter sampling finds the light.
    """
    total = mi.Color3f(0)
    channel = dr.select(active, mi.UInt32(0), mi.UInt32(3))
    entry = _beyond(start, direction)
    ray = mi.Ray3f(entry)
    inside, scattered = mi.Bool(True), mi.Bool(False)
    weight, density = mi.Float(1), mi.Float(0)
    previous = dr.zeros(mi.Interaction3f)
    steps = mi.UInt32(0)
    while (channel < 3) & (steps < _MAX_STEPS):
        sigma = _pick(extinction, channel)
        si = scene.ray_intersect(ray)
        flight = dr.select(inside, -dr.log(1 - sampler.next_1d()) / sigma, dr.inf)
        collided = flight < si.t
        wall = ~collided & si.is_valid() & (si.shape == body)
        leaving = dr.dot(si.n, ray.d) > 0
        # Caps and gaps: a side that cannot be met from where the walk is swallows it.
        lost = (wall & (leaving != inside)) | (~collided & ~si.is_valid() & inside)
        crossing = wall & ~lost
        opaque = ~collided & si.is_valid() & ~wall

        # Light that the last scattering ran into.
        if dr.hint(way is not LambertLight.TOWARDS_LIGHT, mode="scalar"):
            towards = mi.DirectionSample3f(scene, si, previous)
            met = ~collided & ~wall & ~inside & scattered
            emitted = _pick(towards.emitter.eval(si, met), channel)
            mis_weight = mi.Float(1)
            if dr.hint(way is LambertLight.BLEND, mode="scalar"):
                mis_weight = _mis(density, scene.pdf_emitter_direction(previous, towards, met))
            total += _only(channel, dr.select(met, weight * emitted * mis_weight, 0))

        place = dr.select(collided, ray(flight), si.p)
        facing = mi.Normal3f(dr.select(leaving, -si.n, si.n))
        reflectance = _pick(si.bsdf(ray).eval_diffuse_reflectance(si, opaque), channel)
        kept = dr.select(collided, single_scattering(_pick(medium.albedo(place), channel)), reflectance)
        turns = collided | opaque
        weight = dr.select(turns, weight * kept, weight)
        vertex = mi.Interaction3f(si)
        vertex.p = place
        vertex.n = dr.select(collided, mi.Normal3f(0), facing)

        if dr.hint(way is not LambertLight.FROM_SURFACE, mode="scalar"):
            light, radiance = scene.sample_emitter_direction(vertex, sampler.next_2d(), False, turns)
            lobe = dr.select(collided, mi.Float(dr.inv_four_pi), dr.fmax(dr.dot(facing, light.d), 0) * dr.inv_pi)
            mis_weight = mi.Float(1)
            if dr.hint(way is LambertLight.BLEND, mode="scalar"):
                mis_weight = _mis(light.pdf, lobe)
            reached = turns & (light.pdf > 0) & (lobe > 0)
            through = _transmittance(scene, body, sigma, vertex, light, inside, reached)
            total += _only(
                channel, dr.select(reached, weight * lobe * _pick(radiance, channel) * mis_weight * through, 0)
            )

        sphere = mi.warp.square_to_uniform_sphere(sampler.next_2d())
        # Uniform on the sphere about the tip of the normal: cosine-distributed.
        onward = dr.select(collided, sphere, dr.normalize(sphere + facing * 1.0001))
        density = dr.select(
            turns, dr.select(collided, mi.Float(dr.inv_four_pi), dr.dot(facing, onward) * dr.inv_pi), density
        )
        previous = dr.select(turns, vertex, previous)
        scattered |= turns
        ray = dr.select(turns, _from(vertex, onward), _beyond(si, ray.d))
        inside = dr.select(crossing, ~inside, inside)

        # Russian roulette, then the walk of the next channel.
        survival = dr.select(weight < _ROULETTE_BELOW, weight / _ROULETTE_BELOW, 1)
        ended = lost | (~turns & ~crossing) | (sampler.next_1d() >= survival)
        weight = dr.select(ended, 1, weight / survival)
        channel = dr.select(ended, channel + 1, channel)
        ray = dr.select(ended, entry, ray)
        inside = ended | inside
        scattered = ~ended & scattered
        steps += 1
    return total


@dr.syntax
def _transmittance(scene, body, sigma, vertex, light, inside, active):
    """Share of the light that comes straight from an emitter through flesh and air."""
    through = dr.select(active, mi.Float(1), mi.Float(0))
    ray = _from(vertex, light.d)
    ray.maxt = light.dist * (1 - 1e-4)
    within = mi.Bool(inside)
    crossings = mi.UInt32(0)
    onward = mi.Bool(active)
    while onward:
        si = scene.ray_intersect(ray, mi.RayFlags.Minimal, False)
        hit = si.is_valid()
        through *= dr.select(within & hit, dr.exp(-sigma * si.t), 1)
        passes = hit & (si.shape == body) & ((dr.dot(si.n, ray.d) > 0) == within)
        onward = passes & (through > _DARK) & (crossings < _MAX_CROSSINGS)
        # A path that ends unhindered in the air has come from the emitter.
        through = dr.select(onward | (~hit & ~within), through, 0)
        within = within ^ passes
        rest = ray.maxt - si.t
        ray = _beyond(si, ray.d)
        ray.maxt = rest
        crossings += 1
    return through


def _from(vertex, direction):
    """A ray from a place in the medium (normal 0) or on an opaque surface (its normal)."""
    return mi.Ray3f(vertex.p + _LIFT * mi.Vector3f(vertex.n), direction)


def _beyond(si, direction):
    """The ray that goes on through the surface it has met."""
    return mi.Ray3f(si.p + _LIFT * dr.sign(dr.dot(si.n, direction)) * mi.Vector3f(si.n), direction)


def _pick(colour, channel):
    return dr.select(channel == 0, colour[0], dr.select(channel == 1, colour[1], colour[2]))


def _only(channel, value):
    return mi.Color3f(*(dr.select(channel == k, value, 0) for k in range(3)))


def _mis(pdf, other):
    """Power heuristic (Veach 1995)."""
    a, b = pdf * pdf, other * other
    return dr.select(a > 0, a / dr.select(a > 0, a + b, 1), 0)

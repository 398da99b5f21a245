"""Tier ``volume``: light walks through a medium that fills the closed head.

The medium has the mean free path of the scene, and at every place the single-scattering
albedo that makes a half space of it show the albedo of the nearest skin. It knows the mesh
alone: relief that exists only as a normal map shades the specular layer, not this one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

from ...scene_file import Render
from ..scene import HeadScene, LitHead
from ..split import split_radiance
from .albedo_grid import AlbedoGrid
from .body import close
from .surface import Mesh, SkinPoints, scattering_parts
from .walk import walk


@dataclass(frozen=True)
class Flesh:
    """The closed head: its ``surface`` in Mitsuba, the opaque shapes within, its albedo.

    ``skin`` are the shapes of the head's own scenes that the surface stands for.
    """

    surface: Any
    opaque: list
    albedo: AlbedoGrid
    skin: list

    @classmethod
    def of(cls, head: HeadScene) -> Flesh:
        skin = [head.chart, *scattering_parts(head)]
        names = {shape.id() for shape in skin}
        points = SkinPoints.of(head)
        body = close([Mesh.of(shape) for shape in skin])
        opaque = sorted((s for s in head.dark.shapes() if s.id() not in names), key=lambda s: s.id())
        return cls(_closed_mesh(body), opaque, AlbedoGrid.of(points, points.albedo(head)), skin)


def estimator(flesh: Flesh, lit: LitHead, render: Render):
    """Function of sampler, ray and pass that gives the layers of `passes.render_estimate`."""
    scene = _scene(flesh, lit)
    surface = mi.ShapePtr(flesh.surface)
    skin_shapes = [mi.ShapePtr(shape) for shape in flesh.skin]
    extinction = [dr.opaque(mi.Float, 1e3 / path) for path in render.subsurface_mm]

    def estimate(sampler, ray, number):
        diffuse, specular = split_radiance(
            lit.scene, lit.dark, sampler, ray, dr.opaque(mi.UInt32, render.depth), lit.lambert_light
        )
        si = lit.dark.ray_intersect(ray)
        skin = mi.Bool(False)
        for shape in skin_shapes:
            skin |= si.shape == shape
        skin &= si.is_valid()
        seen = skin & (dr.dot(si.n, ray.d) < 0)
        under = walk(scene, surface, flesh.albedo, extinction, sampler, si, ray.d, seen, lit.lambert_light)
        return dr.select(skin, under, diffuse), specular

    return estimate


def _scene(flesh: Flesh, lit: LitHead):
    """The closed head in the light of ``lit``."""
    shapes = {"body": flesh.surface} | {shape.id(): shape for shape in flesh.opaque}
    lights = {}
    for number, emitter in enumerate(lit.scene.emitters()):
        shape = emitter.get_shape()
        lights[f"light{number}"] = emitter if shape is None else shape
    return mi.load_dict({"type": "scene", **shapes, **lights})


def _closed_mesh(body):
    properties = mi.Properties()
    # Never evaluated: light passes as if there were no surface.
    properties["bsdf"] = mi.load_dict({"type": "diffuse"})
    mesh = mi.Mesh("body", len(body.vertices), len(body.triangles), props=properties)
    parameters = mi.traverse(mesh)
    parameters["vertex_positions"] = np.ascontiguousarray(body.vertices, dtype=np.float32).ravel()
    parameters["faces"] = np.ascontiguousarray(body.triangles, dtype=np.uint32).ravel()
    parameters.update()
    return mesh

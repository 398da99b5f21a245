"""One point of skin, to be asked for values, densities and samples without a scene."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

from ...vectors import unit
from ..skin_bsdf import LOBE_ALPHAS, LOBE_WEIGHTS

PARTS = {
    "all": None,
    "diffuse": +mi.BSDFFlags.DiffuseReflection,
    "specular": +mi.BSDFFlags.GlossyReflection,
}
"""Parts of the material that a context can select."""

NORMALS = {
    "mesh": ((0.0, 0.0, 1.0), (0.0, 0.0, 1.0)),
    "tilted diffuse": ((0.3, -0.2, 1.0), (0.0, 0.0, 1.0)),
    "tilted specular": ((0.0, 0.0, 1.0), (-0.5, 0.4, 1.0)),
    "both tilted": ((0.1, -0.1, 1.0), (0.3, 0.2, 1.0)),
}
"""Diffuse and specular normal, unnormalised, over a mesh whose normal is +z."""

ROUGHNESS = {
    "standard": (*LOBE_ALPHAS, LOBE_WEIGHTS[0]),
    "wet": (0.06, 0.06, 0.5),
    "oily": (0.1, 0.22, 0.8),
    "dry": (0.3, 0.6, 0.25),
}
"""GGX alpha of lobe 1, of lobe 2, share of lobe 1."""

Alter = Callable[[mi.BSDF], mi.BSDF]
"""Puts another material, or one with a fault, in the place of the one under test."""


def unaltered(bsdf: mi.BSDF) -> mi.BSDF:
    return bsdf


@dataclass(frozen=True)
class Skin:
    """The constants of a patch of skin; names index `NORMALS` and `ROUGHNESS`."""

    normals: str = "mesh"
    roughness: str | None = None
    """None: the material without a roughness texture."""
    diffuse: float = 0.5
    specular: float = 0.04

    @property
    def diffuse_normal(self) -> np.ndarray:
        return _unit(NORMALS[self.normals][0])

    @property
    def specular_normal(self) -> np.ndarray:
        return _unit(NORMALS[self.normals][1])

    @property
    def lobes(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """GGX alpha and weight of each lobe."""
        first, second, weight = ROUGHNESS[self.roughness or "standard"]
        return (first, weight), (second, 1 - weight)

    def bsdf(self) -> mi.BSDF:
        plugin = {
            "type": "skin",
            "diffuse": constant([self.diffuse] * 3),
            "specular": constant([self.specular]),
            "diffuse_normal": constant(self.diffuse_normal),
            "specular_normal": constant(self.specular_normal),
        }
        if self.roughness:
            plugin["roughness"] = constant(ROUGHNESS[self.roughness])
        return mi.load_dict(plugin)


def context(part: str) -> mi.BSDFContext:
    ctx = mi.BSDFContext()
    if PARTS[part] is not None:
        ctx.type_mask = PARTS[part]
    return ctx


def interaction(wi, count: int, u: float = 0.5):
    """``count`` times the same point, seen from ``wi`` in the mesh's frame (z is its normal), at (``u``, 0.5) of the UV."""
    si = dr.zeros(mi.SurfaceInteraction3f, count)
    si.wi = wi
    si.uv = mi.Point2f(u, 0.5)
    si.n = mi.Normal3f(0, 0, 1)
    si.sh_frame = mi.Frame3f(*(mi.Vector3f(*axis) for axis in np.eye(3).tolist()))
    return si


def direction(theta_degrees: float, phi_degrees: float) -> np.ndarray:
    """Unit vector [3] at an angle from the mesh's normal."""
    theta, phi = np.radians([theta_degrees, phi_degrees])
    return np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])


def vectors(directions: np.ndarray):
    """Mitsuba's vectors of an array [3] or [N, 3]."""
    if directions.ndim == 1:
        return mi.Vector3f(*map(float, directions))
    return mi.Vector3f(*(mi.Float(np.ascontiguousarray(axis, np.float32)) for axis in directions.T))


def hemisphere(rng: np.random.Generator, count: int) -> np.ndarray:
    """Directions [count, 3] above the mesh, at least 3 degrees or so from grazing."""
    v = rng.standard_normal((count, 3))
    v[:, 2] = np.abs(v[:, 2]) + 0.05
    return unit(v)


def _unit(v) -> np.ndarray:
    return np.array(v) / np.linalg.norm(v)


def constant(values) -> dict[str, Any]:
    """A texture of one value."""
    return bitmap(np.broadcast_to(np.float32(values), (2, 2, np.size(values))))


def bitmap(picture) -> dict[str, Any]:
    """A texture of a picture [H, W, C]."""
    return {"type": "bitmap", "bitmap": mi.Bitmap(np.array(picture, np.float32)), "raw": True}

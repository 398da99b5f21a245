"""A light stage: polarised uniform and gradient illumination (Ma et al. 2007; Ghosh et al. 2011, "Multiview Face
Capture using Polarized Spherical Gradient Illumination"), the gold standard that costs a laboratory.

Controlled: every training view is photographed under the full sphere and three gradients, through polarisers. The
split of the path tracer stands for them: cross-polarised pictures are its diffuse layer, the difference of parallel and
cross is its specular layer, without a camera's noise.
"""

from __future__ import annotations

import numpy as np

from unshade import Capture, Maps

from ..render.lights.conventions import LUMINANCE
from ..render.skin_bsdf import F0
from ..scene_file import Light
from ..scene_file.light import Gradient
from ..vectors import unit
from .harmonics import sky_directions
from .laboratory import Laboratory
from .skin_lobes import everywhere, normal_between
from .texel_samples import TexelSamples, sample_texels

_AXES = "xyz"
_ROWS, _SHADOW_SIZE = 16, 128
"""Rows of the sky, and side of the texture on which the mesh's own shadows are cast."""


def recover(
    capture: Capture, laboratory: Laboratory, *, texture_size: int = 512, shadows: bool = True, samples: int = 512
) -> Maps:
    """Both albedos and both normals, closed form per texel, views weighted by their cosine.

    Under a gradient (1 + w) / 2 along an axis a Lambert surface is 1/2 + n / 3 as bright as under the full sphere, and
    highlights as bright as the gradient where they come from on average. ``shadows``: what the mesh shades itself from,
    and the light that it bounces, are those of the known mesh; without, the surface is taken for convex, as in the
    papers. ``samples`` a pixel: a normal is three times as noisy as the pictures.
    """
    texels = sample_texels(capture, texture_size)
    taken = laboratory.in_lights([_gradient("full"), *(_gradient(axis) for axis in _AXES)], samples)
    diffuse, specular = (
        {name: texels.colours([getattr(shot, layer).astype(float) for shot in shots]) for name, shots in taken.items()}
        for layer in ("diffuse", "specular")
    )
    lit = {name: texels.mean(colours) for name, colours in diffuse.items()}
    grey = np.maximum(lit["full"] @ LUMINANCE, 1e-9)
    ratios = np.stack([lit[axis] @ LUMINANCE / grey for axis in _AXES], -1)
    if shadows:
        even, gradients = _mesh_shading(capture, texels, (0.4, 0.4, 0.4))
        albedo = (lit["full"] / even).clip(0, 1)
        even, gradients = _mesh_shading(capture, texels, np.average(albedo, axis=0, weights=texels.seen))
        albedo = (lit["full"] / even).clip(0, 1)
        normal = texels.normals + 3 * (ratios - gradients)
    else:
        albedo, normal = lit["full"].clip(0, 1), ratios - 0.5
    reflectance, specular_normal = _highlights(texels, specular)
    return Maps(
        diffuse_albedo=texels.filled(albedo),
        specular_albedo=texels.filled(reflectance[:, None])[..., 0],
        diffuse_normal=texels.normals_filled(normal),
        specular_normal=texels.normals_filled(specular_normal),
        coverage=texels.coverage,
    )


def _gradient(axis: str) -> Light:
    return Light(axis, "gradient", settings=Gradient(axis=axis if axis == "full" else f"{axis}+"))


def _highlights(texels: TexelSamples, layers: dict[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Specular albedo (M,) and normals (M, 3) of the specular layers (V, M, 3) in each light."""
    grey = {name: colours.mean(-1) for name, colours in layers.items()}
    whole = np.maximum(grey["full"], 1e-9)
    mean = unit(np.stack([2 * grey[axis] / whole - 1 for axis in _AXES], -1))
    normals = normal_between(texels.to_eye, mean)
    # Slanted skin shows less of it, and noisier.
    weights = texels.weights**3 * (grey["full"] > 1e-5)
    # A highlight that the face itself cuts off points elsewhere, which the mesh shows.
    weights = weights * ((normals * texels.normals).sum(-1) > 0.7)
    normal = texels.mean(normals, weights)
    normal = np.where(weights.sum(0)[:, None] > 0, normal, texels.normals)
    cosine = (texels.to_eye * unit(normal)).sum(-1)
    reflectance = F0 * grey["full"] / np.maximum(everywhere(cosine), 1e-9)
    return texels.mean(reflectance[..., None])[:, 0].clip(0, 0.05), normal


def _mesh_shading(capture: Capture, texels: TexelSamples, bounce_albedo) -> tuple[np.ndarray, np.ndarray]:
    """The mesh's diffuse shading under the full sphere (M, 3), and what shares of it the gradients give (M, 3)."""
    towards = sky_directions(_ROWS)

    def shading(sky: np.ndarray, albedo: float) -> np.ndarray:
        picture = capture.shading(sky, texture_size=_SHADOW_SIZE, bounces=2, bounce_albedo=float(albedo))
        return texels.of_picture(picture.astype(float))

    even = [shading(np.ones_like(towards), albedo) for albedo in np.unique(bounce_albedo)]
    even = dict(zip(np.unique(bounce_albedo), even))
    gradients = shading((1 + towards) / 2, float(np.mean(bounce_albedo)))
    whole = np.mean([even[albedo] for albedo in bounce_albedo], 0)
    return np.stack([even[albedo][:, 0] for albedo in bounce_albedo], -1), gradients / np.maximum(whole, 1e-6)

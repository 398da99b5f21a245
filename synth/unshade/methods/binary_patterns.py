"""Binary patterns of screens (Kampouris et al. 2018, "Diffuse-Specular Separation using Binary Spherical Gradient
Illumination"; on a desk with screens: Lattas et al. 2022, "Practical and Scalable Desktop-based High-Quality Facial
Capture"), without polarisers.

Controlled: every training view is photographed in both halves of the sphere of light along three axes. As described:
the layers are separated by colour within a pair of complementary pictures, since highlights have the colour of the
light and are mostly in one of them; normals are the differences of pairs over their sums; nothing compensates for what
the face shades itself from. Our own, where the descriptions are silent or ask for more: a whole sphere of screens
instead of eight tablets, which is kinder; which part of a highlight falls into either half is that of rough skin on the
normals found so far, from the mesh's; one normal for both layers.
"""

from __future__ import annotations

import numpy as np

from unshade import Capture, Maps

from ..render.skin_bsdf import F0
from ..scene_file import Light
from ..scene_file.light import Pattern
from ..vectors import unit
from .laboratory import Laboratory
from .skin_lobes import everywhere
from .texel_samples import sample_texels

_AXES = "xyz"
_ROUNDS = 4
_MEAN_SPECULAR = 0.028
_PRIOR = 1e-3
"""Weight of skin's mean highlight, over the squared radiance: it decides where the layers have one colour."""
_WIDTH = 0.4
"""Tangent of the half-angle of skin's highlights: nearer than that to the border of two halves, both have a part."""


def recover(capture: Capture, laboratory: Laboratory, *, texture_size: int = 512, samples: int = 256) -> Maps:
    """Both albedos and normals, closed form per texel, views weighted by their cosine; ``samples`` a pixel.

    With D and S the layers in light from everywhere, p the part of the highlight in a half, and n the normal's part
    along its axis, a picture is D (1 + n) / 2 + S p. Pictures less their highlights have one colour within a pair:
    (I+ - S p+) x (I- - S p-) = 0, which is linear in S.
    """
    texels = sample_texels(capture, texture_size)
    taken = laboratory.in_lights([_half(axis + sign) for axis in _AXES for sign in "+-"], samples)
    shown = {name: texels.colours([shot.total.astype(float) for shot in shots]) for name, shots in taken.items()}
    plus, minus = (np.stack([shown[axis + sign] for axis in _AXES]) for sign in "+-")  # axis, view, texel, RGB
    full = (plus + minus).mean(0)

    normal = texels.normals
    for _ in range(_ROUNDS):
        cosine = (texels.to_eye * normal).sum(-1).clip(0.1, 1)
        mirrored = 2 * cosine[..., None] * normal - texels.to_eye
        split = np.moveaxis(mirrored / np.sqrt(mirrored**2 + _WIDTH**2 * (1 - mirrored**2).clip(0)), -1, 0)
        usual = _MEAN_SPECULAR / F0 * everywhere(cosine)
        highlight = _highlight(plus, minus, (1 + split) / 2, usual)
        diffuse = (full - highlight[..., None]).clip(1e-6)
        along = ((plus - minus).mean(-1) - highlight * split) / diffuse.mean(-1)
        normal = unit(texels.mean(np.moveaxis(along, 0, -1)))

    reflectance = texels.mean((F0 * highlight / everywhere(cosine))[..., None]).clip(0, 0.05)
    normals = texels.normals_filled(normal)
    return Maps(
        diffuse_albedo=texels.filled(texels.mean(diffuse).clip(0, 1)),
        specular_albedo=texels.filled(reflectance)[..., 0],
        diffuse_normal=normals,
        specular_normal=normals,
        coverage=texels.coverage,
    )


def _half(axis: str) -> Light:
    return Light(axis, "pattern", settings=Pattern(pattern="half", axis=axis))


def _highlight(plus: np.ndarray, minus: np.ndarray, part: np.ndarray, usual: np.ndarray) -> np.ndarray:
    """S (V, M) by least squares over axes and colours, with a weak prior at ``usual``; ``part`` is p+ by axis."""
    shown = np.cross(plus, minus)
    by_highlight = np.cross(np.ones(3), part[..., None] * minus - (1 - part)[..., None] * plus)
    weight = _PRIOR * (plus + minus).mean(0).mean(-1) ** 2
    both = (shown * by_highlight).sum((0, -1)) + weight * usual
    found = both / ((by_highlight**2).sum((0, -1)) + weight + 1e-12)
    return found.clip(0, (plus + minus).mean(0).min(-1))

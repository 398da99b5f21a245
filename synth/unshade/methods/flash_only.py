"""A flash at the lens, known, in the dark: what a telephone gives (after Riviere, Peers, Ghosh 2014, "Mobile Surface
Reflectometry"). Controlled: every training view is photographed anew, lit by its own flash alone.
"""

from __future__ import annotations

import numpy as np

from unshade import Capture, Maps

from ..render.skin_bsdf import F0
from .laboratory import Laboratory
from .skin_lobes import reflected
from .texel_samples import sample_texels

_INTENSITY = 0.1
"""Radiance times area (m2) of the flash: it gives irradiance over pi of about .3 at a metre. Known, so of no matter."""

_DAMPING = 0.3
"""Damping of the specular unknown towards skin's mean, over the squared largest highlight: texels seen at one angle alone."""

_MEAN_SPECULAR = 0.028


def recover(capture: Capture, laboratory: Laboratory, *, texture_size: int = 512, samples: int = 128) -> Maps:
    """Diffuse and specular albedo, closed form; the mesh's normals.

    At a texel, view and light have one direction and angle t: radiance over irradiance is a + s g(t), with g the
    highlight that skin of unit specular albedo sends straight back. The least squares of four unknowns (RGB and s)
    over the views is solved for all texels at once. Interreflection stays in the albedo. 15 s of processor
    time for ten views of 256 x 256, beside the photographs; 1 GB.
    """
    texels = sample_texels(capture, texture_size)
    colours = texels.colours([picture.astype(float) for picture in laboratory.with_flash(_INTENSITY, samples)])
    cosine = (texels.to_eye * texels.normals).sum(-1).clip(1e-3, 1)
    eyes = np.stack([capture.camera(name)["camera_to_world"][:3, 3].astype(float) for name in capture.train])
    distance2 = ((eyes[:, None] - texels.points) ** 2).sum(-1)
    arriving = _INTENSITY * cosine / np.pi / distance2
    value = colours / arriving[..., None]
    straight = np.stack([np.sqrt(1 - cosine**2), 0 * cosine, cosine], -1)
    back = reflected(straight, straight) / F0 / (cosine / np.pi)

    # Noise of radiance grows with what irradiance is divided by: weights are its square.
    w = texels.weights * cosine
    total = np.maximum(w.sum(0), 1e-12)
    mean_back, mean_value = (w * back).sum(0) / total, texels.mean(value, w)
    spread = (w * (back - mean_back) ** 2).sum(0)
    shared = (w[..., None] * (back - mean_back)[..., None] * (value - mean_value)).sum(0).mean(-1)
    damping = _DAMPING * (back.max() ** 2) * total / len(eyes)
    specular = ((shared + damping * _MEAN_SPECULAR) / (spread + damping)).clip(0, 0.05)
    albedo = (mean_value - (specular * mean_back)[:, None]).clip(0, 1)
    normal = texels.normals_filled()
    return Maps(
        diffuse_albedo=texels.filled(albedo), specular_albedo=texels.filled(specular[:, None])[..., 0],
        diffuse_normal=normal, specular_normal=normal, coverage=texels.coverage,
    )  # fmt: skip

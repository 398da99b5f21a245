"""Denoising: Intel Open Image Denoise on each layer, guided by albedo and normal.

A named option (``[render] denoise = "oidn"``), since detail finer than the noise is then the
denoiser's and not the path tracer's; scores made with it say so. The variance that goes
with a picture stays that of the picture before.
"""

from __future__ import annotations

import importlib.util
from dataclasses import replace

import drjit as dr
import mitsuba as mi
import numpy as np

from ..errors import SceneError
from ..formation.lens import Lens
from . import llvm
from .layers import Layers
from .scene import HeadScene

_GRID = 4
"""Rays along each edge of a pixel that the guides are averaged over."""


def denoised(layers: Layers, head: HeadScene, sensor, lens: Lens | None = None) -> Layers:
    """The picture with less noise, seen through the same ``sensor`` and ``lens``.

    Raises `SceneError` where the denoiser is missing.
    """
    if importlib.util.find_spec("mitsuba_oidn") is None:
        raise SceneError(
            'denoise = "oidn" in [render] needs the Python package mitsuba-oidn; install unshade[denoise], or set denoise = "none"'
        )
    if not dr.is_jit_v(mi.Float):
        raise SceneError(
            f'denoise = "oidn" in [render] needs the variant llvm_ad_rgb; {llvm.FIX}, or set denoise = "none"'
        )
    import mitsuba_oidn

    albedo, normal = _guides(head, sensor, lens)

    def clean(layer: np.ndarray) -> np.ndarray:
        picture = mitsuba_oidn.denoise(
            np.ascontiguousarray(layer), hdr=True, albedo=albedo, normal=normal, clean_aux=True
        )
        # Where no head is seen there is nothing, whatever a network makes of it.
        return np.where(normal.any(-1, keepdims=True), np.array(picture, np.float32).clip(0), 0).astype(np.float32)

    return replace(layers, diffuse=clean(layers.diffuse), specular=clean(layers.specular), half=None)


def _guides(head: HeadScene, sensor, lens: Lens | None) -> tuple[np.ndarray, np.ndarray]:
    """Mean albedo and mesh normal [H, W, 3] of every pixel, 0 where no head is seen."""
    width, height = sensor.film().size()
    fine = np.arange(width * _GRID * height * _GRID)
    column, row = ((axis + 0.5) / _GRID for axis in (fine % (width * _GRID), fine // (width * _GRID)))
    x, y = mi.Float(column.astype(np.float32)), mi.Float(row.astype(np.float32))
    if lens is None:
        ray, _ = sensor.sample_ray(0.0, 0.5, mi.Point2f(x / width, y / height), mi.Point2f(0.5))
    else:
        sampler = sensor.sampler().clone()
        sampler.seed(0, len(fine))
        ray = lens.ray(x, y, sampler)
    si = head.dark.ray_intersect(ray)
    albedo = si.bsdf(ray).eval_diffuse_reflectance(si, si.is_valid())

    def pixels(values) -> np.ndarray:
        seen = np.where(np.array(si.is_valid()), np.array(values), 0)
        blocks = seen.T.reshape(height, _GRID, width, _GRID, 3)
        return np.ascontiguousarray(blocks.mean((1, 3)), dtype=np.float32)

    return pixels(albedo), pixels(si.sh_frame.n)

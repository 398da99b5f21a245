"""Lambert's law in a light of few spherical harmonics, by least squares.

The classic of inverse lighting (Basri and Jacobs 2003, "Lambertian Reflectance and Linear Subspaces"), with the
shadows of the known mesh if wanted (precomputed radiance transfer: Sloan, Kautz, Snyder 2002). Passive: it gets
what every solver gets.
"""

from __future__ import annotations

import numpy as np

from unshade import Capture, Maps

from .harmonics import harmonics, irradiance, sky_directions
from .regions import regions
from .texel_samples import TexelSamples, sample_texels

_ROWS = 16
"""Rows of the environments whose shadowed shading is cast."""

_TRANSFER_SIZE = 64
"""Texels a side on which shadows are cast; shading is smooth, and casting dear."""

_ROUNDS = 20
"""Light and colours of regions in turn; both settle in less."""

_DARKEST = 0.1
"""Least shading, over the largest, that a colour is divided by."""


def recover(
    capture: Capture, *, order: int = 2, shadows: bool = True, texture_size: int = 512
) -> tuple[Maps, np.ndarray]:
    """Diffuse albedo and the mesh's normals, and the light (16, 32, 3). ``order`` 2 to 4 of the harmonics; ``shadows`` by ray casts, one
    bounce of light included. Ten views of 256 x 256 take 7 s of
    processor time and 0.4 GB.

    Light and one colour for each label (or for all) are fitted in turn to the mean colours of the texels; then each
    texel's colour is divided by its shading. The mean shading is taken for grey, and the largest unshadowed
    irradiance of the front for pi, as all lights here have. The fit reweights highlights away, but they
    stays in the albedo.
    """
    if order not in (2, 3, 4):
        raise ValueError(f"order is {order}; write 2, 3 or 4")
    samples = sample_texels(capture, texture_size)
    colour = samples.mean(samples.colours([capture.image(name).astype(float) for name in capture.train]))
    basis = _shadowed(capture, order, samples) if shadows else irradiance(samples.normals, order)
    seen = samples.seen
    light = _light(basis[seen], colour[seen], regions(capture, samples)[seen], samples.weights.sum(0)[seen])

    front = samples.normals[:, 2] > 0
    light *= 1 / (basis[seen] @ light).mean(0)
    open_sky = irradiance(samples.normals[front], order) @ light @ [0.2126, 0.7152, 0.0722]
    largest = float(np.percentile(open_sky, 99))
    shading = np.maximum(basis @ light, _DARKEST * largest) / largest
    albedo = np.clip(colour / shading, 0, 1)
    normal = samples.normals_filled()
    maps = Maps(
        diffuse_albedo=samples.filled(albedo), diffuse_normal=normal, specular_normal=normal, coverage=samples.coverage
    )
    # Harmonics of a low order are negative opposite a strong light; radiance is not.
    return maps, (_sky(order) @ light / largest).clip(0)


def _light(basis: np.ndarray, colour: np.ndarray, region: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Coefficients (K, 3) of a light, and with them a colour for each region, that give texels their colours.

    An L1 fit by reweighting, because highlights and shadows outside the model must not bend the light.
    """
    albedo = np.ones((region.max() + 1, 3)) * np.average(colour, axis=0, weights=weight)
    light = np.zeros((basis.shape[1], 3))
    robust_weight = np.ones_like(colour)
    for _ in range(_ROUNDS):
        for c in range(3):
            w = weight * robust_weight[:, c]
            a = basis * albedo[region, c, None]
            damping = 1e-6 * np.eye(a.shape[1]) * (w @ (a * a)).max()
            light[:, c] = np.linalg.solve((a * w[:, None]).T @ a + damping, (a * w[:, None]).T @ colour[:, c])
            shading = basis @ light[:, c]
            top = np.bincount(region, w * shading * colour[:, c], len(albedo))
            albedo[:, c] = top / np.maximum(np.bincount(region, w * shading**2, len(albedo)), 1e-9)
            residual = np.abs(albedo[region, c] * shading - colour[:, c])
            robust_weight[:, c] = 1 / np.maximum(residual, 0.1 * np.median(residual))
    return light


def _sky(order: int) -> np.ndarray:
    """(16, 32, K): the radiance of each harmonic in the directions of a lat-long environment."""
    return harmonics(sky_directions(_ROWS), order)


def _shadowed(capture: Capture, order: int, samples: TexelSamples) -> np.ndarray:
    """(M, K): the diffuse shading of each harmonic with the shadows and one bounce of the mesh."""
    sky = _sky(order)
    count = sky.shape[-1]
    sky = np.concatenate([sky, np.zeros((*sky.shape[:2], -count % 3))], -1)
    pictures = [
        capture.shading(sky[..., k : k + 3], texture_size=_TRANSFER_SIZE, bounces=1) for k in range(0, sky.shape[-1], 3)
    ]
    return samples.of_picture(np.concatenate(pictures, -1)[..., :count].astype(float))

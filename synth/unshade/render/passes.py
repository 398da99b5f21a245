"""Renders one camera to picture layers with the variance of their mean.

The samples of a pixel are split over independent passes, each stratified in itself; the
spread of the passes gives the variance of the mean that scoring needs for its noise
floor, and the mean of half of them what it needs to leave the noise out. Sums run over
blocks of neighbouring samples, never through atomics, so equal seeds give equal bytes.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from functools import partial

import drjit as dr
import mitsuba as mi
import numpy as np

from ..formation.lens import Lens
from ..scene_file import passes_for
from .layers import Layers
from .scene import LitHead
from .split import split_radiance
from .split_scalar import split_radiance_scalar

_MAX_LANES = 1 << 21
"""Camera rays in flight, which bounds memory to about a gigabyte."""


def seed_of(*parts: object) -> int:
    """A 32-bit seed that depends on every part and nothing else."""
    text = "\0".join(str(part) for part in parts)
    return int.from_bytes(hashlib.blake2b(text.encode(), digest_size=4).digest(), "little")


Estimator = Callable
"""(sampler, ray, number of the pass) to diffuse and specular radiance, linear RGB, in a
variant with a compiler. An estimator can draw its other random numbers anew for every
pass, so that the spread of the passes holds it."""


def render_layers(
    lit: LitHead,
    sensor,
    *,
    samples: int,
    depth: int,
    seed: int,
    lens: Lens | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Layers:
    """Renders ``sensor`` with ``samples`` per pixel in all; ``passes_for`` must allow them.

    With a ``lens``, film, pixels and samples are the sensor's, and the rays the lens's own.
    ``progress`` gets the samples done and in all, before the first and after each band.
    """
    if not dr.is_jit_v(mi.Float):
        return _render_bands(partial(_band_slowly, lit, depth), sensor, samples, seed, lens, progress)

    def split(sampler, ray, number):
        return split_radiance(lit.scene, lit.dark, sampler, ray, dr.opaque(mi.UInt32, depth), lit.lambert_light)

    return render_estimate(split, sensor, samples=samples, seed=seed, lens=lens, progress=progress)


def render_estimate(
    estimator: Estimator,
    sensor,
    *,
    samples: int,
    seed: int,
    lens: Lens | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Layers:
    """The picture that an estimator makes along the rays of `render_layers`."""
    return _render_bands(partial(_band, estimator), sensor, samples, seed, lens, progress)


def _render_bands(band, sensor, samples, seed, lens, progress) -> Layers:
    passes = passes_for(samples)
    width, height = sensor.film().size()
    rows = max(1, _MAX_LANES // (width * samples))
    bands = []
    for top in range(0, height, rows):
        if progress:
            progress(top * width * samples, height * width * samples)
        count = min(rows, height - top)
        bands.append(_layers(band(sensor, lens, samples // passes, passes, seed_of(seed, top), top, count)))
    if progress:
        progress(height * width * samples, height * width * samples)
    diffuse, specular, variance, half = (np.concatenate(parts) for parts in zip(*bands))
    # Passes are independent of one another, so halves of them are; of an odd number none is half.
    return Layers(diffuse, specular, variance, None if passes % 2 else half)


def _layers(means: np.ndarray) -> tuple[np.ndarray, ...]:
    """The fields of `Layers` of some rows, from the means of their passes [rows, width, passes, 6]."""
    passes = means.shape[2]
    mean = means.mean(2).astype(np.float32)
    variance = (means[..., :3] + means[..., 3:]).var(2, ddof=1) / passes
    first = means[:, :, : passes // 2].mean(2)
    half = (first[..., :3] + first[..., 3:]).clip(max=np.finfo(np.float16).max)
    return mean[..., :3], mean[..., 3:], variance.astype(np.float32), half.astype(np.float16)


def _band(estimator, sensor, lens, samples, passes, seed, top, rows) -> np.ndarray:
    """Layers [rows, width, passes, 6] of some rows, float64."""
    width, height = sensor.film().size()
    lanes = width * rows * passes * samples
    sampler = sensor.sampler()
    sampler.set_sample_count(samples)
    sampler.set_samples_per_wavefront(samples)
    sampler.seed(seed, lanes)
    # Opaque numbers, so that all bands and pictures share one compiled kernel.
    block = dr.arange(mi.UInt32, lanes) // dr.opaque(mi.UInt32, samples)
    index = block // dr.opaque(mi.UInt32, passes)
    number = block - index * dr.opaque(mi.UInt32, passes)
    row = index // dr.opaque(mi.UInt32, width)
    column = index - row * dr.opaque(mi.UInt32, width)
    corner = mi.Point2f(mi.Float(column), mi.Float(row + dr.opaque(mi.UInt32, top)))
    size = mi.Vector2f(dr.opaque(mi.Float, width), dr.opaque(mi.Float, height))
    film = corner + sampler.next_2d()
    if lens is None:
        ray, _ = sensor.sample_ray(0.0, 0.5, film / size, mi.Point2f(0.5))
    else:
        ray = lens.ray(film.x, film.y, sampler)
    diffuse, specular = estimator(sampler, ray, number)
    channels = [diffuse.x, diffuse.y, diffuse.z, specular.x, specular.y, specular.z]
    dr.eval(channels)
    sums = [np.array(dr.block_reduce(dr.ReduceOp.Add, c, samples)) for c in channels]
    means = np.stack(sums, -1, dtype=np.float64) / samples
    return means.reshape(rows, width, passes, 6)


def _band_slowly(lit, depth, sensor, lens, samples, passes, seed, top, rows) -> np.ndarray:
    """Means [rows, width, passes, 6] of a band, sample by sample: for variants without a compiler."""
    width, height = sensor.film().size()
    sampler = sensor.sampler()
    sampler.set_sample_count(samples)
    sums = np.zeros((rows, width, passes, 6))
    for row, column, number in np.ndindex(rows, width, passes):
        sampler.seed(seed_of(seed, row, column, number))
        for _ in range(samples):
            jitter = sampler.next_2d()
            x, y = column + jitter.x, top + row + jitter.y
            if lens is None:
                ray, _ = sensor.sample_ray(0.0, 0.5, mi.Point2f(x / width, y / height), mi.Point2f(0.5))
            else:
                ray = lens.ray(x, y, sampler)
            layers = split_radiance_scalar(lit.scene, lit.dark, sampler, ray, depth, lit.lambert_light)
            sums[row, column, number] += layers.ravel()
            sampler.advance()
    return sums / samples

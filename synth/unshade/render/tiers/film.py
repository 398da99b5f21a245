"""Pictures of an estimator that is no plain path tracer: bands of rows, independent passes.

The same scheme as `passes.render_layers` (block sums, never atomics; the spread of the
passes gives the variance of the mean); beside the ray, the estimator hears the number of
its pass, so that whatever else is drawn at random can be drawn anew for every pass.
"""

from __future__ import annotations

from collections.abc import Callable

import drjit as dr
import mitsuba as mi
import numpy as np

from ...formation.lens import Lens
from ...scene_file import passes_for
from ..layers import Layers
from ..passes import seed_of

Estimator = Callable
"""(sampler, ray, number of the pass) to diffuse and specular radiance, linear RGB."""

Progress = Callable[[int, int], None]
"""Samples done and samples in all."""

_MAX_LANES = 1 << 21
"""Camera rays in flight. With as many as in `passes`, the specular layer is that of the
opaque tier to the last bit."""


def expose(estimator: Estimator, sensor, samples: int, seed: int, *, lens: Lens | None, progress: Progress) -> Layers:
    """The picture of ``sensor`` with ``samples`` per pixel; ``lens`` as in `render_layers`."""
    passes = passes_for(samples)
    width, height = sensor.film().size()
    rows = max(1, _MAX_LANES // (width * samples))
    bands = []
    for top in range(0, height, rows):
        progress(top * width * samples, height * width * samples)
        count = min(rows, height - top)
        bands.append(_band(estimator, sensor, lens, samples // passes, passes, seed_of(seed, top), top, count))
    picture = np.concatenate(bands)
    mean = picture.mean(2).astype(np.float32)
    variance = (picture[..., :3] + picture[..., 3:]).var(2, ddof=1) / passes
    return Layers(mean[..., :3], mean[..., 3:], variance.astype(np.float32))


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

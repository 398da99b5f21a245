"""The split path tracer has the expectation of Mitsuba's own ``path``, and states its noise.

The variance that a picture states is used as scoring uses it, and compared with that of
repeated renders first: z-tests with a wrong variance would be meaningless.
"""

from __future__ import annotations

from collections.abc import Callable

import mitsuba as mi
import numpy as np

from ...scene_file import passes_for
from ..lights import AnyLight, Dome, Environment, studio
from ..passes import render_layers
from . import specimen
from .statistics import Comparison, Estimate
from .verdict import Verdict

SAMPLES = 832
"""Per pixel, in 13 passes: many passes estimate a pixel's variance well."""

BIAS_POOLED, BIAS_REGIONAL = 0.01, 0.03
"""Relative biases, of the picture and of one region, that must be found."""

MIN_POWER = (0.99, 0.8)
"""With at least this chance, the second for the noisiest region, or the check is too noisy to pass."""

VARIANCE_TOLERANCE = 0.12
"""Relative, of the mean stated variance; repeated renders estimate it to 4 % or so."""

_DEPTH = 4
_REPEATS = 24


def lights() -> dict[str, AnyLight]:
    """One light for each way of sampling it."""
    sky = np.full((16, 32, 3), 0.2, np.float32)
    sky[5, 4] = [30, 20, 10]
    return {"dome": Dome(0.7), "studio": studio().scaled(8.0), "sky": Environment(sky)}


def check_noise(
    samples: int = SAMPLES, names: tuple[str, ...] = ("dome", "studio", "sky"), render: Callable = render_layers
) -> Verdict:
    """Compares pictures of ``render`` with those of ``path`` in each light."""
    head, camera = specimen.head(), specimen.camera()
    passes = passes_for(samples)
    faults, powers, pixel = [], [], 0.0
    for seed, name in enumerate(names):
        lit = head.lit(lights()[name])
        layers = render(lit, camera.sensor(samples), samples=samples, depth=_DEPTH, seed=seed)
        theirs = Estimate.of_runs(path_pictures(lit, camera, samples, passes, 1000 * (seed + 1)))
        comparison = Comparison(Estimate.of_layers(layers, passes), theirs, theirs.mean > 0)
        faults += [f"{name}: {fault}" for fault in comparison.rejections()]
        powers.append((comparison.pooled_power(BIAS_POOLED), comparison.regional_power(BIAS_REGIONAL)))
        pixel = max(pixel, comparison.pixel_bias())
    ratio = variance_ratio(render, head.lit(lights()[names[-1]]), camera)
    if abs(ratio - 1) > VARIANCE_TOLERANCE:
        faults.append(f"the stated variance is {ratio:.2f} of that of repeated renders")
    pooled, regional = np.min(powers, 0)
    if pooled < MIN_POWER[0] or regional < MIN_POWER[1]:
        faults.append("too noisy to conclude")
    found = (
        f"{len(names)} lights, {samples} samples, against path; a bias of {100 * BIAS_POOLED:g} % is found with chance {pooled:.3f}, one of "
        f"{100 * BIAS_REGIONAL:g} % in the noisiest region with {regional:.3f}, of one pixel only beyond {100 * pixel:.0f} %; stated / true variance {ratio:.2f}"
    )
    suspect = "render/split.py or render/passes.py: biased, or wrong about its noise"
    return Verdict("noise", not faults, "; ".join([*faults, found]), suspect)


def path_pictures(lit, camera, samples: int, count: int, first_seed: int) -> list[np.ndarray]:
    """``count`` independent pictures [H, W, 3] of Mitsuba's path tracer that share the samples."""
    path = mi.load_dict({"type": "path", "max_depth": _DEPTH, "rr_depth": 99, "hide_emitters": True})
    sensor, per_picture = camera.sensor(samples), samples // count
    seeds = range(first_seed, first_seed + count)
    return [
        np.array(mi.render(lit.scene, sensor=sensor, integrator=path, spp=per_picture, seed=seed))[..., :3]
        for seed in seeds
    ]


def variance_ratio(render: Callable, lit, camera, samples: int = 52) -> float:
    """Mean stated variance over that of repeated renders."""
    runs = [render(lit, camera.sensor(samples), samples=samples, depth=_DEPTH, seed=100 + k) for k in range(_REPEATS)]
    measured = np.stack([run.total for run in runs]).var(0, ddof=1).mean()
    return float(np.mean([run.variance.mean() for run in runs]) / measured)

"""Samples of the skin follow the density that it states: Pearson's chi-squared test.

Over all normals, parts, angles and roughnesses. The chance that a right material fails any
of the tests is 1 %, shared by Sidak's correction. The statistic of a single test sees a
density wrong by 5 % everywhere; its integral, compared with the share of samples that
count, sees 1 %.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import product

import drjit as dr
import mitsuba as mi
import numpy as np
from mitsuba.chi2 import ChiSquareTest, SphericalDomain

from .material import NORMALS, PARTS, ROUGHNESS, Alter, Skin, context, direction, interaction, unaltered, vectors
from .verdict import Verdict

ANGLES = (1, 30, 60, 80, 88)
"""Degrees between view and mesh normal. At 0 the test's azimuth is undefined."""

FALSE_ALARM = 0.01
"""Chance that a right material fails any of the tests."""

_INTERVALS = 32
"""Points along each edge of a cell of the test; with 16, the sharpest lobe at 88 degrees is
integrated 4 % short."""

MASS_TOLERANCE = 0.0025
"""Between the integral of the density and the share of valid samples, beside 4 sigma of the
latter: what the test's quadrature leaves at the sharpest lobes."""

Case = tuple[str, "str | None", str, float]
"""Normals, roughness, part, angle in degrees."""


def all_cases() -> list[Case]:
    """The whole grid; the Lambert term has no roughness."""
    return [
        (normals, roughness, part, angle)
        for normals, roughness, part, angle in product(NORMALS, (None, *ROUGHNESS), PARTS, ANGLES)
        if part != "diffuse" or roughness is None
    ]


def check_sampling(cases: Iterable[Case] | None = None, samples: int = 500_000, alter: Alter = unaltered) -> Verdict:
    """Runs the test for every case. ``alter`` replaces the material by a faulty one."""
    cases = list(all_cases() if cases is None else cases)
    failures = []
    for seed, case in enumerate(cases):
        reason = _failure(case, seed, len(cases), samples, alter)
        if reason:
            failures.append(f"{', '.join(map(str, case))}: {reason}")
    found = f"{len(cases) - len(failures)} of {len(cases)} chi-squared tests pass"
    if failures:
        found += f"; first failure at {failures[0]}"
    return Verdict("sampling", not failures, found, "render/skin_bsdf.py: sample and pdf disagree")


def _failure(case: Case, seed: int, count: int, samples: int, alter: Alter) -> str:
    normals, roughness, part, angle = case
    bsdf = alter(Skin(normals, roughness).bsdf())
    ctx, wi = context(part), vectors(direction(angle, 40))

    def sample(u):
        bs, weight = bsdf.sample(ctx, interaction(wi, dr.width(u)), u[2], mi.Point2f(u[0], u[1]))
        return bs.wo, dr.select(dr.max(weight) > 0, mi.Float(1), mi.Float(0))

    def density(wo):
        return bsdf.pdf(ctx, interaction(wi, dr.width(wo)), wo)

    # The seed is opaque, so that equal materials share a compiled kernel.
    test = ChiSquareTest(
        SphericalDomain(), sample, density,
        sample_dim=3, sample_count=samples, res=101, ires=_INTERVALS, seed=dr.opaque(mi.UInt64, seed),
    )  # fmt: skip
    # Quiet, since otherwise a failure is dumped into the working directory.
    if not test.run(FALSE_ALARM, test_count=count, quiet=True):
        return f"p = {test.p_value:.1e}"
    mass, fraction = float(test.pdf_sum[0]), float(test.histogram_sum[0])
    noise = 4 * np.sqrt(fraction * (1 - fraction) / samples)
    if abs(mass - fraction) > MASS_TOLERANCE + noise:
        return f"the density integrates to {mass:.4f}, yet {fraction:.4f} of the samples count"
    return ""

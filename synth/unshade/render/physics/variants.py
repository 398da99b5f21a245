"""``scalar_rgb`` and ``llvm_ad_rgb`` render the same picture but for noise.

They draw different samples and, for the scalar one, run another path tracer
(`split_scalar`); so this compares two implementations. The difference of the pictures'
means is bounded: one of `BOUND` would have been found.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...scene_file import passes_for
from ..layers import Layers
from ..llvm import LLVM_VARIANT, SCALAR_VARIANT
from .child import NAMES, ChildError, Setting, collect, start
from .statistics import Comparison, Estimate
from .verdict import Verdict

BOUND = 0.03
"""Relative difference of the pictures' means that must be found with `MIN_POWER`."""

MIN_POWER = 0.95

SETTING = Setting(samples=100)


def render_both(setting: Setting) -> tuple[dict[str, Layers], dict[str, Layers]]:
    """The pictures of both variants, side by side in two children."""
    scalar, compiled = (start(replace(setting, variant=variant)) for variant in (SCALAR_VARIANT, LLVM_VARIANT))
    return collect(scalar), collect(compiled)


def check_variants(setting: Setting = SETTING, bound: float = BOUND, render: Callable = render_both) -> Verdict:
    """Compares total and layers; ``render`` gives the pictures of both variants."""
    suspect = "render/split_scalar.py, which differs from split.py"
    try:
        scalar, compiled = render(setting)
    except ChildError as error:
        return Verdict("variants", False, f"a variant renders nothing: {error}", suspect)
    passes = passes_for(setting.samples)
    faults, biases, power = [], [], 1.0
    for name in NAMES:
        ours, theirs = scalar[name], compiled[name]
        seen = theirs.total.sum(-1) > 0
        comparison = Comparison(Estimate.of_layers(ours, passes), Estimate.of_layers(theirs, passes), seen)
        faults += [f"{name}: {fault}" for fault in comparison.rejections()]
        biases.append(comparison.bias)
        power = min(power, comparison.pooled_power(bound))
        deviation = np.sqrt((comparison.ours.variance + comparison.theirs.variance)[seen].sum())
        for layer in ("diffuse", "specular"):
            # A layer is less noisy than the whole, so this is on the safe side.
            mean = [getattr(layers, layer)[seen].mean(-1).sum() for layers in (ours, theirs)]
            if abs(mean[0] - mean[1]) > 4 * deviation:
                faults.append(f"{name}: the {layer} layers differ by {100 * (mean[0] / mean[1] - 1):+.1f} %")
    if power < MIN_POWER:
        faults.append("too noisy to conclude")
    found = (
        f"means differ by {', '.join(f'{100 * bias:+.2f} % ({name})' for name, bias in zip(NAMES, biases))} between scalar_rgb and llvm_ad_rgb; "
        f"{100 * bound:g} % would be found with chance {power:.3f}"
    )
    return Verdict("variants", not faults, "; ".join([*faults, found]), suspect)

"""Checks the renderer against physics, for `unshade doctor --physics` and the tests.

One check a file; each is a function that returns a `Verdict` and takes the pieces that it
examines as arguments, so that tests can show it fail on a fault. All seeds are fixed: on
one machine a check always ends the same way.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

Progress = Callable[[int, int, str], None]
"""Steps done, steps in all, and what the next one is."""


def examine(progress: Progress) -> list[dict[str, Any]]:
    """Runs every check; entries as those of `doctor.examine`. About two minutes on two cores.

    The process must render in ``llvm_ad_rgb`` (`llvm.activate`).
    """
    import mitsuba as mi

    from .. import llvm

    if mi.variant() != llvm.LLVM_VARIANT:
        why = f"the checks need {llvm.LLVM_VARIANT}: hundreds of millions of samples are too slow without it"
        return [{"name": "physics", "ok": False, "found": why, "fix": llvm.FIX}]
    # Classes of Mitsuba belong to the variant that is set when they are made.
    from .determinism import check_determinism
    from .formula import check_formula
    from .furnace import check_furnace
    from .layers import check_layers
    from .noise import check_noise
    from .orientation import check_orientation
    from .reciprocity import check_reciprocity
    from .sampling import check_sampling
    from .variants import check_variants

    checks = {
        "coordinate probe": check_orientation,
        "values of the skin": check_formula,
        "reciprocity": check_reciprocity,
        "white furnace": check_furnace,
        "chi-squared tests": check_sampling,
        "layers": check_layers,
        "z-tests against path": check_noise,
        "scalar and compiled variant": check_variants,
        "threads and LLVMs": check_determinism,
    }
    entries = []
    for done, (what, check) in enumerate(checks.items()):
        progress(done, len(checks), what)
        entries.append(check().entry())
    progress(len(checks), len(checks), "physics")
    return entries

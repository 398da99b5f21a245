"""The three tiers of the skin's physics: ``[render] tier = "opaque" | "diffusion" | "volume"``.

They share geometry, maps, lights and the specular layer, and differ in how light that is not
reflected at once comes out of the skin: at the same place (`passes`), after a profile
(`diffusion`), or after a random walk through the flesh (`volume`). docs/subsurface.md
compares them.
"""

from __future__ import annotations

from collections.abc import Callable

import drjit as dr
import mitsuba as mi

from ...errors import SceneError
from ...formation.lens import Lens
from ...scene_file import Render
from .. import llvm
from ..layers import Layers
from ..passes import render_estimate, render_layers
from ..scene import HeadScene, LitHead
from . import diffusion, shared, volume

__all__ = ["render_tier"]


def render_tier(
    head: HeadScene,
    lit: LitHead,
    sensor,
    render: Render,
    seed: int,
    progress: Callable[[int, int], None] | None = None,
    *,
    lens: Lens | None = None,
    shared_seed: int | None = None,
) -> Layers:
    """One picture of ``head`` in the light ``lit`` (one of its own), in the tier of ``render``.

    ``shared_seed`` (``render.seed`` unless given) seeds what the views of a light share: the
    irradiance of ``diffusion``. Pictures whose noise must be independent need another.
    ``progress`` gets the samples done and in all; a new bake counts as much as the
    picture. Raises `SceneError` for a tier that the variant cannot render.
    """
    if render.tier == "opaque":
        return render_layers(
            lit, sensor, samples=render.samples, depth=render.depth, seed=seed, lens=lens, progress=progress,
        )  # fmt: skip
    if not dr.is_jit_v(mi.Float):
        raise SceneError(
            f'tier = "{render.tier}" in [render] needs the variant llvm_ad_rgb; {llvm.FIX}, or set tier = "opaque"'
        )
    progress = progress or (lambda done, total: None)
    if render.tier == "diffusion":
        reports = []
        baked = shared.baked(
            head, lit, render, render.seed if shared_seed is None else shared_seed,
            lambda done, total: reports.append(progress(done, 2 * total)),
        )  # fmt: skip
        if reports:
            whole = progress
            progress = lambda done, total: whole(total + done, 2 * total)
        estimator = diffusion.estimator(head, lit, baked, render.depth)
    else:
        estimator = volume.estimator(shared.flesh(head), lit, render)
    return render_estimate(estimator, sensor, samples=render.samples, seed=seed, lens=lens, progress=progress)

"""The `[render]` table."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from ..errors import SceneError
from .checks import choice, known_keys, whole

VARIANTS = ("auto", "llvm_ad_rgb", "scalar_rgb")


@dataclass(frozen=True)
class Render:
    """Picture size in pixels, samples per pixel, path segments, seed and variant."""

    width: int
    height: int
    samples: int = 128
    depth: int = 6
    seed: int = 0
    variant: str = "auto"


def parse_render(table: Mapping[str, Any], place: str) -> Render:
    known_keys(table, [field.name for field in fields(Render)], place)
    render = Render(
        width=whole(table, "width", place, None, 16, 8192),
        height=whole(table, "height", place, None, 16, 8192),
        samples=whole(table, "samples", place, Render.samples, 4, 1 << 16),
        depth=whole(table, "depth", place, Render.depth, 2, 64),
        seed=whole(table, "seed", place, Render.seed, 0, 2**63 - 1),
        variant=choice(table, "variant", VARIANTS, place) if "variant" in table else Render.variant,
    )
    if passes_for(render.samples) is None:
        near = next(n for n in range(render.samples, 1 << 17) if passes_for(n))
        raise SceneError(f"samples in {place} is {render.samples}, which stratified passes cannot share; use {near}")
    return render


def passes_for(samples: int) -> int | None:
    """Number of passes (4 to 16) whose share of the samples is a full multijitter grid."""
    for passes in range(4, 17):
        share, rest = divmod(samples, passes)
        if rest == 0 and share and share % math.isqrt(share) == 0:
            return passes
    return None

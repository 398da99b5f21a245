"""The `[render]` table."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import MISSING, asdict, dataclass
from typing import Any

from ..errors import SceneError
from ..tables import Table, integer, one_of, read, vector

VARIANTS = ("auto", "llvm_ad_rgb", "cuda_ad_rgb", "scalar_rgb")
MATERIALS = ("skin", "principled")
TIERS = ("opaque", "diffusion", "volume")
DENOISERS = ("none", "oidn")

SKIN1_MM = (1.30, 0.95, 0.67)
"""Mean free paths of the sample `skin1` of Jensen et al. 2001 ("A Practical Model for
Subsurface Light Transport", table 1): 1 / (reduced scattering + absorption)."""

_SHORTEST_MM, _LONGEST_MM = 0.05, 10.0
"""Below, the skin is opaque (and single precision too coarse for the walks); beyond, light
would cross the head, and no profile describes that."""

_MEAN_FREE_PATHS = f"three numbers [r, g, b] in millimetres, {_SHORTEST_MM:g} to {_LONGEST_MM:g}"


@dataclass(frozen=True)
class Render:
    """Picture size in pixels, samples per pixel, path segments, seed and variant; how light
    leaves the skin (``tier``, see `render.tiers`).

    ``subsurface_mm``: mean free path of light in skin, for red, green and blue, used by all
    tiers but ``opaque``. A path between two scatterings, which are isotropic; the width of a
    profile follows from it and the albedo.

    ``material`` of the chart, for truth and relit maps alike: the one that solvers assume, or Mitsuba's ``principled``
    (`render.principled_skin`).

    ``denoise``: what takes the noise out of every picture, true and relit (`render.denoise`).
    """

    width: int = integer(MISSING, 16, 8192)
    height: int = integer(MISSING, 16, 8192)
    samples: int = integer(128, 4, 1 << 16)
    depth: int = integer(6, 2, 64)
    seed: int = integer(0, 0, 2**63 - 1)
    variant: str = one_of(*VARIANTS)
    tier: str = one_of(*TIERS)
    subsurface_mm: tuple[float, float, float] = vector(SKIN1_MM, _MEAN_FREE_PATHS, 3, _SHORTEST_MM, _LONGEST_MM)
    denoise: str = one_of(*DENOISERS)
    material: str = one_of(*MATERIALS)

    def to_table(self) -> dict[str, Any]:
        """All keys; those of tier and denoiser only where there is one."""
        table = asdict(self) | {"subsurface_mm": list(self.subsurface_mm)}
        if self.tier == "opaque":
            del table["tier"], table["subsurface_mm"]
        if self.denoise == "none":
            del table["denoise"]
        if self.material == "skin":
            del table["material"]
        return table


def parse_render(values: Mapping[str, Any], place: str) -> Render:
    table = Table(values, place)
    render = read(Render, table)
    if render.material != "skin" and render.tier != "opaque":
        raise SceneError(
            f'material = "{render.material}" in {place} is opaque; leave tier = "{render.tier}" out, or the material'
        )
    if render.tier == "opaque" and "subsurface_mm" in table:
        raise table.wrong(
            "subsurface_mm", 'means nothing to tier = "opaque"; set tier = "diffusion" or "volume", or leave it out'
        )
    if render.tier != "opaque" and render.variant == "scalar_rgb":
        raise SceneError(
            f'tier = "{render.tier}" in {place} needs LLVM; set variant = "llvm_ad_rgb" or tier = "opaque"'
        )
    if render.denoise != "none" and render.variant == "scalar_rgb":
        raise SceneError(
            f'denoise = "{render.denoise}" in {place} needs LLVM for its guides; set variant = "llvm_ad_rgb" or denoise = "none"'
        )
    if passes_for(render.samples) is None:
        near = next(n for n in range(render.samples, 1 << 17) if passes_for(n))
        raise table.wrong("samples", f"is {render.samples}, which stratified passes cannot share; use {near}")
    return render


def passes_for(samples: int) -> int | None:
    """Number of passes (4 to 16) whose share of the samples is a full multijitter grid."""
    for passes in range(4, 17):
        per_pass, rest = divmod(samples, passes)
        if rest == 0 and per_pass and per_pass % math.isqrt(per_pass) == 0:
            return passes
    return None

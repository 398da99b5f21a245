"""Spots of natural skin: freckles in clusters, moles, age spots, dark papules, blemishes and the marks that they leave."""

from __future__ import annotations

import dataclasses

import numpy as np

from .noise import smooth_noise
from .regions import Regions, smoothstep
from .spec import FaceSpec, stream
from .texels import Texels


@dataclasses.dataclass(frozen=True)
class Kind:
    """`count` spots, drawn among the chart's vertices by `weight` (C,): ranges of radius (mm), of the log luminance that
    their melanin and their blood take away at the centre, and of their height (mm)."""

    name: str
    count: int
    weight: np.ndarray
    radius: tuple[float, float]
    melanin: tuple[float, float]
    blood: tuple[float, float] = (0.0, 0.0)
    height: tuple[float, float] = (0.0, 0.0)


@dataclasses.dataclass(frozen=True)
class Spots:
    """`melanin` and `blood` (M,): log luminance that they take away; `height` (M,) mm."""

    melanin: np.ndarray
    blood: np.ndarray
    height: np.ndarray


_FRECKLES = {"I": 1300, "II": 700, "III": 260, "IV": 110, "V": 60, "VI": 40}


def _kinds(sites: Regions, spec: FaceSpec) -> list[Kind]:
    rng = stream(spec.seed, "spots")
    anywhere = (1 - sites.lips) * (1 - sites.lids)
    dark = spec.fitzpatrick in ("IV", "V", "VI")
    youth = 1.2 - spec.age
    # Freckles crowd where the sun falls, and in clusters.
    crowd = np.exp(1.1 * np.clip(smooth_noise(sites.points, 11.0, stream(spec.seed, "freckle clusters")), -2, 2))
    sunny = (0.25 + 2 * sites.cheek + 1.6 * sites.nose + 0.7 * sites.forehead) * anywhere * crowd
    freckled = _FRECKLES[spec.fitzpatrick] * rng.lognormal(0.0, 0.6)
    blemished = rng.gamma(1.2, 9.0) * youth
    oily = (0.3 + sites.chin + sites.forehead + sites.cheek + sites.jaw) * anywhere
    return [
        Kind("freckles", int(rng.poisson(freckled)), sunny, (0.3, 1.1), (0.04, 0.30)),
        Kind("age spots", int(60 * spec.age**2 * rng.uniform(0.3, 1.3)), anywhere, (1.2, 4.0), (0.10, 0.40)),
        Kind("moles", int(rng.integers(4, 18)), anywhere, (0.5, 1.5), (0.3, 1.0), height=(0.0, 0.35)),
        Kind(
            "papules",
            int((40 if spec.fitzpatrick in ("V", "VI") else 0) * spec.age * rng.uniform(0.2, 1.5)),
            (sites.cheek + sites.temple + 0.2) * anywhere,
            (0.5, 1.4),
            (0.3, 0.9),
            height=(0.1, 0.5),
        ),
        Kind("blemishes", int(rng.poisson(blemished)), oily, (0.7, 2.4), (0.0, 0.05), (0.15, 0.55), (0.05, 0.35)),
        Kind(
            "marks",
            int(rng.poisson(blemished * (1.6 if dark else 0.7))),
            oily,
            (0.8, 2.6),
            (0.10, 0.35) if dark else (0.0, 0.06),
            (0.0, 0.1) if dark else (0.10, 0.35),
            (-0.12, 0.0),
        ),
    ]


def draw_spots(
    points: np.ndarray, texels: Texels, sites: Regions, site_uv: np.ndarray, texel: float, spec: FaceSpec
) -> Spots:
    """All spots at template points (M,3) mm, `texel` mm apart; `sites` are the chart's vertices, at `site_uv` (C,2)."""
    layers = np.zeros((3, len(points)), dtype=np.float32)
    for kind in _kinds(sites, spec):
        rng = stream(spec.seed, "spots", kind.name)
        chosen = rng.choice(len(site_uv), kind.count, p=kind.weight / kind.weight.sum(dtype=np.float64))
        # Most are small; large and strong ones are rare.
        size = rng.uniform(0, 1, kind.count) ** 2
        radii = kind.radius[0] + (kind.radius[1] - kind.radius[0]) * size
        amounts = [rng.uniform(*bounds, kind.count) for bounds in (kind.melanin, kind.blood, kind.height)]
        stretches, turns = rng.uniform(0.65, 1.0, kind.count), rng.uniform(0, np.pi, kind.count)
        for site, radius, stretch, turn, *strengths in zip(chosen, radii, stretches, turns, *amounts):
            # A spot of few texels is drawn wider and fainter, so that its pigment stays.
            drawn = np.hypot(radius, 0.5 * texel)
            near = texels.around(site_uv[site], 2.2 * drawn / texel + 1)
            x, y, z = (points[near] - np.float32(sites.points[site])).T
            cos, sin = np.float32(np.cos(turn)), np.float32(np.sin(turn))
            distance = np.sqrt(((cos * x + sin * y) / stretch) ** 2 + (cos * y - sin * x) ** 2 + z * z) / drawn
            shape = (radius / drawn) ** 2 * smoothstep(1.5, 0.35, distance)
            for layer, strength in zip(layers, strengths):
                layer[near] += np.float32(strength) * shape
    return Spots(*layers)

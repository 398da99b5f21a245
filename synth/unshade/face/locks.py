"""Hair of natural faces, strand by strand: combed over the scalp, loose at the hairline, bearded or shaven on the jaw."""

from __future__ import annotations

import dataclasses

import numpy as np

from .character import BEARDS, Character
from .hair import HairStyle, scalp_cover
from .noise import octaves
from .regions import Regions, bump, smoothstep
from .spec import FaceSpec, stream
from .strands import Field, Ground, Strands

_PER_CM2 = 90
"""Drawn strands per square centimetre of thick hair: each stands for two or three that lie together."""

_GREYER = 4.0
"""Factor on the brightness of a strand that has lost its pigment."""

_WIDTH_MM = (0.18, 0.32)
_TONES = 0.12
"""Standard deviation of a strand's log brightness: the light that hairs lose and pass on to one another."""


@dataclasses.dataclass(frozen=True)
class Hairs:
    """`cover` (M,) 0 to 1 and `tone` (M,), the factor on the hair's colour: of scalp hair and of the beard's."""

    cover: np.ndarray
    tone: np.ndarray
    beard_cover: np.ndarray
    beard_tone: np.ndarray


def lock_tone(points: np.ndarray, seed: int) -> np.ndarray:
    """Factor (M,) on the hair's colour by lock, drawn out along the combing; the same on chart and rest of the head."""
    x, y, z = points.T
    # Combed back, hair runs along -z and up over the brow: locks are narrow across, long along.
    angle = np.arctan2(x, np.maximum(y + 40, 1.0)) * 70
    along = np.stack([angle, 0.18 * y, 0.18 * z], axis=1).astype(np.float32)
    return np.exp(0.55 * octaves(along, 12.0, 3, 0.0, stream(seed, "locks"))).astype(np.float32)


def scalp_colour(points: np.ndarray, style: HairStyle, spec: FaceSpec) -> np.ndarray:
    """Albedo of scalp hair: one (3,), or one for each of the template points, (M,3), where hair is natural."""
    if spec.detail == "smooth":
        return style.scalp
    return lock_tone(points, spec.seed)[:, None] * style.scalp


def draw_hairs(
    field: Field,
    points: np.ndarray,
    grounds: list[Ground],
    texel: float,
    style: HairStyle,
    person: Character,
    spec: FaceSpec,
) -> Hairs:
    """Strands over the texels of `texel` mm, at template points (M,3) mm, rooted in `grounds`."""
    cover, tone = field.cover([_scalp_hair(field, ground, style, spec) for ground in grounds], 1.3, texel)
    beard = [_beard(field, ground, style, person, spec) for ground in grounds]
    return Hairs(cover, tone * lock_tone(points, spec.seed), *field.cover(beard, 1.0, texel))


def _scalp_hair(field: Field, ground: Ground, style: HairStyle, spec: FaceSpec) -> Strands:
    rng = stream(spec.seed, f"strands{ground.name}")
    roots = field.roots(_PER_CM2, scalp_cover(ground.sites.points, style, spec.seed), ground, rng)
    count = len(roots)
    # A strand goes its own way all along, and sways a little.
    turns = rng.normal(0, 0.16, (count, 1)) + np.cumsum(rng.normal(0, 0.07, (count, 8)), axis=1)
    shade = np.exp(rng.normal(0, _TONES, count)) * np.where(rng.random(count) < 0.8 * style.grey, _GREYER, 1.0)
    length, width = rng.uniform(8, 24, count), rng.uniform(*_WIDTH_MM, count)
    # Hair at its line is finer and shorter than behind it, and stands alone.
    thick = scalp_cover(field.at(roots), style, spec.seed)
    length, width = length * (0.55 + 0.45 * thick), width * (0.45 + 0.55 * thick)
    return field.strands(roots, length, _combed(stream(spec.seed, "comb")), turns, width, shade)


def _combed(rng: np.random.Generator):
    """Direction at template points: back over the skull, with a side that it leans to."""
    lean = rng.uniform(-0.5, 0.5)

    def towards(points: np.ndarray) -> np.ndarray:
        x, y, _ = points.T
        side = np.clip(x / 60, -1, 1)
        up = 0.9 * smoothstep(10.0, 70.0, y) - 0.5 * smoothstep(20.0, -40.0, y)
        return np.stack([0.35 * side + lean * smoothstep(40.0, 90.0, y), up, -np.ones_like(x)], axis=1)

    return towards


def beard_region(regions: Regions, spec: FaceSpec) -> np.ndarray:
    """Where (M,) 0 to 1 a beard grows: jaw, chin and upper lip, with an edge that frays."""
    points = regions.points
    lip = bump(points, (0, -54, 36), (24, 6, 16))
    where = np.maximum(regions.jaw, 1.2 * lip) + 0.18 * octaves(points, 9.0, 3, 0.0, stream(spec.seed, "beard edge"))
    return smoothstep(0.22, 0.75, where) * (1 - regions.lips)


def _beard(field: Field, ground: Ground, style: HairStyle, person: Character, spec: FaceSpec) -> Strands:
    low, high = BEARDS[person.beard]
    rng = stream(spec.seed, f"whiskers{ground.name}")
    dense = style.beard * rng.uniform(55, 95) * (high > 0)
    roots = field.roots(dense, beard_region(ground.sites, spec), ground, rng)
    count = len(roots)

    def down(points: np.ndarray) -> np.ndarray:
        return np.stack([0.25 * np.sign(points[:, 0]), -np.ones(len(points)), 0 * points[:, 0]], axis=1)

    turns = rng.normal(0, 0.45, (count, 1)) + np.cumsum(rng.normal(0, 0.15, (count, 8)), axis=1)
    length, width = rng.uniform(low, high, count), rng.uniform(0.10, 0.17, count)
    return field.strands(roots, length, down, turns, width, np.exp(rng.normal(0, 0.35, count)))

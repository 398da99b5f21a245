"""Colour of the skin: pigments over regions, then hair, lips, lids and what lies in the relief."""

from __future__ import annotations

import dataclasses

import numpy as np

from .blotches import blood_factor, draw_coarse, melanin_factor
from .character import character
from .hair import HairStyle, scalp_cover
from .locks import scalp_colour
from .noise import octaves
from .pigment import BLOOD, BLOOD_LIMIT, LIP, MELANIN_LIMIT, MELANOSOMES, skin_colour
from .regions import Regions, smoothstep
from .relief import Relief
from .spec import FaceSpec, stream
from .texels import Texels

_SPECULAR = 0.027
"""Reflectance of skin at normal incidence away from oily regions.

F0 of n = 1.4 is 0.028; over the face it runs from 0.02 to 0.04, highest in the oily T-zone
(specular albedo of Ghosh et al. 2010 and of Digital Emily)."""

SPECULAR_LIMIT = 0.05


@dataclasses.dataclass(frozen=True)
class Pigments:
    """Volume fractions (M,) of melanosomes and blood."""

    melanin: np.ndarray
    blood: np.ndarray


def base_pigments(regions: Regions, spec: FaceSpec) -> Pigments:
    """Slowly varying pigments, the same function on the chart and on the rest of the head.

    Regions differ by about as much in every skin type: forehead, temples, lids and the
    skin round eyes and mouth hold more melanin than the cheeks, nose and cheeks more blood
    than the forehead. Patches without a place shrink with the amount of melanin: dark skin
    is even, not blotchy.
    """
    rng = stream(spec.seed, "complexion")
    flush, rings, sun, thin = rng.uniform((0.6, 0.2, 0.4, 0.5), (1.3, 1.0, 1.0, 1.0))
    tone = np.exp(np.clip(stream(spec.seed, "tone").normal(0, 0.06), -0.12, 0.12))
    patches = octaves(regions.points, 40.0, 3, 8.0, stream(spec.seed, "melanin patches"))
    glow = octaves(regions.points, 34.0, 3, 8.0, stream(spec.seed, "blood patches"))
    melanin = 1 + _evenness(spec) * 0.045 * patches
    melanin += sun * (0.14 * regions.forehead + 0.08 * regions.temple) - 0.09 * regions.cheek + 0.05 * regions.jaw
    melanin += 0.26 * rings * regions.under_eye + 0.14 * regions.upper_lid + 0.12 * rings * regions.perioral
    blood = (
        1
        + 0.10 * glow
        + flush * (0.70 * regions.nose + 0.75 * regions.cheek + 0.25 * regions.chin + 0.30 * regions.wings)
    )
    blood += 0.45 * regions.ear_flush + 0.35 * thin * regions.under_eye + 0.40 * regions.upper_lid
    blood -= 0.16 * regions.forehead + 0.12 * regions.perioral
    if spec.detail == "natural":
        person = character(spec)
        darker, redder = draw_coarse(regions, spec, (person.mottle, person.redness))
        melanin, blood = melanin * melanin_factor(darker, spec), blood * blood_factor(redder, spec)
    return Pigments(MELANOSOMES[spec.fitzpatrick] * tone * melanin, BLOOD[spec.fitzpatrick] * blood)


def _evenness(spec: FaceSpec) -> float:
    return 1 / (1 + 6 * MELANOSOMES[spec.fitzpatrick])


def head_colour(regions: Regions, style: HairStyle, spec: FaceSpec) -> tuple[np.ndarray, np.ndarray]:
    """Diffuse (M,3) and specular (M,) albedo f32 of the head away from the chart; at its rim the chart agrees."""
    pigments = base_pigments(regions, spec)
    colour = skin_colour(pigments.melanin, pigments.blood)
    scalp = scalp_cover(regions.points, style, spec.seed)
    specular = _specular_base(regions, scalp, spec)
    if spec.detail == "natural":
        specular = np.clip(np.float32(character(spec).specular) * specular, 0, SPECULAR_LIMIT)
    if spec.specular_scale != 1:
        specular = np.clip(np.float32(spec.specular_scale) * specular, 0, SPECULAR_LIMIT)
    return _with_hair(colour, scalp, scalp_colour(regions.points, style, spec), style.opacity), specular


def chart_colour(
    regions: Regions,
    pigments: Pigments,
    relief: Relief,
    marks: np.ndarray,
    cover: dict[str, np.ndarray],
    rims: dict[str, np.ndarray],
    texel: float,
    style: HairStyle,
    spec: FaceSpec,
) -> tuple[np.ndarray, np.ndarray]:
    """Diffuse (M,3) and specular (M,) albedo f32 of the chart's texels.

    `pigments` those of `base_pigments`; `marks` (M,) melanin of moles and freckles; `cover`:
    `brow`, `scalp`, `beard` shares; `rims`: `outer`, 0 at the outer rim to 1 inside, and `lash`,
    `wet`, the shares of lash line and waterline; `texel` in mm. Detail fades towards the outer rim, where the rest of the head takes over.
    """
    fade = rims["outer"]
    even = _evenness(spec)
    fine = octaves(regions.points, 6.0, 4, 2 * texel, stream(spec.seed, "fine melanin"))
    mottle = octaves(regions.points, 5.0, 3, 2 * texel, stream(spec.seed, "fine blood"))
    lips = regions.lips * fade
    melanin = pigments.melanin * (1 + fade * even * (0.05 + 0.04 * spec.age) * fine) + fade * marks
    blood = pigments.blood * (1 + fade * (0.11 * mottle + 0.45 * relief.creases))
    blood = blood * (1 + 1.2 * rims["wet"])
    colour = skin_colour(np.clip(melanin, 0, MELANIN_LIMIT), np.clip(blood, 0, BLOOD_LIMIT))
    there = np.flatnonzero(lips)
    own = _lip_colour(melanin[there], blood[there] * (1 + 0.12 * fine[there]), regions.lower_lip[there], spec)
    colour[there] += lips[there, None] * (own - colour[there])

    # Little light finds its way out of pores and folds.
    colour = colour * (1 - fade * (0.26 * relief.pores + 0.06 * relief.furrows + 0.14 * relief.creases))[:, None]
    # A shaven beard shows its roots through the skin: bluish grey, hence red is damped most.
    colour = colour * (1 - (fade * cover["beard"])[:, None] * np.float32([0.36, 0.34, 0.30]))
    colour = colour + (fade * cover["brow"])[:, None] * (style.brow.astype(np.float32) - colour)
    colour = _with_hair(colour, cover["scalp"], scalp_colour(regions.points, style, spec), style.opacity)
    colour = colour * (1 - 0.82 * rims["lash"])[:, None]

    specular = _specular_base(regions, cover["scalp"], spec)
    specular = specular + fade * (0.006 * lips + 0.001 * mottle)
    specular = specular * (
        1 - fade * (0.45 * relief.pores + 0.15 * relief.furrows + 0.30 * relief.creases + 0.7 * cover["brow"])
    )
    specular = specular * (1 - 0.6 * rims["lash"]) + 0.012 * rims["wet"]
    return colour.astype(np.float32), np.clip(specular, 0, SPECULAR_LIMIT).astype(np.float32)


def _lip_colour(melanin: np.ndarray, blood: np.ndarray, lower: np.ndarray, spec: FaceSpec) -> np.ndarray:
    """Albedo (K,3) of lips in skin of these pigments; `lower` (K,) 1 on the lower one.

    Pale skin's lips are more pigmented than the rest of it; dark skin's less, the lower one
    least, and their epidermis stays nearer to that of skin.
    """
    amount = MELANOSOMES[spec.fitzpatrick]
    factor = 0.85 - lower * np.float32(0.1 + 0.5 * amount)
    melanin = np.clip(melanin * factor + np.float32(0.010), 0, MELANIN_LIMIT)
    blood = np.clip(blood * (1 + 3.2 * stream(spec.seed, "lip colour").uniform(0.7, 1.2)), 0, BLOOD_LIMIT)
    vermilion = np.float32(0.75 - 1.6 * amount)
    return vermilion * skin_colour(melanin, blood, LIP) + (1 - vermilion) * skin_colour(melanin, blood)


def _with_hair(colour: np.ndarray, cover: np.ndarray, hair: np.ndarray, opacity: float) -> np.ndarray:
    return (colour + opacity * cover[:, None] * (hair.astype(np.float32) - colour)).astype(np.float32)


def _specular_base(regions: Regions, scalp: np.ndarray, spec: FaceSpec) -> np.ndarray:
    """Reflectance (M,) at normal incidence: more on nose, forehead and chin, less round the eyes and where skin is old and dry."""
    sebum = float(stream(spec.seed, "sebum").uniform(0.75, 1.25)) * (1 - 0.25 * spec.age)
    skin = _SPECULAR + 0.009 * sebum * regions.oily + 0.001 * regions.cheek - 0.003 * regions.under_eye
    return (skin * (1 - 0.6 * scalp)).astype(np.float32)


def draw_marks(
    points: np.ndarray, texels: Texels, sites: Regions, site_uv: np.ndarray, texel: float, spec: FaceSpec
) -> np.ndarray:
    """Melanin (M,) of freckles, age spots and moles: round spots at template points (M,3) mm.

    Their centres are drawn among `sites` (the chart's vertices, at `site_uv`), so that they
    stay in place when the texture's size changes.
    """
    rng = stream(spec.seed, "marks")
    freckled = rng.uniform(0.1, 1.4) * {"I": 420, "II": 220, "III": 70, "IV": 20, "V": 5, "VI": 3}[spec.fitzpatrick]
    anywhere = (1 - sites.lips) * (1 - sites.lids)
    kinds = (
        (rng.poisson(freckled), (0.2 + 2 * sites.cheek + 1.4 * sites.nose) * anywhere, (0.35, 0.9), (0.012, 0.035)),
        (int(50 * spec.age**2 * rng.uniform(0.3, 1.3)), anywhere, (1.0, 2.6), (0.015, 0.035)),
        (int(rng.integers(2, 9)), anywhere, (0.6, 1.3), (0.15, 0.30)),
    )
    marks = np.zeros(len(points), dtype=np.float32)
    for count, weight, radii, amounts in kinds:
        for site in rng.choice(len(site_uv), count, p=weight / weight.sum(dtype=np.float64)):
            radius, amount, stretch = rng.uniform(*radii), rng.uniform(*amounts), rng.uniform(0.7, 1.3)
            # A spot of few texels is drawn wider and fainter, so that its pigment stays.
            drawn = np.hypot(radius, 0.5 * texel)
            near = texels.around(site_uv[site], 2.0 * drawn / texel + 1)
            offset = (points[near] - np.float32(sites.points[site])) * np.float32([stretch, 1 / stretch, 1])
            distance = np.sqrt((offset**2).sum(axis=1)) / drawn
            marks[near] = np.maximum(marks[near], amount * (radius / drawn) ** 2 * smoothstep(1.5, 0.4, distance))
    return marks / np.float32(1 + 4 * MELANOSOMES[spec.fitzpatrick])

"""How natural skin differs from person to person beyond shape and tone: seeded factors, one draw each."""

from __future__ import annotations

import dataclasses

import numpy as np

from .spec import FaceSpec, stream

SPECULAR_FACTORS = (0.6, 1.6)
ROUGHNESS_FACTORS = (0.7, 1.5)
"""Ranges of the factors on a whole face's specular albedo and on its lobes' alphas; both drawn evenly in their logarithm."""

BEARDS = {"shaven": (0.0, 0.0), "stubble": (0.8, 2.0), "short": (4.0, 9.0), "full": (9.0, 18.0)}
"""Lengths of the hairs, mm, of what can grow on a man's jaw; longer hairs lie along the skin."""

_BEARD_PROBABILITIES = (0.30, 0.35, 0.20, 0.15)


@dataclasses.dataclass(frozen=True)
class Character:
    """Factors of one face with natural skin.

    `specular` on the specular albedo, `roughness` on both alphas; `mottle` on the unevenness of
    melanin, `redness` on that of blood, `relief` on the height of what is uneven; `beard` one of
    `BEARDS`.
    """

    specular: float
    roughness: float
    mottle: float
    redness: float
    relief: float
    beard: str


def character(spec: FaceSpec) -> Character:
    """The factors of a face; equal seeds give equal ones."""

    def even(name: str, low: float, high: float) -> float:
        return float(np.exp(stream(spec.seed, name).uniform(np.log(low), np.log(high))))

    beards = stream(spec.seed, "beard kind")
    return Character(
        specular=even("specular factor", *SPECULAR_FACTORS),
        roughness=even("roughness factor", *ROUGHNESS_FACTORS),
        mottle=even("mottle", 0.65, 1.15),
        redness=even("redness", 0.6, 1.2),
        relief=even("relief factor", 0.8, 1.3),
        beard=str(beards.choice(list(BEARDS), p=_BEARD_PROBABILITIES)) if spec.gender > 0.6 else "shaven",
    )

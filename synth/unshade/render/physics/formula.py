"""The skin's values are those of the stated model, direction by direction."""

from __future__ import annotations

from itertools import product

import numpy as np

from . import reference
from .material import NORMALS, PARTS, ROUGHNESS, Alter, Skin, context, hemisphere, interaction, unaltered, vectors
from .verdict import Verdict

TOLERANCE = 2e-4
"""Largest relative difference where values are above a thousandth of the largest; single
precision is ten times better."""


def check_formula(count: int = 2000, alter: Alter = unaltered) -> Verdict:
    """Compares ``count`` pairs of directions for each normal, roughness and part."""
    rng = np.random.default_rng(1)
    worst, where = 0.0, ""
    for normals, roughness, part in product(NORMALS, (None, *ROUGHNESS), PARTS):
        skin = Skin(normals, roughness)
        wi, wo = hemisphere(rng, count), hemisphere(rng, count)
        got = np.array(alter(skin.bsdf()).eval(context(part), interaction(vectors(wi), count), vectors(wo)).x)
        expected = reference.value(skin, wi, wo, part)
        # Values that vanish next to the highlight have no relative error worth a name.
        error = np.abs(got - expected) / np.maximum(expected, 1e-3 * expected.max())
        if error.max() > worst:
            worst, where = float(error.max()), f"{normals}, {roughness or 'standard'}, {part}"
    found = f"values within {worst:.1e} of the stated model (limit {TOLERANCE:g}; worst at {where})"
    return Verdict("formula", worst < TOLERANCE, found, "render/skin_bsdf.py: eval is not the stated model")

"""Light takes the same way back, wherever the model allows it.

Schlick's term depends on h.v = h.l alone and the masking is separable, so each lobe is
symmetric about its own normal, and so is Lambert's term about its own. Their sum is
reciprocal about the mesh's normal only where both normals are the mesh's: a cosine about
another normal, divided by the mesh's, changes with the direction. That is the price of
every normal map, and stated with its size, not hidden.
"""

from __future__ import annotations

import numpy as np

from .material import NORMALS, ROUGHNESS, Alter, Skin, context, hemisphere, interaction, unaltered, vectors
from .verdict import Verdict

TOLERANCE = 1e-4
"""Largest relative difference of the two ways where the model is reciprocal (single precision)."""


def check_reciprocity(count: int = 2000, alter: Alter = unaltered) -> Verdict:
    """Compares both ways for ``count`` pairs of directions, every normal and roughness."""
    rng = np.random.default_rng(3)
    worst, where, unequal = 0.0, "", 0.0
    mesh = np.array([0.0, 0.0, 1.0])
    for normals in NORMALS:
        for roughness in (None, *ROUGHNESS):
            skin = Skin(normals, roughness)
            wi, wo = hemisphere(rng, count), hemisphere(rng, count)
            own = {"diffuse": skin.diffuse_normal, "specular": skin.specular_normal}
            for part, normal in (own | {"all": mesh}).items():
                asymmetry = _asymmetry(alter(skin.bsdf()), part, normal, wi, wo)
                if part == "all" and normals != "mesh":
                    unequal = max(unequal, float(np.median(asymmetry)))
                elif asymmetry.max() > worst:
                    worst, where = float(asymmetry.max()), f"{normals}, {roughness or 'standard'}, {part}"
    found = (
        f"each term is the same both ways about its own normal to {worst:.1e} (limit {TOLERANCE:g}; worst at {where}); "
        f"the sum of tilted terms is not, by {100 * unequal:.0f} % in the median (no fault: see reciprocity.py)"
    )
    return Verdict("reciprocity", worst < TOLERANCE, found, "render/skin_bsdf.py: eval favours a direction")


def _asymmetry(bsdf, part: str, normal: np.ndarray, wi: np.ndarray, wo: np.ndarray) -> np.ndarray:
    """Relative differences of f, where the term is lit and seen both ways."""
    ctx, count = context(part), len(wi)
    there = np.array(bsdf.eval(ctx, interaction(vectors(wi), count), vectors(wo)).x, float) / (wo @ normal)
    back = np.array(bsdf.eval(ctx, interaction(vectors(wo), count), vectors(wi)).x, float) / (wi @ normal)
    # Lambert's term does not ask from where it is seen: one way may be lit alone.
    both = (wi @ normal > 0.02) & (wo @ normal > 0.02)
    return (np.abs(there - back) / np.maximum(there, back).clip(1e-9))[both]

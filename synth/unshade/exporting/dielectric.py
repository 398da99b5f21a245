"""The highlight of our skin in the terms of other programs: an index of refraction and a strength.

Ours is rho_s/F0 (F0 + (1 - F0)(1 - h.v)^5) with F0 = 0.04. Theirs is strength x (F + (1 - F)(1 - h.v)^5) with
strength 0 to 1 and F from one index of refraction, so both are equal where F is 0.04. Maps that reach further
get a larger F: exact at normal incidence, up to 20 % less at grazing angles.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..render.skin_bsdf import F0


@dataclass(frozen=True)
class Dielectric:
    """``reflectance`` at normal incidence of the index of refraction, and the map's share (N,N) of it, 0 to 1."""

    reflectance: float
    strength: np.ndarray

    @property
    def taken(self) -> np.ndarray:
        """Share (N,N) of a diffuse albedo that a base colour loses where its program reflects first.

        The strength times the mean of F(h.v) over light from everywhere, seen from the front. Base colours are
        divided by what is left, so that the diffuse layer keeps its albedo.
        """
        steps = (np.arange(256) + 0.5) / 256
        # Light spread by its cosine: sin^2 is even. h halves its angle to the front.
        half = np.cos(np.arcsin(np.sqrt(steps)) / 2)
        mean = float((self.reflectance + (1 - self.reflectance) * (1 - half) ** 5).mean())
        return self.strength * mean

    @property
    def ior(self) -> float:
        root = self.reflectance**0.5
        return (1 + root) / (1 - root)


def dielectric(specular_albedo: np.ndarray, inside: np.ndarray) -> Dielectric:
    """For a specular albedo (N,N); texels outside the chart decide nothing."""
    largest = float(specular_albedo[inside].max())
    # Skin has no index beyond 1.6, so values of a map above 0.05 are cut there.
    reflectance = min(max(largest, F0), 0.0533)
    return Dielectric(reflectance, (specular_albedo / reflectance).clip(0, 1).astype(np.float32))

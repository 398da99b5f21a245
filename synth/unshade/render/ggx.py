"""The terms of the skin's highlights in numpy: GGX as in Walter et al., "Microfacet Models for Refraction through Rough
Surfaces", EGSR 2007, equations 33 and 34, and Schlick's Fresnel term (1994).

Nothing of the renderer is used, so that agreement with it is evidence.
"""

from __future__ import annotations

from typing import Any

import numpy as np

_F0 = 0.04


def density(cosine2: Any, alpha2: Any) -> Any:
    """D of half vectors, by the squares of their cosine to the normal and of the roughness alpha."""
    return alpha2 / (np.pi * (cosine2 * (alpha2 - 1) + 1) ** 2)


def masking(cosine: Any, alpha: float) -> Any:
    """G1 of a direction, by its cosine to the normal."""
    return 2 / (1 + np.sqrt(1 + alpha**2 * (1 / np.maximum(cosine, 1e-9) ** 2 - 1)))


def schlick(cosine: Any) -> Any:
    """F by the cosine between half vector and view, for a reflectance of 0.04 at normal incidence."""
    return _F0 + (1 - _F0) * (1 - cosine).clip(0, 1) ** 5

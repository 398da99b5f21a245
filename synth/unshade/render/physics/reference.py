"""The stated skin model once more, in double precision and numpy alone.

    f(v, l) cos = rho_d/pi max(n_d.l, 0)
                + rho_s/F0 sum_k w_k D_k(h) G1_k(v) G1_k(l) / (4 n_s.v) F(h.v)

D, G1 and F are those of `ggx`. Nothing of the renderer is used, so that agreement with it is evidence.
"""

from __future__ import annotations

import functools

import numpy as np

from ...vectors import unit
from ..ggx import density, masking, schlick
from .material import Skin

_F0 = 0.04
_STEPS = 256


def value(skin: Skin, wi: np.ndarray, wo: np.ndarray, part: str = "all") -> np.ndarray:
    """f cos [N] for directions towards the eye and the light [N, 3]; the mesh's normal is +z."""
    total = np.zeros(len(wo))
    if part != "specular":
        total += skin.diffuse / np.pi * (wo @ skin.diffuse_normal).clip(0)
    if part != "diffuse":
        n = skin.specular_normal
        h = unit(wi + wo)
        v, l = wi @ n, wo @ n
        seen = (v > 0) & (l > 0)
        lobes = sum(
            weight * density((h @ n) ** 2, alpha**2) * masking(v, alpha) * masking(l, alpha)
            for alpha, weight in skin.lobes
        )
        specular = skin.specular / _F0 * lobes * schlick((h * wi).sum(1)) / (4 * np.where(seen, v, 1))
        total += np.where(seen, specular, 0)
    return np.where((wi[:, 2] > 0) & (wo[:, 2] > 0), total, 0)


def albedo(skin: Skin, wi: np.ndarray, part: str = "all") -> float:
    """Share of the light from a direction [3] that is reflected, by quadrature.

    The Lambert term in closed form: a hemisphere about its normal, cut by the mesh's
    horizon, gives (1 + cos tilt)/2. A lobe over half vectors, spread such that D is flat.
    """
    total = 0.0
    if part != "specular":
        total += skin.diffuse * (1 + skin.diffuse_normal[2]) / 2
    if part != "diffuse":
        total += (
            skin.specular
            / _F0
            * sum(weight * _lobe_albedo(tuple(skin.specular_normal), tuple(wi), alpha) for alpha, weight in skin.lobes)
        )
    return total


@functools.cache
def _lobe_albedo(normal: tuple[float, ...], towards: tuple[float, ...], alpha: float) -> float:
    n, wi = np.array(normal), np.array(towards)
    if wi @ n <= 0:
        return 0.0
    # tan^2 of the half vector's angle = alpha^2 x/(1 - x) makes D cos dh = dx dphi / (2 pi).
    x, phi = np.meshgrid((np.arange(_STEPS) + 0.5) / _STEPS, 2 * np.pi * (np.arange(_STEPS) + 0.5) / _STEPS)
    tan = alpha * np.sqrt(x / (1 - x))
    cos = 1 / np.sqrt(1 + tan**2)
    right = np.cross(n, [0.0, 1.0, 0.0])
    right /= np.linalg.norm(right)
    up = np.cross(n, right)
    h = cos[..., None] * (n + tan[..., None] * (np.cos(phi)[..., None] * right + np.sin(phi)[..., None] * up))
    hv = h @ wi
    l = 2 * hv[..., None] * h - wi
    ln, vn = l @ n, float(wi @ n)
    ok = (hv > 0) & (ln > 0) & (l[..., 2] > 0)
    # dl = 4 (h.v) dh; D (n.h) dh is the measure above.
    estimate = masking(vn, alpha) * masking(np.where(ok, ln, 1), alpha) * schlick(hv) * hv / (cos * vn)
    return float(np.where(ok, estimate, 0).mean())

"""Object-space normal maps from the painted height and the smooth mesh."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter

from ..vectors import unit
from .texels import Texels

DIFFUSION_MM = 1.2
"""Standard deviation of the blur between specular and diffuse relief: light that entered the
skin leaves it after about a millimetre, and has averaged the relief over it (Ma et al. 2007)."""


def tangents(positions: np.ndarray, uv: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives dP/du and dP/dv (C,3) at the vertices of the chart, in metres per unit of UV."""
    edge1, edge2 = (positions[triangles[:, k]] - positions[triangles[:, 0]] for k in (1, 2))
    (u1, v1), (u2, v2) = ((uv[triangles[:, k]] - uv[triangles[:, 0]]).T[:, :, None] for k in (1, 2))
    area = u1 * v2 - u2 * v1
    per_triangle = (edge1 * v2 - edge2 * v1) / area, (edge2 * u1 - edge1 * u2) / area
    weight = np.abs(area[:, 0])
    total = sum(np.bincount(triangles[:, k], weight, minlength=len(positions)) for k in range(3))

    def gather(values: np.ndarray) -> np.ndarray:
        summed = [
            sum(np.bincount(triangles[:, k], weight * values[:, axis], minlength=len(positions)) for k in range(3))
            for axis in range(3)
        ]
        return np.stack(summed, axis=1) / total[:, None]

    return gather(per_triangle[0]), gather(per_triangle[1])


def smoothed(height: np.ndarray, texels: Texels, sigma: float) -> np.ndarray:
    """Height (M,) blurred over the chart alone, `sigma` in texels (normalised convolution)."""
    weight = gaussian_filter(texels.inside.astype(np.float32), sigma, mode="constant", truncate=3.0)
    blurred = gaussian_filter(texels.image(height.astype(np.float32)), sigma, mode="constant", truncate=3.0)
    return blurred[texels.inside] / weight[texels.inside]


def relief_normals(
    height: np.ndarray,
    texels: Texels,
    nearest: tuple[np.ndarray, np.ndarray],
    normal: np.ndarray,
    du: np.ndarray,
    dv: np.ndarray,
) -> np.ndarray:
    """Unit normals (M,3) f32 of the surface raised by `height` (M,) metres along the smooth `normal` (M,3).

    n = normalize(N - grad h), the surface gradient taken through the first fundamental
    form of the chart, whose tangents are `du`, `dv` (M,3). `nearest` extends the height
    over the rim, so that differences there are one-sided.
    """
    picture = texels.image(height.astype(np.float32))[nearest]
    size = len(picture)
    h_u = (np.gradient(picture, axis=1) * size)[texels.inside][:, None]
    h_v = (np.gradient(picture, axis=0) * -size)[texels.inside][:, None]
    e, f, g = ((a * b).sum(axis=1, keepdims=True) for a, b in ((du, du), (du, dv), (dv, dv)))
    gradient = ((g * h_u - f * h_v) * du + (e * h_v - f * h_u) * dv) / (e * g - f * f)
    # Interpolated tangents lean slightly out of the tangent plane; the gradient must not.
    gradient -= (gradient * normal).sum(axis=1, keepdims=True) * normal
    return unit(normal - gradient).astype(np.float32)

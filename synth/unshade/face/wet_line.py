"""The wet line: the rim of tears that stands between lower lid and eyeball."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter1d

from ..vectors import unit, vertex_normals
from .eyeball import clearance
from .geometry import Geometry, Part, textured_part
from .head import Head
from .lids import between, margin, margin_sides
from .regions import smoothstep

_HEIGHT = 0.00032
"""Height (m) of the meniscus on lid and eyeball; measured ones are 0.2 to 0.35 mm (Holly 1985)."""

_COLUMNS, _PROFILE, _SMOOTH = 120, 9, 2.0
"""Steps along the lid and across the meniscus, and the blur (steps) of its course along the lid."""

_OPEN = 0.0008, 0.0025
"""As the lids close from the second to the first opening (m), the meniscus vanishes between them."""

_CLEAR = 0.00001
"""The film ends this far (m) above the eyeball, so that neither surface cuts the other."""

_SPECULAR = 0.02
"""Reflectance of water at normal incidence (n = 1.336)."""

# Colours under the film: the lid's moist edge, then the white of the eye in the lid's shade.
_LID, _EYE = np.array([0.40, 0.25, 0.22]), np.array([0.42, 0.35, 0.31])


def make_wet_lines(head: Head, geometry: Geometry) -> list[Part]:
    """Parts `wet_line_left` and `wet_line_right`; an eye that is shut has none."""
    parts = []
    for name, eye, gaze in zip(("wet_line_left", "wet_line_right"), geometry.eyes, geometry.gaze):
        part = _wet_line(name, geometry.positions, head.part_chart, eye, gaze)
        if part is not None:
            parts.append(part)
    return parts


def _wet_line(
    name: str, positions: np.ndarray, triangles: np.ndarray, eye: np.ndarray, gaze: np.ndarray
) -> Part | None:
    crossing, fraction, hidden = margin(triangles, clearance(positions, eye, gaze))
    edge = between(positions, crossing, fraction)
    # From the hidden rim out over the lid's edge.
    skin = unit(positions[np.where(hidden[crossing[:, 0]], crossing[:, 1], crossing[:, 0])] - edge)
    upper, lower = margin_sides(triangles, crossing, hidden, edge)
    x = np.linspace(edge[lower, 0].min(), edge[lower, 0].max(), _COLUMNS + 2)[1:-1]

    def course(values: np.ndarray, side: np.ndarray) -> np.ndarray:
        order = np.argsort(edge[side, 0])
        columns = [np.interp(x, edge[side, 0][order], column) for column in values[side][order].T]
        return gaussian_filter1d(np.stack(columns, axis=1), _SMOOTH, axis=0, mode="nearest")

    opening = np.median((course(edge, upper) - course(edge, lower))[_COLUMNS // 4 : -_COLUMNS // 4, 1])
    height = _HEIGHT * float(smoothstep(*_OPEN, opening))
    if height == 0:
        return None
    root = _lowered(course(edge, lower), eye, gaze)
    along = unit(np.gradient(root, axis=0))
    outward = unit(root - eye[:3])
    up = unit(np.cross(outward, along))
    up *= np.sign(up[:, 1:2])
    skin = course(skin, lower)
    skin = unit(skin - (skin * along).sum(axis=1, keepdims=True) * along)
    ends = np.sin(np.pi * (np.arange(_COLUMNS) + 0.5) / _COLUMNS)[:, None] ** 0.4
    low, high = root + height * ends * skin, _lowered(root + height * ends * up, eye, gaze, _CLEAR)
    # A quadratic curve that is tangent to lid and eyeball: concave, as surface tension makes it.
    t = np.linspace(0, 1, _PROFILE)[:, None, None]
    surface = ((1 - t) ** 2 * low + 2 * t * (1 - t) * (root + _CLEAR * outward) + t**2 * high).transpose(1, 0, 2)
    strip = surface.reshape(-1, 3)
    i, k = (grid.ravel() for grid in np.meshgrid(np.arange(_COLUMNS - 1), np.arange(_PROFILE - 1), indexing="ij"))
    a = i * _PROFILE + k
    faces = np.concatenate(
        [np.stack([a, a + _PROFILE, a + _PROFILE + 1], 1), np.stack([a, a + _PROFILE + 1, a + 1], 1)]
    )
    if (vertex_normals(strip, faces) * (strip - eye[:3])).sum() < 0:
        faces = faces[:, [0, 2, 1]]
    uv = np.stack(np.meshgrid(np.linspace(0, 1, _COLUMNS), np.linspace(0, 1, _PROFILE), indexing="ij"), axis=-1)
    blend = (1 - (np.arange(16) + 0.5) / 16)[:, None, None]
    diffuse = np.repeat(_LID + blend * (_EYE - _LID), 4, axis=1)
    return textured_part(name, strip, faces, uv.reshape(-1, 2), diffuse, _SPECULAR)


def _lowered(points: np.ndarray, eye: np.ndarray, gaze: np.ndarray, clear: float = 0.0) -> np.ndarray:
    """Points (N,3) moved along the eyeball's radius to `clear` metres above its surface."""
    return points + unit(points - eye[:3]) * (clear - clearance(points, eye, gaze))[:, None]

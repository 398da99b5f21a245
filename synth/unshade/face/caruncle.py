"""The caruncle: the pink mound of flesh in the inner corner of the eye."""

from __future__ import annotations

import numpy as np

from ..vectors import unit
from .eyeball import clearance
from .geometry import Part, textured_part
from .opening import Opening
from .regions import smoothstep

_RADII = (0.0021, 0.0012, 0.0004)
"""Half its length, height and thickness, m."""

_INWARD = 0.0011
"""From the corner to its middle, m."""

_OPEN = 0.001, 0.004
"""Between these openings (m) of the lids it rises from the eyeball."""

_COLOUR = np.array([0.43, 0.24, 0.205])
_SPECULAR = 0.02
_RINGS, _SEGMENTS = 12, 24


def make_caruncles(openings: list[Opening]) -> list[Part]:
    """Parts `caruncle_left` and `caruncle_right`; an eye that is shut has none."""
    parts = []
    for name, opening in zip(("caruncle_left", "caruncle_right"), openings):
        rise = float(smoothstep(*_OPEN, opening.height))
        if rise == 0:
            continue
        sphere = opening.sphere
        along = unit(0.5 * (opening.upper[12] + opening.lower[12]) - opening.corner)
        middle = opening.corner + _INWARD * along
        outward = unit(middle - sphere[:3])
        middle = middle - outward * clearance(middle[None], sphere, opening.turn)[0]
        along = unit(along - (along @ outward) * outward)
        theta, phi = np.meshgrid(
            np.linspace(0, np.pi, _RINGS + 1), np.linspace(0, 2 * np.pi, _SEGMENTS + 1), indexing="ij"
        )
        ball = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
        frame = np.stack([_RADII[0] * along, _RADII[1] * np.cross(outward, along), rise * _RADII[2] * outward])
        surface = (middle - 0.0003 * outward + ball.reshape(-1, 3) @ frame).astype(np.float64)
        i, j = (g.ravel() for g in np.meshgrid(np.arange(_RINGS), np.arange(_SEGMENTS), indexing="ij"))
        a = i * (_SEGMENTS + 1) + j
        b = a + _SEGMENTS + 1
        faces = np.concatenate([np.stack([a, b, b + 1], 1)[i < _RINGS - 1], np.stack([a, b + 1, a + 1], 1)[i > 0]])
        uv = np.stack([phi / (2 * np.pi), 1 - theta / np.pi], axis=-1).reshape(-1, 2)
        parts.append(textured_part(name, surface, faces, uv, np.broadcast_to(_COLOUR, (2, 2, 3)), _SPECULAR))
    return parts

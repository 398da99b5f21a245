"""Lashes: tapering tubes along the edges of the lids, which shade the eye."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ..vectors import unit
from .geometry import Geometry, Part, textured_part
from .head import Head
from .opening import Opening
from .regions import smoothstep
from .spec import FaceSpec, stream

_COUNTS = (115, 60)
"""Lashes of the upper and the lower lid: people have 90 to 160 and 75 to 80, in rows that cross."""

_LENGTHS = ((0.0060, 0.0092), (0.0022, 0.0040))
"""Lengths (m) in the middle of the lid; measured ones are 8 to 12 and 6 to 8 mm, on lids a third wider."""

_RADII = (0.00006, 0.00004)
"""At the roots of upper and lower lashes, m; tips have a tenth of it."""

_RINGS, _SIDES = 8, 3

_EDGE = 0.0008
"""Roots lie this far (m) out over the lid's edge."""

_OPEN = (0.008, 0.001)
"""Heights (m) of the opening between which the upper lashes turn down."""

_SPECULAR = 0.008
"""Of lashes, which have the gloss of all textured parts: hair reflects 4 %, but off its own slope."""


def make_lashes(
    head: Head, geometry: Geometry, openings: list[Opening], colour: np.ndarray, spec: FaceSpec
) -> list[Part]:
    """Part `lashes` of both eyes; `colour` (3,) albedo."""
    skin = np.unique(head.part_chart)
    skin = skin[geometry.positions[skin, 2] > 0.04]
    places, normals = geometry.positions[skin], geometry.normals[skin]
    tree = cKDTree(places)
    tubes = []
    for opening in openings:
        for lid, up, count, lengths, radius in zip(
            (opening.upper, opening.lower), (1.0, -1.0), _COUNTS, _LENGTHS, _RADII
        ):
            rng = stream(spec.seed, "lashes", str(opening.side), str(up))
            tubes.append(_tubes(_curves(lid, up, count, lengths, opening, places, normals, tree, rng), radius))
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in tubes[:-1])])
    vertices = np.concatenate([vertices for vertices, _ in tubes])
    triangles = np.concatenate([triangles + start for (_, triangles), start in zip(tubes, starts)])
    picture = np.broadcast_to(colour, (2, 2, 3))
    return [textured_part("lashes", vertices, triangles, np.full((len(vertices), 2), 0.5), picture, _SPECULAR)]


def _curves(
    lid: np.ndarray,
    up: float,
    count: int,
    lengths: tuple[float, float],
    opening: Opening,
    places: np.ndarray,
    normals: np.ndarray,
    tree: cKDTree,
    rng: np.random.Generator,
) -> np.ndarray:
    """Points (count, _RINGS, 3) of one lid's lashes, root first; `up` +1 for the upper lid."""
    # None at the inner corner, where the tears drain.
    along = np.sort(rng.uniform(0.14, 0.985, count))
    at = along * (len(lid) - 1)
    low = np.minimum(at.astype(int), len(lid) - 2)
    edge = lid[low] + (at - low)[:, None] * (lid[low + 1] - lid[low])
    outward = unit(edge - opening.sphere[:3])
    tangent = unit(lid[np.minimum(low + 3, len(lid) - 1)] - lid[np.maximum(low - 3, 0)])
    rise = unit(np.cross(tangent, outward))
    rise *= up * np.sign(rise[:, 1:2])
    root = edge + _EDGE * rng.uniform(0.5, 1.1, (count, 1)) * unit(0.6 * outward + 0.8 * rise)
    nearest = tree.query(root)[1]
    normal = normals[nearest]
    # Onto the skin, and a little into it.
    root = root - normal * (((root - places[nearest]) * normal).sum(axis=1, keepdims=True) + 0.00015)
    # They fan out, and stick together by threes and fours.
    clumps = rng.normal(0, 0.06, count // 3 + 1)[np.arange(count) // 3]
    fan = (0.6 * (along - 0.3) + clumps + rng.normal(0, 0.05, count))[:, None]
    size = rng.uniform(*lengths, count) * (0.55 + 0.45 * np.sin(np.pi * np.clip(along, 0, 1)) ** 0.7)
    size = size * smoothstep(0.10, 0.35, along) ** 0.5
    curl = rng.normal(1.0, 0.08, count)[:, None]
    first = unit(outward + (0.10 if up > 0 else 0.25) * rise + fan * tangent)
    # A lid that closes turns its lashes down with it.
    shut = float(smoothstep(*_OPEN, opening.height))
    bend = 1.15 - 1.6 * shut if up > 0 else 0.7
    last = unit((0.35 if up > 0 else 0.6) * outward + bend * curl * rise + 1.5 * fan * tangent)
    t = np.linspace(0, 1, _RINGS)[None, :, None]
    directions = unit((1 - t) * first[:, None] + t * last[:, None])
    steps = directions * (size / (_RINGS - 1))[:, None, None]
    return root[:, None] + np.concatenate([np.zeros((count, 1, 3)), np.cumsum(steps[:, :-1], axis=1)], axis=1)


def _tubes(curves: np.ndarray, thickness: float) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and triangles of tubes round curves (K,R,3), closed at the tip, of radius `thickness` at the root."""
    count, rings, _ = curves.shape
    forward = unit(np.gradient(curves, axis=1))
    side = unit(np.cross(forward, np.broadcast_to([0.3, 0.2, 1.0], forward.shape)))
    other = np.cross(forward, side)
    turn = 2 * np.pi * np.arange(_SIDES) / _SIDES
    radius = thickness * (1 - 0.9 * np.linspace(0, 1, rings) ** 1.5)[None, :, None, None]
    ring = np.cos(turn)[:, None] * side[:, :, None] + np.sin(turn)[:, None] * other[:, :, None]
    vertices = (curves[:, :, None] + radius * ring).reshape(-1, 3)
    k, r, s = (g.ravel() for g in np.meshgrid(np.arange(count), np.arange(rings - 1), np.arange(_SIDES), indexing="ij"))
    a = (k * rings + r) * _SIDES + s
    b = (k * rings + r) * _SIDES + (s + 1) % _SIDES
    up = _SIDES
    triangles = np.concatenate([np.stack([a, b, b + up], axis=1), np.stack([a, b + up, a + up], axis=1)])
    last = (np.arange(count) * rings + rings - 1) * _SIDES
    return vertices, np.concatenate([triangles, last[:, None] + np.arange(_SIDES)])

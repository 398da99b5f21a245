"""Geometry of one face in the world, and the parts a renderer meets."""

from __future__ import annotations

import dataclasses

import numpy as np

from ..vectors import vertex_normals
from .eyeball import rotation
from .head import Head, fit_sphere
from .lid_motion import close_lids, lift_lids

EYES_TO_ORIGIN = 0.07
"""The world's origin lies this far (m) behind the midpoint of the eyes' centres: near the centre of the head."""


@dataclasses.dataclass(frozen=True)
class Chart:
    """The mesh given to solvers: smooth, one UV island, one uv per vertex.

    `vertices` (V,3) f32 m, `normals` (V,3) f32 unit, `uv` (V,2) f32, `triangles` (F,3) u32.
    """

    vertices: np.ndarray
    normals: np.ndarray
    uv: np.ndarray
    triangles: np.ndarray


@dataclasses.dataclass(frozen=True)
class SkinTexture:
    """Maps of a part that is painted like the chart: `uv` (V,2) f32, pictures (N,N,...) as those of `Maps`."""

    uv: np.ndarray
    diffuse: np.ndarray
    specular: np.ndarray
    diffuse_normal: np.ndarray
    specular_normal: np.ndarray
    roughness: np.ndarray


@dataclasses.dataclass(frozen=True)
class Part:
    """An occluder beside the chart.

    `vertices` (V,3) f32 m, `normals` (V,3) f32 unit, `triangles` (F,3) u32. Without `uv`,
    `diffuse` (V,3) f32 linear Rec.709 and `specular` (V,) f32 (0 to 0.05) hold one value per
    vertex; with `uv` (V,2) f32 they are textures (H,W,3) and (H,W), row 0 at v = 1. A `texture` is what pictures show in
    place of the values per vertex, which are its course without detail.
    """

    name: str
    vertices: np.ndarray
    normals: np.ndarray
    triangles: np.ndarray
    diffuse: np.ndarray
    specular: np.ndarray
    uv: np.ndarray | None = None
    texture: SkinTexture | None = None


def textured_part(
    name: str, positions: np.ndarray, triangles: np.ndarray, uv: np.ndarray, diffuse: np.ndarray, specular: float
) -> Part:
    """A part with a texture `diffuse` (H,W,3) and one reflectance `specular`."""
    return Part(
        name=name,
        vertices=positions.astype(np.float32),
        normals=vertex_normals(positions, triangles).astype(np.float32),
        triangles=triangles.astype(np.uint32),
        diffuse=diffuse.astype(np.float32),
        specular=np.full(diffuse.shape[:2], specular, dtype=np.float32),
        uv=uv.astype(np.float32),
    )


@dataclasses.dataclass(frozen=True)
class Geometry:
    """Subdivided joined mesh in world metres: `positions` and `normals` (V,3) f64; `eyes` (2,4) spheres, left first.

    `gaze` (2,3,3) the eyeballs' rotations, whose last column is the line of sight; `base`
    (B,3) the base positions, those inside the mouth among them.
    """

    positions: np.ndarray
    normals: np.ndarray
    eyes: np.ndarray
    gaze: np.ndarray
    base: np.ndarray


@dataclasses.dataclass(frozen=True)
class Pose:
    """An expression of one identity: `base` (B,3) m without blinking; how far each eye closes, (2,), left first,
    and `closing` (2,B,3) m, where the head data's targets move the lids."""

    base: np.ndarray
    blink: np.ndarray
    closing: np.ndarray


def place(head: Head, neutral: np.ndarray, pose: Pose | None = None) -> Geometry:
    """Subdivide base positions (B,3) and put the head at the origin.

    `neutral` decides where the head and its eyeballs are, `pose` what it does, if it does
    anything. Normals are those of the joined mesh, so parts meet without a seam.
    """
    eyes = np.stack([fit_sphere(neutral[e]) for e in head.eyes])
    origin = eyes[:, :3].mean(axis=0) - [0, 0, EYES_TO_ORIGIN]
    eyes[:, :3] -= origin
    positions, gaze, base = head.refine(neutral) - origin, np.stack([np.eye(3)] * 2), neutral
    if pose is not None:
        base = pose.base
        gaze = np.stack([rotation(neutral[e], base[e]) for e in head.eyes])
        positions = _posed(head, positions, head.refine(base) - origin, pose, eyes, gaze)
    triangles = np.concatenate([head.part_chart, head.part_rest, head.part_mouth, head.part_sockets])
    return Geometry(positions, vertex_normals(positions, triangles), eyes, gaze, base - origin)


def _posed(
    head: Head, resting: np.ndarray, moved: np.ndarray, pose: Pose, eyes: np.ndarray, gaze: np.ndarray
) -> np.ndarray:
    """Positions (V,3) of an expression with lids that neither sink into the eyeballs nor miss each other."""
    socket = np.unique(head.part_sockets)
    for eye, turn, weight, offset in zip(eyes, gaze, pose.blink, pose.closing):
        if weight > 0:
            moved = lift_lids(resting, moved, head.part_chart, socket, eye, turn)
            moved = close_lids(moved, head.refine(offset), weight, head.part_chart, eye, turn)
        moved = lift_lids(resting, moved, head.part_chart, socket, eye, turn)
    return moved

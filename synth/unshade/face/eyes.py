"""Eyeballs: spheres with a slight cornea, and their painted texture."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ..vectors import vertex_normals
from . import eyeball
from .geometry import Part
from .noise import smooth_noise
from .regions import smoothstep
from .spec import FaceSpec, stream

_RINGS, _SEGMENTS = 96, 128
_TEXTURE = (320, 512)

# Angles (degrees) from the optical axis. The pupil is a third as wide as the iris: indoor light.
_IRIS, _PUPIL = eyeball.IRIS, eyeball.IRIS / 3

_EYE_SPECULAR = 0.025
"""Reflectance of the tear film at normal incidence (n = 1.376)."""

# Iris in linear Rec.709: brown, hazel, green, blue-grey; lighter ones are rarer the darker the skin.
_IRIS_COLOURS = np.array([[0.050, 0.024, 0.012], [0.110, 0.065, 0.026], [0.110, 0.105, 0.050], [0.130, 0.165, 0.200]])
_IRIS_ODDS = {
    "I": (0.15, 0.2, 0.2, 0.45), "II": (0.3, 0.25, 0.2, 0.25), "III": (0.6, 0.25, 0.1, 0.05),
    "IV": (0.85, 0.15, 0.0, 0.0), "V": (0.95, 0.05, 0.0, 0.0), "VI": (1.0, 0.0, 0.0, 0.0),
}  # fmt: skip


_DENT, _DENT_REACH = 0.0004, (0.0008, 0.0016)
"""Under a lid's fold the eyeball gives way by so much (m), over so far (m)."""


def make_eyes(spheres: np.ndarray, gaze: np.ndarray, folds: list[np.ndarray], spec: FaceSpec) -> list[Part]:
    """Left and right eyeball for spheres (2,4) of centre and radius (m), turned by `gaze` (2,3,3) from +Z.

    `folds`: per eye the places (K,3) of skin that the eyeball must stay under (`lids.sunken_fold`).

    The texture's v runs from 1 at the front pole to 0 at the back, u once round the axis.
    """
    polar, around = np.linspace(0, np.pi, _RINGS + 1), np.linspace(0, 2 * np.pi, _SEGMENTS + 1)
    # Rings crowd towards the front, where the cornea and the iris are.
    polar = polar * (0.35 + 0.65 * polar / np.pi)
    theta, phi = np.meshgrid(polar, around, indexing="ij")
    outward = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
    surface = (outward * eyeball.height(theta)[..., None]).reshape(-1, 3)
    uv = np.stack([phi / (2 * np.pi), 1 - theta / np.pi], axis=-1).reshape(-1, 2).astype(np.float32)
    i, j = np.meshgrid(np.arange(_RINGS), np.arange(_SEGMENTS), indexing="ij")
    a = (i * (_SEGMENTS + 1) + j).ravel()
    b = a + _SEGMENTS + 1
    # The triangles that vanish at the poles are left out.
    front, back = (i > 0).ravel(), (i < _RINGS - 1).ravel()
    triangles = np.concatenate([np.stack([a, b, b + 1], 1)[back], np.stack([a, b + 1, a + 1], 1)[front]])
    normals = vertex_normals(surface, triangles).reshape(outward.shape)
    # The seam and the poles are several vertices at one point: give them one normal.
    seam = normals[:, 0] + normals[:, -1]
    normals[:, 0] = normals[:, -1] = seam / np.linalg.norm(seam, axis=-1, keepdims=True)
    normals[0], normals[-1] = (0, 0, 1), (0, 0, -1)
    diffuse, specular = _paint(spec)
    return [
        Part(
            name=name,
            vertices=_dented(sphere[:3] + sphere[3] * surface @ turn.T, sphere[:3], fold).astype(np.float32),
            normals=(normals.reshape(-1, 3) @ turn.T).astype(np.float32),
            triangles=triangles.astype(np.uint32),
            diffuse=diffuse,
            specular=specular,
            uv=uv,
        )
        for name, sphere, turn, fold in zip(("eye_left", "eye_right"), spheres, gaze, folds)
    ]


def _dented(surface: np.ndarray, centre: np.ndarray, fold: np.ndarray) -> np.ndarray:
    """The surface (V,3), drawn in where the skin of a lid's fold dips into it: unseen there, but it would show through."""
    if not len(fold):
        return surface
    distance, nearest = cKDTree(fold).query(surface)
    outward = surface - centre
    radius = np.linalg.norm(outward, axis=1)
    depth = np.maximum(radius - np.linalg.norm(fold[nearest] - centre, axis=1) + _DENT, 0) * smoothstep(
        *_DENT_REACH[::-1], distance
    )
    return surface - outward * (depth / radius)[:, None]


def _paint(spec: FaceSpec) -> tuple[np.ndarray, np.ndarray]:
    """Diffuse (H,W,3) and specular (H,W) texture f32: pupil, fibrous iris with a dark limbus, sclera with faint vessels."""
    rng = stream(spec.seed, "eyes")
    height, width = _TEXTURE
    theta = (np.arange(height) + 0.5) / height * 180
    phi = (np.arange(width) + 0.5) / width * 2 * np.pi
    t, p = (grid.ravel() for grid in np.meshgrid(theta, phi, indexing="ij"))
    direction = np.stack([np.cos(p), np.sin(p)], axis=1)
    # Fibres run outward: noise that varies fast round the axis, slowly along the radius.
    fibres = smooth_noise(np.column_stack([direction * 14, t / 9]).astype(np.float32), 1.0, rng)
    crypts = smooth_noise(np.column_stack([direction * 5, t / 4]).astype(np.float32), 1.0, rng)
    colour = _IRIS_COLOURS[rng.choice(4, p=_IRIS_ODDS[spec.fitzpatrick])] * rng.uniform(0.8, 1.2)
    light = (1 + 0.28 * fibres + 0.15 * crypts + 0.35 * np.exp(-(((t - 13) / 4) ** 2)))[:, None]
    limbus = 0.75 * np.exp(-(((t - _IRIS) / 2.6) ** 2))[:, None]
    iris = colour * np.clip(light, 0.3, 2) * (1 - limbus)

    # White, yellower with melanin and age; redder towards the corners.
    sclera = np.array([0.60, 0.55, 0.50]) * (1 - 0.10 * spec.age)
    vessels = np.clip(
        smooth_noise(np.column_stack([np.cos(p) * t, np.sin(p) * t, t]).astype(np.float32), 6.0, rng), 0, 2
    )
    corner = (smoothstep(35, 75, t) * (0.6 + 0.4 * vessels))[:, None]
    sclera = sclera * (1 - corner * np.array([0.12, 0.42, 0.45]))

    edge = smoothstep(_IRIS - 1.2, _IRIS + 1.6, t)[:, None]
    pupil = smoothstep(_PUPIL - 0.5, _PUPIL + 0.5, t)[:, None]
    diffuse = (0.003 + (iris * (1 - edge) + sclera * edge - 0.003) * pupil).reshape(height, width, 3)
    return np.clip(diffuse, 0, 1).astype(np.float32), np.full((height, width), _EYE_SPECULAR, dtype=np.float32)

"""Half an ellipsoid with painted maps: a truth without shadows, bounces, or mysteries."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from unshade._native import write_colour

SEMI_AXES = np.array([0.08, 0.11, 0.09])
"""Metres: x, y, z; the face is the half towards +z."""

_STEPS = 48
SPECULAR = 0.03


def _place(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points and unit normals (..., 3) of texture coordinates."""
    azimuth, elevation = (u - 0.5) * 2.4, (v - 0.5) * 2.4
    level = np.cos(elevation)
    sphere = np.stack([level * np.sin(azimuth), np.sin(elevation), level * np.cos(azimuth)], -1)
    normal = sphere / SEMI_AXES
    return sphere * SEMI_AXES, normal / np.linalg.norm(normal, axis=-1, keepdims=True)


def write_scene(
    folder: Path,
    *,
    size: int = 128,
    samples: int = 128,
    views: int = 5,
    specular: float = SPECULAR,
    light: str = 'kind = "dome"',
    waves: float = 0.12,
) -> Path:
    """A scene file with a mesh, colours, and normals that wave by some 8 degrees if ``waves`` says nothing else."""
    line = np.linspace(0, 1, _STEPS + 1)
    u, v = (part.ravel() for part in np.meshgrid(line, line))
    points, normals = _place(u, v)
    lines = ["o head", *("v %.9g %.9g %.9g" % tuple(p) for p in points), *("vt %.9g %.9g" % pair for pair in zip(u, v))]
    lines += ["vn %.9g %.9g %.9g" % tuple(n) for n in normals]
    for j in range(_STEPS):
        for i in range(_STEPS):
            a = j * (_STEPS + 1) + i + 1
            lines.append("f " + " ".join(f"{k}/{k}/{k}" for k in (a, a + 1, a + _STEPS + 2, a + _STEPS + 1)))
    (folder / "head.obj").write_text("\n".join(lines) + "\n")

    centre = (np.arange(size) + 0.5) / size
    u, v = np.meshgrid(centre, 1 - centre)
    wave = [0.5 + 0.5 * np.sin(2 * np.pi * (a * u + b * v)) for a, b in ((2, 1), (1, -2), (3, 0))]
    albedo = np.array([0.45, 0.3, 0.2]) * (0.6 + 0.4 * np.stack(wave, -1))
    normal = _place(u, v)[1]
    normal = normal + waves * np.stack([np.sin(4 * np.pi * u), np.sin(4 * np.pi * v), 0 * u], -1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    write_colour(folder / "albedo.exr", albedo.astype(np.float32))
    write_colour(folder / "normal.exr", normal.astype(np.float32))
    scene = folder / "scene.toml"
    scene.write_text(f"""
format = 1
name = "convex"
light = {{ name = "light", {light} }}
rig = {{ name = "few", kind = "phone", train = {views}, test = 1, max_angle_degrees = 40, seed = 2 }}
[face]
name = "convex"
mesh = "head.obj"
texture_size = {size}
origin = [0.0, 0.0, 0.0]
diffuse_albedo = "albedo.exr"
diffuse_albedo_space = "linear"
specular_albedo = {specular}
diffuse_normal = "normal.exr"
specular_normal = "normal.exr"
diffuse_normal_space = "object"
specular_normal_space = "object"
[render]
width = {size}
height = {size}
samples = {samples}
depth = 3
seed = 0
""")
    return scene

"""A small procedural head for the rendering tests."""

from __future__ import annotations

import numpy as np

from unshade.face import Chart, Face, FaceSpec, Maps, Part
from unshade.face.texels import rasterise

SPEC = FaceSpec("toy", 1, "III", 0.5, 0.5, (0.3, 0.3, 0.4), 0.5, texture_size=64)
STEPS = 40


def _bumpy_half(steps: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Front of an ovoid with a nose: positions, uv and triangles of a grid."""
    u, v = (a.ravel() for a in np.meshgrid(*[np.linspace(0, 1, steps)] * 2))
    azimuth, elevation = (u - 0.5) * 2.4, (v - 0.5) * 2.2
    level = np.cos(elevation)
    unit = np.stack([level * np.sin(azimuth), np.sin(elevation), level * np.cos(azimuth)], 1)
    nose = 0.02 * np.exp(-((azimuth / 0.25) ** 2) - (elevation / 0.3) ** 2)
    positions = unit * ([0.08, 0.11, 0.09] + nose[:, None])
    corner = (np.arange(steps - 1)[:, None] * steps + np.arange(steps - 1)).ravel()
    a, b, c, d = corner, corner + 1, corner + steps, corner + steps + 1
    triangles = np.concatenate([np.stack([a, b, d], 1), np.stack([a, d, c], 1)])
    return positions, 0.05 + 0.9 * np.stack([u, v], 1), triangles


def _normals(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    p = positions[triangles]
    facing = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    normals = np.zeros_like(positions)
    for k in range(3):
        np.add.at(normals, triangles[:, k], facing)
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def toy_face(spec: FaceSpec = SPEC) -> Face:
    """A chart with textured maps, a shoulder that occludes, and a textured ball for an eye."""
    positions, uv, triangles = _bumpy_half(STEPS)
    normals = _normals(positions, triangles)
    f32 = lambda a: a.astype(np.float32)
    chart = Chart(f32(positions), f32(normals), f32(uv), triangles.astype(np.uint32))

    texels = rasterise(uv, triangles, spec.texture_size)
    rows, columns = texels.nearest_inside()
    mesh_normal = texels.image(texels.sample(normals))[rows, columns]
    rng = np.random.default_rng(spec.seed)

    def tilted(amount: float) -> np.ndarray:
        n = mesh_normal + amount * rng.standard_normal(mesh_normal.shape)
        return f32(n / np.linalg.norm(n, axis=-1, keepdims=True))

    size = texels.inside.shape
    labels = np.where(texels.inside, 1 + (np.arange(size[1]) // 8) % 7, 0).astype(np.uint8)
    maps = Maps(
        diffuse_albedo=f32(rng.uniform(0.2, 0.6, (*size, 3))),
        specular_albedo=f32(rng.uniform(0.01, 0.05, size)),
        specular_normal=tilted(0.1),
        diffuse_normal=tilted(0.05),
        labels=labels,
        inside=texels.inside,
        roughness=f32(rng.uniform([0.12, 0.3, 0.4], [0.2, 0.4, 0.6], (*size, 3))),
    )
    shoulder = positions * [1.8, 0.5, 1.2] - [0.0, 0.15, 0.02]
    count = len(positions)
    parts = [
        Part("rest", f32(shoulder), f32(_normals(shoulder, triangles)), triangles.astype(np.uint32),
             np.full((count, 3), 0.4, np.float32), np.full(count, 0.03, np.float32)),
        Part("eye_left", f32(positions * 0.15 + [0.03, 0.02, 0.085]), f32(normals), triangles.astype(np.uint32),
             f32(rng.uniform(0.1, 0.9, (8, 8, 3))), np.full((8, 8), 0.025, np.float32), f32(uv)),
    ]  # fmt: skip
    return Face(spec, chart, parts, lambda: maps)


def toy_table(**render) -> dict:
    """A resolved scene of five training views, one withheld, in two lights."""
    return {
        "format": 1,
        "name": "toy",
        "face": SPEC.to_table(),
        "light": {"name": "studio", "kind": "studio"},
        "relight": [{"name": "uniform", "kind": "dome"}],
        "rig": {"name": "phone", "kind": "phone", "train": 3, "test": 1, "seed": 1},
        "render": {"width": 40, "height": 32, "samples": 16, "depth": 4} | render,
    }

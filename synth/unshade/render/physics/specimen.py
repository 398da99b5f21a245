"""The object that the rendering checks look at: made of formulas, so its truth is known.

A ball whose chart covers what a camera in front can see, and a ledge below that occludes
it and throws light back.
"""

from __future__ import annotations

import numpy as np

from ...camera.camera import Camera, look_at
from ...face import Chart, Part
from ...vectors import unit
from ..scene import ChartMaps, HeadScene

RADIUS = 0.1
"""Metres; the centre is the origin."""

_SPAN = 2.8
"""Azimuth and elevation (radians) over which u and v run, 0 in the middle."""


def ball_direction(uv: np.ndarray) -> np.ndarray:
    """Unit vectors [..., 3] from the centre at texture coordinates [..., 2], v up."""
    azimuth, elevation = np.moveaxis((np.asarray(uv, float) - 0.5) * _SPAN, -1, 0)
    level = np.cos(elevation)
    return np.stack([level * np.sin(azimuth), np.sin(elevation), level * np.cos(azimuth)], -1)


def ball(steps: int = 100) -> Chart:
    """The ball as a chart, seen from +z."""
    u, v = (a.ravel() for a in np.meshgrid(*[np.linspace(0, 1, steps)] * 2))
    uv = np.stack([u, v], 1)
    unit = ball_direction(uv)
    corner = (np.arange(steps - 1)[:, None] * steps + np.arange(steps - 1)).ravel()
    a, b, c, d = corner, corner + 1, corner + steps, corner + steps + 1
    triangles = np.concatenate([np.stack([a, b, d], 1), np.stack([a, d, c], 1)])
    return Chart(_f32(RADIUS * unit), _f32(unit), _f32(uv), triangles.astype(np.uint32))


def ledge() -> Part:
    """A flat ball under the chin."""
    whole = ball(40)
    scale = np.array([1.7, 0.45, 1.5])
    normals = unit(whole.normals / scale)
    return Part(
        "ledge", _f32(whole.vertices * scale + [0, -0.13, 0.01]), _f32(normals), whole.triangles,
        np.tile(np.float32([0.55, 0.4, 0.3]), (len(whole.vertices), 1)), np.full(len(whole.vertices), 0.03, np.float32),
    )  # fmt: skip


def varied_maps(size: int = 64) -> ChartMaps:
    """Maps that vary smoothly in everything a material has, roughness too."""
    grid = (np.arange(size) + 0.5) / size
    u, v = np.meshgrid(grid, 1 - grid)
    normal = ball_direction(np.stack([u, v], -1))
    wave = np.stack([np.sin(19 * u), np.cos(23 * v), 0 * u], -1)

    def tilted(amount: float) -> np.ndarray:
        return _f32(unit(normal + amount * wave))

    albedo = np.stack([0.45 + 0.2 * np.sin(7 * u + k) * np.cos(9 * v - k) for k in range(3)], -1)
    roughness = np.stack(
        [0.15 + 0.05 * np.sin(11 * u), 0.35 + 0.1 * np.cos(13 * v), 0.5 + 0.3 * np.sin(5 * (u + v))], -1
    )
    return ChartMaps(
        _f32(albedo), _f32(0.03 + 0.015 * np.sin(17 * v)), tilted(0.08), tilted(0.16), _f32(roughness),
    )  # fmt: skip


def head(maps: ChartMaps | None = None) -> HeadScene:
    """Ball and ledge, with varied maps by default."""
    return HeadScene(ball(), [ledge()], varied_maps() if maps is None else maps)


def camera(width: int = 48, height: int = 40, position=(0.12, 0.08, 0.5)) -> Camera:
    """A view of the ball that fills the picture's height."""
    distance = float(np.linalg.norm(position))
    return Camera(
        "000", width, height, 0.42 * height * distance / RADIUS, look_at(np.array(position), np.zeros(3)), True
    )


def _f32(values: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(values, dtype=np.float32)

"""A straight shadow on flat skin, seen from above, in every tier.

A black blade keeps a small lamp from half of a block of flesh, once nearly from above and
once from 45 degrees; the radiance across the edge of its shadow is what is compared.
"""

from __future__ import annotations

import igl
import numpy as np

from unshade.camera.camera import Camera, look_at
from unshade.face import Chart, Part
from unshade.render import lights
from unshade.render.scene import ChartMaps, HeadScene
from unshade.render.tiers import render_tier
from unshade.scene_file import Render

ALBEDO = 0.45
INCIDENCES = {"8 degrees": ((-0.06, 0.0, 0.42), 0.030), "45 degrees": ((-0.3, 0.0, 0.3), 0.010)}
"""Place of the lamp and height of the blade, metres."""
_EDGE, _STEPS, _DEPTH = 0.06, 13, 0.04
_PIXEL, _WIDE, _TALL = 0.4e-3, 40, 16


def shadow_edges(samples: int = 256) -> dict[str, tuple[np.ndarray, dict[str, np.ndarray]]]:
    """For each incidence the distances (P,) in mm from the shadow's edge into the light, and
    for each tier the radiance (P,3) there over that of the opaque skin far from the edge."""
    result = {}
    for name, (lamp, height) in INCIDENCES.items():
        head = _block(height)
        lamp = np.array(lamp)
        shadow = height * -lamp[0] / (lamp[2] - height)
        light = lights.Panels((lights.Panel.facing_head(lamp, 0.003, 0.003, 1.0),)).scaled(6e4)
        lit = head.lit(light)
        place = np.array([shadow, 0.0, 0.0])
        camera = Camera("edge", _WIDE, _TALL, 0.5 / _PIXEL, look_at(place + [0, 0, 0.5], place), True)
        rows = {}
        for tier in ("opaque", "diffusion", "volume"):
            render = Render(_WIDE, _TALL, samples=samples, depth=4, tier=tier)
            rows[tier] = render_tier(head, lit, camera.sensor(samples), render, 1).diffuse.astype(float).mean(0)
        far = rows["opaque"][-8:].mean(0)
        distance = (np.arange(_WIDE) + 0.5 - _WIDE / 2) * _PIXEL * 1e3
        result[name] = distance, {tier: row / far for tier, row in rows.items()}
    return result


def _block(blade: float) -> HeadScene:
    """A square of skin on a pyramid of flesh, and a blade over its left half."""
    u, v = (a.ravel() for a in np.meshgrid(*[np.linspace(0, 1, _STEPS)] * 2))
    corner = (np.arange(_STEPS - 1)[:, None] * _STEPS + np.arange(_STEPS - 1)).ravel()
    a, b, c, d = corner, corner + 1, corner + _STEPS, corner + _STEPS + 1
    triangles = np.concatenate([np.stack([a, b, d], 1), np.stack([a, d, c], 1)])
    top = np.stack([(u - 0.5) * _EDGE, (v - 0.5) * _EDGE, 0 * u], 1).astype(np.float32)
    chart = Chart(top, _normals(len(top), 1), np.stack([u, v], 1).astype(np.float32), triangles.astype(np.uint32))

    rim = np.asarray(igl.boundary_loop_all(np.asfortranarray(triangles.astype(np.int32)))[0])
    low = np.concatenate([top[rim], [[0, 0, -_DEPTH]]]).astype(np.float32)
    here = np.arange(len(rim))
    sides = np.stack([here, np.roll(here, -1), np.full(len(rim), len(rim))], 1)
    p = low[sides[0]]
    if np.cross(p[1] - p[0], p[2] - p[0]) @ p.mean(0) < 0:
        sides = sides[:, ::-1]
    flesh = Part(
        "rest", low, _normals(len(low), -1), sides.astype(np.uint32),
        np.full((len(low), 3), ALBEDO, np.float32), np.zeros(len(low), np.float32),
    )  # fmt: skip
    corners = np.array([[-0.1, -0.1, blade], [0, -0.1, blade], [0, 0.1, blade], [-0.1, 0.1, blade]], np.float32)
    both = np.array([[0, 1, 2], [0, 2, 3], [2, 1, 0], [3, 2, 0]], np.uint32)
    black = np.zeros((2, 2, 3), np.float32)
    cover = Part(
        "blade",
        corners,
        _normals(4, 1),
        both,
        black,
        black[..., 0],
        np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32),
    )
    return HeadScene(chart, [flesh, cover], ChartMaps(np.full((4, 4, 3), ALBEDO, np.float32)))


def _normals(count: int, side: int) -> np.ndarray:
    return np.repeat([[0, 0, side]], count, 0).astype(np.float32)

"""A coordinate probe: what lies where, solved from pictures, against the written conventions.

Marked texels: three texels of one map, each in its own channel, must light up at the
pixels where they project. Light: from the shading of a ball whose normals are known, the
direction of one bright texel of an environment, and of a small panel. Normals: from the
shading in three lights, the direction that a normal map holds. The expected values are
worked out here from the conventions alone (row 0 on top; v up, texel row 0 at v = 1; camera
x right, y up, looking along -z; lat-long d = (sin t sin p, cos t, -sin t cos p) with p at
column centres and rows from pole to pole), not by the code under test.

A probe that fails names the mistake that would explain what was seen.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from ...camera.camera import Camera
from ...files.pictures import read_rgb, write_exr
from ...vectors import unit
from ..lights import AnyLight, Dome, Environment, Panel, Panels
from ..passes import render_layers
from ..scene import ChartMaps, HeadScene
from . import specimen
from .verdict import Verdict

PIXELS = 0.7
"""Largest distance (pixels) between where a marked texel lies and where it should."""

DEGREES = 0.3
"""Largest angle between a direction solved for and the true one."""

CLEAR = 4.0
"""Every distinguishable mistake moves the observation by this many times the tolerance."""

_SIZE = 32
_MARKS = ((9, 20), (14, 8), (21, 18))
"""Row and column of the marked texels, with no symmetry between them."""

_SKY = (64, 128)
_TEXELS = ((20, 70), (14, 50), (30, 60))
"""Row and column of the bright texels, one a picture; all light the ball's front."""


def _same(array: np.ndarray) -> np.ndarray:
    return array


@dataclass(frozen=True)
class Pipeline:
    """Where a picture passes through on its way; tests put a mistake into one of them."""

    texture: Callable[[np.ndarray], np.ndarray] = _same
    """A map [N, N, ...] before it becomes a texture."""
    environment: Callable[[np.ndarray], np.ndarray] = _same
    """A lat-long picture before it becomes a light."""
    camera: Callable[[np.ndarray], np.ndarray] = _same
    """The matrix [4, 4] camera to world before it becomes a sensor."""
    normals: Callable[[np.ndarray], np.ndarray] = _same
    """A normal map before it becomes a texture."""
    picture: Callable[[np.ndarray], np.ndarray] = _same
    """A rendered picture [H, W, 3]."""


PROBES = ("marked texels", "environment", "panel", "normal map")


def check_orientation(pipeline: Pipeline | None = None, probes: Iterable[str] = PROBES) -> Verdict:
    """Renders the probes and solves them."""
    solve = dict(zip(PROBES, (_marks, _lights, _panel, _normal)))
    camera = specimen.camera(72, 56, position=(0.16, 0.11, 0.45))
    results = [solve[probe](camera, pipeline or Pipeline()) for probe in probes]
    faults = [fault for _, fault in results if fault]
    found = "; ".join(faults or [text for text, _ in results])
    return Verdict(
        "orientation",
        not faults,
        found,
        "render/scene.py (v), camera.py (axes), lights/ (environments) or pictures.py (rows)",
    )


def _shot(camera: Camera, maps: ChartMaps, light: AnyLight, pipeline: Pipeline) -> np.ndarray:
    """A picture [H, W, 3] of the ball, by way of a file as in a capture."""
    wrong = Camera(camera.name, camera.width, camera.height, camera.focal, pipeline.camera(camera.matrix), True)
    lit = HeadScene(specimen.ball(), [], maps).lit(light)
    layers = render_layers(lit, wrong.sensor(64), samples=64, depth=2, seed=1)
    with TemporaryDirectory() as folder:
        path = Path(folder) / "probe.exr"
        write_exr(path, {"": layers.total})
        return pipeline.picture(read_rgb(path)).astype(float)


def _maps(albedo: np.ndarray, pipeline: Pipeline, normal: np.ndarray | None = None) -> ChartMaps:
    """A matt chart."""
    normals = None if normal is None else pipeline.normals(np.broadcast_to(np.float32(normal), (4, 4, 3)).copy())
    return ChartMaps(np.ascontiguousarray(pipeline.texture(np.float32(albedo))), None, normals, None)


# --- marked texels -------------------------------------------------------------------------


def _marks(camera: Camera, pipeline: Pipeline) -> tuple[str, str]:
    albedo = np.zeros((_SIZE, _SIZE, 3), np.float32)
    for channel, (row, column) in enumerate(_MARKS):
        albedo[row, column, channel] = 1
    picture = _shot(camera, _maps(albedo, pipeline), Dome(), pipeline)
    x, y = np.meshgrid(np.arange(picture.shape[1]) + 0.5, np.arange(picture.shape[0]) + 0.5)
    if not (picture.sum((0, 1)) > 0).all():
        return "", "a marked texel that faces the camera is nowhere in the picture: camera axes, or u and v"
    seen = np.stack([[(x * c).sum() / c.sum(), (y * c).sum() / c.sum()] for c in np.moveaxis(picture, -1, 0)])
    expected = _expected_marks(camera)
    truth = expected["as stated"]
    misses = {name: float(np.abs(seen - there).max()) for name, there in expected.items()}
    clear = min(float(np.abs(there - truth).max()) for name, there in expected.items() if name != "as stated")
    return _judged("marked texels", PIXELS, "pixels", misses, clear)


def _expected_marks(camera: Camera) -> dict[str, np.ndarray]:
    """Pixels [3, 2] of the marks, as stated and with each mistake."""
    row, column = np.array(_MARKS, float).T
    uv = np.stack([(column + 0.5) / _SIZE, 1 - (row + 0.5) / _SIZE], 1)
    u, v = uv.T
    width, height = camera.width, camera.height
    textures = {
        "flipped v": (u, 1 - v),
        "flipped u": (1 - u, v),
        "u and v exchanged": (1 - v, 1 - u),
        "texture turned round": (1 - u, 1 - v),
    }
    truth = _project(camera, uv, np.eye(3))
    expected = {"as stated": truth}
    expected |= {name: _project(camera, np.stack(pair, 1), np.eye(3)) for name, pair in textures.items()}
    expected["flipped rows"] = truth * [1, -1] + [0, height]
    expected["flipped columns"] = truth * [-1, 1] + [width, 0]
    expected["picture turned round"] = [width, height] - truth
    axes = {"camera x reversed": (-1, 1, 1), "camera y reversed": (1, -1, 1)}
    expected |= {name: _project(camera, uv, np.diag(signs)) for name, signs in axes.items()}
    expected["camera x and y exchanged"] = _project(camera, uv, np.eye(3)[[1, 0, 2]])
    return expected


def _project(camera: Camera, uv: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Pixels of points of the ball: through the matrix of transforms.json, OpenGL axes."""
    frame = camera.frame()
    matrix = np.array(frame["transform_matrix"])
    # Camera coordinates of world points: the rotation's columns are the camera's axes.
    local = (specimen.RADIUS * specimen.ball_direction(uv) - matrix[:3, 3]) @ matrix[:3, :3] @ axes
    x = frame["cx"] + frame["fl_x"] * local[:, 0] / -local[:, 2]
    y = frame["cy"] - frame["fl_y"] * local[:, 1] / -local[:, 2]
    return np.stack([x, y], 1)


# --- light and normals ---------------------------------------------------------------------


def _ball_normals(camera: Camera) -> np.ndarray:
    """Unit normals [H, W, 3] of the ball at the pixel centres, NaN beside it."""
    x, y = np.meshgrid(
        np.arange(camera.width) + 0.5 - camera.width / 2, camera.height / 2 - np.arange(camera.height) - 0.5
    )
    d = np.stack([x, y, np.full_like(x, -camera.focal)], -1)
    d = unit(d) @ camera.matrix[:3, :3].T
    eye = camera.matrix[:3, 3]
    along = d @ eye
    inside = along**2 - eye @ eye + specimen.RADIUS**2
    distance = -along - np.sqrt(np.where(inside > 0, inside, np.nan))
    return (eye + distance[..., None] * d) / specimen.RADIUS


def _shading_direction(camera: Camera, picture: np.ndarray) -> np.ndarray:
    """Unit direction [3] to the one light that shades the ball, by least squares over lit pixels."""
    shade = picture.mean(-1)
    normals = _ball_normals(camera)
    # Clear of the terminator, where a pixel sees more than its centre, and of the chart's rim.
    towards = camera.matrix[:3, 3] / np.linalg.norm(camera.matrix[:3, 3])
    used = (shade > 0.15 * np.nanmax(shade)) & (np.nan_to_num(normals @ towards) > 0.62)
    if used.sum() < 20:
        return np.zeros(3)
    direction = np.linalg.lstsq(normals[used], shade[used], rcond=None)[0]
    return direction / np.linalg.norm(direction)


def _latlong(row: float, column: float) -> np.ndarray:
    """The written convention of lat-long pictures."""
    theta, phi = np.pi * row / (_SKY[0] - 1), 2 * np.pi * (column + 0.5) / _SKY[1]
    return np.array([np.sin(theta) * np.sin(phi), np.cos(theta), -np.sin(theta) * np.cos(phi)])


def _lights(camera: Camera, pipeline: Pipeline) -> tuple[str, str]:
    white = _maps(np.ones((4, 4, 3)), pipeline)
    solved = []
    for row, column in _TEXELS:
        sky = np.zeros((*_SKY, 3), np.float32)
        sky[row, column] = 1000
        light = Environment(np.ascontiguousarray(pipeline.environment(sky), dtype=np.float32))
        solved.append(_shading_direction(camera, _shot(camera, white, light, pipeline)))
    height, width = _SKY
    mistakes = {
        "as stated": lambda r, c: (r, c),
        "environment's rows flipped": lambda r, c: (height - 1 - r, c),
        "environment's columns flipped": lambda r, c: (r, width - 1 - c),
        "environment turned half round": lambda r, c: (r, c + width / 2),
        "environment a quarter to the left": lambda r, c: (r, c - width / 4),
        "environment a quarter to the right": lambda r, c: (r, c + width / 4),
    }
    expected = {name: np.stack([_latlong(*place(*texel)) for texel in _TEXELS]) for name, place in mistakes.items()}
    truth = expected["as stated"]
    expected["environment's axes y and z exchanged"] = truth[:, [0, 2, 1]]
    return _judged_directions("environment", np.stack(solved), expected)


def _panel(camera: Camera, pipeline: Pipeline) -> tuple[str, str]:
    """A small panel far away, off every axis."""
    place = np.array([12.0, 20.0, 32.0])
    picture = _shot(
        camera, _maps(np.ones((4, 4, 3)), pipeline), Panels((Panel.facing_head(place, 0.8, 0.8, 1000.0),)), pipeline
    )
    return _judged_directions(
        "panel", _shading_direction(camera, picture)[None], _axes_mistakes(place / np.linalg.norm(place), "panel's")
    )


def _normal(camera: Camera, pipeline: Pipeline) -> tuple[str, str]:
    """Photometric stereo: the one direction that a normal map holds all over."""
    normal = np.array([0.5, 0.3, 0.81])
    normal /= np.linalg.norm(normal)
    places = np.array([[26.0, 4.0, 18.0], [4.0, 26.0, 18.0], [-10.0, -6.0, 30.0]])
    maps = _maps(np.ones((4, 4, 3)), pipeline, normal)
    centre = np.nan_to_num(_ball_normals(camera) @ (camera.matrix[:3, 3] / np.linalg.norm(camera.matrix[:3, 3]))) > 0.9
    shades = []
    for place in places:
        # Radiance that makes the irradiance of a normal towards it pi: 0.64 m2 at this distance.
        light = Panels((Panel.facing_head(place, 0.8, 0.8, np.pi * (place @ place) / 0.64),))
        shades.append(_shot(camera, maps, light, pipeline)[centre].mean())
    solved = np.linalg.solve(places / np.linalg.norm(places, axis=1, keepdims=True), np.array(shades))
    length = np.linalg.norm(solved)
    return _judged_directions(
        "normal map", (solved / length if length > 0 else solved)[None], _axes_mistakes(normal, "normal map's")
    )


def _axes_mistakes(truth: np.ndarray, whose: str) -> dict[str, np.ndarray]:
    """A direction with its axes reversed or exchanged: [1, 3] each."""
    expected = {"as stated": truth[None]}
    for signs in product((1, -1), repeat=3):
        axes = [name for name, sign in zip("xyz", signs) if sign < 0]
        if axes:
            expected[f"{whose} {', '.join(axes)} reversed"] = (truth * signs)[None]
    for name, order in (("x and y", [1, 0, 2]), ("y and z", [0, 2, 1]), ("x and z", [2, 1, 0])):
        expected[f"{whose} {name} exchanged"] = truth[order][None]
    return expected


def _judged_directions(what: str, solved: np.ndarray, expected: dict[str, np.ndarray]) -> tuple[str, str]:
    def angle(a: np.ndarray, b: np.ndarray) -> float:
        return float(np.degrees(np.arccos((a * b).sum(-1).clip(-1, 1))).max())

    truth = expected["as stated"]
    clear = min(angle(truth, e) for name, e in expected.items() if name != "as stated")
    misses = {name: angle(solved, e) for name, e in expected.items()}
    return _judged(what, DEGREES, "degrees", misses, clear)


def _judged(what: str, tolerance: float, unit: str, misses: dict[str, float], clear: float) -> tuple[str, str]:
    """The finding in words, and the fault in words (empty if there is none).

    ``misses``: distance of what was seen from what each mistake would show; ``clear``: least
    distance between what is right and a mistake.
    """
    miss = misses["as stated"]
    text = f"{what} within {miss:.2f} {unit}"
    if clear < CLEAR * tolerance:
        return text, f"{what}: the probe cannot distinguish its mistakes ({clear:.1f} {unit})"
    if miss < tolerance:
        return text, ""
    best = min(misses, key=misses.get)
    if best != "as stated" and misses[best] < 2 * tolerance:
        return text, f"{what}: off by {miss:.1f} {unit}, as with {best}"
    return text, f"{what}: off by {miss:.1f} {unit}, as with no mistake known"

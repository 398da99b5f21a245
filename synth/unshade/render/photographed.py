"""Renders recovered maps on the mesh of a photographed capture, in the withheld views: in the light that the
method found, and in others. No truth is needed and none is there."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import drjit as dr
import mitsuba as mi
import numpy as np

from .. import _native
from ..errors import CaptureError, SceneError
from ..face import Chart
from ..fingerprint import fingerprint
from ..scene_file import Light, Render, read_table
from ..scene_file.light import parse_light
from .camera import Camera
from .folder import ResumableFolder, content_hash
from .given_light import GivenLight
from .lights.found import found_light
from .meter import Meter, Progress
from .passes import seed_of
from .picture_store import PictureStore
from .pictures import write_exr, write_text
from .relight import MAP_FILES, read_maps
from .shots import Shots

FOUND = "found"
"""The name of the light that a method found, as the scores know it."""

LIGHTS_FILE = "relight.toml"
"""Beside ``transforms.json``: the ``[[relight]]`` tables of other lights, as in a scene."""

_SAMPLES = 64


@dataclass(frozen=True)
class Photographed:
    """A mesh alone, as `shots.Shots` renders a face; nothing beside it is known."""

    chart: Chart
    parts: tuple[()] = ()

    @property
    def surface(self) -> Chart:
        return self.chart


@dataclass(frozen=True)
class Pinhole:
    """Rays of a pinhole with any principal point and two focal lengths, in the place of a `formation.Lens`."""

    focal: tuple[float, float]
    centre: tuple[float, float]
    matrix: np.ndarray

    def ray(self, column, row, sampler):
        """World ray from a film position in pixels (x right, y down)."""
        x = (column - _number(self.centre[0])) / _number(self.focal[0])
        y = (row - _number(self.centre[1])) / _number(self.focal[1])
        right, up, back = (mi.Vector3f(*map(_number, axis)) for axis in self.matrix[:3, :3].T)
        return mi.Ray3f(mi.Point3f(*map(_number, self.matrix[:3, 3])), dr.normalize(x * right - y * up - back))


def relight_photographed(
    folder: Path,
    maps: Path,
    out: Path,
    *,
    scales: Mapping[str, float],
    seed_offset: int = 0,
    given: GivenLight | None = None,
    progress: Progress,
    warn: Callable[[str], None],
) -> None:
    """Writes ``out/<scale>/<light>/<frame>.exr`` of every withheld frame of the capture in ``folder``.

    Lights are the ``given`` one, or ``found``, if the maps have one, and those of `LIGHTS_FILE`, by default a
    studio's and an even one. An interrupted call is taken up. Raises `CaptureError`, `MapsError` or `SceneError`.
    """
    chart_maps = read_maps(maps, warn)
    capture = _native.Capture(folder)
    if not capture.withheld:
        raise CaptureError(f"{folder}: has no withheld view to relight; import it with a holdout")
    others = [given.light] if given else _lights(folder)
    found = None if given else found_light(maps)
    render = Render(width=16, height=16, samples=_SAMPLES)
    hashes = [content_hash(maps / name) for name in (*(f"{name}.exr" for name in MAP_FILES), "light.exr", "solve.json")]
    inputs = [content_hash(folder / name) for name in ("transforms.json", "mesh.obj", LIGHTS_FILE)]
    key = f"{inputs}\n{fingerprint(__name__)}\n{hashes}\n{sorted(scales.items())}\n{seed_offset}"
    target = ResumableFolder(out, f"{key}\n{given.key}" if given else key)
    mesh = capture.mesh
    chart = Chart(mesh["vertices"], mesh["normals"], mesh["uvs"], mesh["triangles"])
    shots = Shots(Photographed(chart), chart_maps, render, PictureStore.of_user())  # type: ignore[arg-type]
    lights = [*([Light(FOUND, "envmap")] if found else []), *others]
    if found:
        shots.set_light(FOUND, found)
    if given:
        shots.set_light(given.light.name, given.model)
    jobs = [(scale, light, name) for scale in scales for light in lights for name in capture.withheld]
    first = capture.camera(capture.withheld[0])
    meter = Meter(progress, len(jobs), first["width"] * first["height"] * render.samples)
    current = None
    for scale, light, name in jobs:
        report = meter.begin(f"view {name} in {light.name}, scale {scale}")
        path = target.path / scale / light.name / f"{name}.exr"
        if path.exists():
            continue
        if scale != current:
            shots.set_diffuse_albedo(chart_maps.diffuse_albedo * np.float32(scales[scale]))
            current = scale
        stated = capture.camera(name)
        matrix = np.asarray(stated["camera_to_world"], float)
        focal, centre = tuple(map(float, stated["focal"])), tuple(map(float, stated["centre"]))
        camera = Camera(name, stated["width"], stated["height"], focal[0], matrix, train=False)
        seeds = (seed_of("relit", 0, seed_offset, light.name, view) for view in (name, "shared"))
        layers = shots.layers(light, camera, *seeds, report, Pinhole(focal, centre, matrix))  # type: ignore[arg-type]
        write_exr(path, {"": layers.total, **layers.channels()})
    document = {"scales": dict(scales), "samples": render.samples, "seed": 0, "seed_offset": seed_offset}
    write_text(target.path / "relit.json", json.dumps(document, indent=1) + "\n")
    target.commit()
    meter.note("relit")


def _lights(folder: Path) -> list[Light]:
    path = folder / LIGHTS_FILE
    if not path.is_file():
        return [Light("studio", "studio"), Light("uniform", "dome")]
    tables = read_table(path).get("relight")
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise SceneError(f"{path}: has no lights; write [[relight]] tables as in a scene")
    lights = [parse_light(table, f"relight of {path}", folder) for table in tables]
    names = [light.name for light in lights]
    if FOUND in names or len(set(names)) < len(names):
        raise SceneError(f"{path}: a light is called {FOUND} or as another; rename it")
    return lights


def _number(value: float):
    """Opaque to the compiler, so that all cameras share one kernel."""
    return dr.opaque(mi.Float, float(value)) if dr.is_jit_v(mi.Float) else float(value)

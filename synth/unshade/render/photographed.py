"""Renders recovered maps on the mesh of a photographed capture, which has no truth: in its withheld views, in the
light that the method found and in others."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

from .. import _native
from ..camera.camera import Camera
from ..errors import CaptureError, MapsError, SceneError
from ..face import Chart
from ..files.array_store import ArrayStore
from ..files.folder import ResumableFolder, content_hash
from ..fingerprint import fingerprint
from ..formation.lens import opaque
from ..scene_file import Light, Render, read_table
from ..scene_file.light import parse_light
from ..stated_light import StatedLight, stated_light
from .given_light import GivenLight
from .lights.found import found_lights, light_files
from .meter import Meter, Progress
from .relight import MAP_FILES, read_maps, write_relit
from .rigs import moving_with
from .shots import Shots

FOUND = "found"
"""The name of the light that a method found, as the scores know it."""

LIGHTS_FILE = "relight.toml"
"""Beside ``transforms.json``: the ``[[relight]]`` tables of other lights, as in a scene."""

_SAMPLES = 64


@dataclass(frozen=True)
class PhotographedHead:
    """A mesh without other parts, in the place of a face in `shots.Shots`."""

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
        x = (column - opaque(self.centre[0])) / opaque(self.focal[0])
        y = (row - opaque(self.centre[1])) / opaque(self.focal[1])
        right, up, back = (mi.Vector3f(*map(opaque, axis)) for axis in self.matrix[:3, :3].T)
        return mi.Ray3f(mi.Point3f(*map(opaque, self.matrix[:3, 3])), dr.normalize(x * right - y * up - back))


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
    found = {} if given else found_lights(maps)
    stated = stated_light(folder)
    views = [_view(capture.camera(name), name) for name in capture.withheld]
    own = Light(FOUND, "envmap")
    jobs = [(own, _as_found(camera, maps, found, stated), camera, lens) for camera, lens in views if found]
    jobs += [(light, light, camera, lens) for light in others for camera, lens in views]
    render = Render(width=16, height=16, samples=_SAMPLES)
    files = [*(maps / f"{name}.exr" for name in MAP_FILES), *light_files(maps).values(), maps / "solve.json"]
    hashes = [content_hash(path) for path in files]
    inputs = [content_hash(folder / name) for name in ("transforms.json", "mesh.obj", LIGHTS_FILE)]
    key = f"{inputs}\n{fingerprint(__name__)}\n{hashes}\n{sorted(scales.items())}\n{seed_offset}"
    target = ResumableFolder(out, f"{key}\n{given.key}" if given else key)
    mesh = capture.mesh
    chart = Chart(mesh["vertices"], mesh["normals"], mesh["uvs"], mesh["triangles"])
    shots = Shots(PhotographedHead(chart), chart_maps, render, ArrayStore.of_user())  # type: ignore[arg-type]
    for name, model in found.items():
        shots.set_light(FOUND + name, model)
    if given:
        shots.set_light(given.light.name, given.model)
    first = views[0][0]
    meter = Meter(progress, len(scales) * len(jobs), first.width * first.height * render.samples)
    write_relit(target, shots, jobs, scales, seed_offset, meter)


def _as_found(view: Camera, maps: Path, names: Collection[str], stated: StatedLight) -> Light:
    """The light of a view's photograph, one of those that a method found, by their ``names``."""
    name = "" if "" in names else stated.groups.get(view.name, "")
    if name not in names:
        raise MapsError(f"{maps}: has no light {name!r}, in which view {view.name} was taken; solve again")
    light = Light(FOUND + name, "envmap")
    return moving_with(view, light) if stated.frame == "camera" else light


def _view(stated: Mapping[str, Any], name: str) -> tuple[Camera, Pinhole]:
    matrix = np.asarray(stated["camera_to_world"], float)
    focal, centre = tuple(map(float, stated["focal"])), tuple(map(float, stated["centre"]))
    camera = Camera(name, stated["width"], stated["height"], focal[0], matrix, train=False)
    return camera, Pinhole(focal, centre, matrix)


def _lights(folder: Path) -> list[Light]:
    path = folder / LIGHTS_FILE
    if not path.is_file():
        return [Light("studio", "studio"), Light("uniform", "dome")]
    tables = read_table(path).get("relight")
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise SceneError(f"{path}: has no lights; write [[relight]] tables as in a scene")
    lights = [parse_light(table, f"relight of {path}", folder) for table in tables]
    names = [light.name for light in lights]
    if any(light.lights for light in lights):
        raise SceneError(f"{path}: a light is several lights; name each")
    if FOUND in names or len(set(names)) < len(names):
        raise SceneError(f"{path}: a light is called {FOUND} or as another; rename it")
    return lights

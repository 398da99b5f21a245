"""Renders recovered maps on the true head, in the lights and withheld views of a capture."""

from __future__ import annotations

import itertools
import shutil
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..camera.camera import Camera
from ..errors import MapsError
from ..files.array_store import ArrayStore
from ..files.folder import ResumableFolder, content_hash
from ..files.pictures import ROUGHNESS_CHANNELS, read_exr, read_gray, require_finite, write_exr, write_json
from ..fingerprint import fingerprint
from ..heads import build_head
from ..scene_file import Light, Scene
from .given_light import GivenLight
from .meter import Meter, Progress
from .passes import seed_of
from .rigs import cameras, light_of_view
from .scene import ChartMaps
from .scene_text import scene_text
from .shots import Shots

MAP_FILES = {
    "diffuse_albedo": tuple("RGB"),
    "specular_albedo": ("Y",),
    "diffuse_normal": tuple("RGB"),
    "specular_normal": tuple("RGB"),
    "roughness": ROUGHNESS_CHANNELS,
}
"""Maps of a folder and the channels of their EXR files."""


def relight(
    scene: Scene,
    maps: Path,
    out: Path,
    *,
    scales: Mapping[str, float],
    seed_offset: int = 0,
    given: GivenLight | None = None,
    progress: Progress,
    warn: Callable[[str], None],
) -> None:
    """Writes ``out/<scale>/<light>/<frame>.exr`` for the maps of a solver; ``given`` replaces the scene's lights.

    ``scene`` is the capture's own (`truth_scene.captured_scene`); each scale multiplies the
    recovered diffuse albedo before rendering. Pictures have as many samples as the truth
    and other seeds, so that the noise of the two is independent. An interrupted call is
    taken up as in `capture.synthesise`. Raises `MapsError` for maps that cannot be rendered.
    """
    chart_maps = read_maps(maps, warn)
    render = scene.render
    views = [camera for camera in cameras(scene.rig, render.width, render.height) if not camera.train]
    hashes = [content_hash(maps / f"{name}.exr") for name in MAP_FILES]
    key = f"{scene_text(scene)}\n{fingerprint(__name__)}\n{hashes}\n{sorted(scales.items())}\n{seed_offset}"
    folder = ResumableFolder(out, f"{key}\n{given.key}" if given else key)
    lights = [given.light] if given else scene.lights
    meter = Meter(progress, len(scales) * len(lights) * len(views), render.width * render.height * render.samples)
    meter.note("face")
    shots = Shots(build_head(scene.face), chart_maps, render, ArrayStore.of_user())
    if given:
        shots.set_light(given.light.name, given.model)
    jobs = [(light, light_of_view(scene, light, view), view, None) for light in lights for view in views]
    write_relit(folder, shots, jobs, scales, seed_offset, meter)


def write_relit(
    folder: ResumableFolder,
    shots: Shots,
    jobs: Sequence[tuple[Light, Light, Camera, Any]],
    scales: Mapping[str, float],
    seed_offset: int,
    meter: Meter,
) -> None:
    """Writes ``<scale>/<light>/<view>.exr`` for each job and the folder's ``relit.json``; then commits the folder. A job
    is a light, how that shines on the view, the camera, and its lens. Pictures that are there already are kept."""
    albedo, render = shots.maps.diffuse_albedo, shots.render
    current = None
    for scale, (light, shining, camera, lens) in itertools.product(scales, jobs):
        report = meter.begin(f"view {camera.name} in {light.name}, scale {scale}")
        path = folder.path / scale / light.name / f"{camera.name}.exr"
        if path.exists():
            continue
        twin = next(name for name in scales if scales[name] == scales[scale])
        if twin != scale:  # the same factor gives the same picture
            path.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(folder.path / twin / light.name / path.name, path)
            continue
        if scale != current:
            shots.set_diffuse_albedo(albedo * np.float32(scales[scale]))
            current = scale
        seeds = (seed_of("relit", render.seed, seed_offset, shining.name, name) for name in (camera.name, "shared"))
        layers = shots.layers(shining, camera, *seeds, report, lens)
        write_exr(path, {"": layers.total, **layers.channels()})
    document = {"scales": dict(scales), "samples": render.samples, "seed": render.seed, "seed_offset": seed_offset}
    write_json(folder.path / "relit.json", document)
    folder.commit()
    meter.finish("relit")


def read_maps(folder: Path, warn: Callable[[str], None]) -> ChartMaps:
    """The maps of a solver, of which all but the diffuse albedo may be missing.

    Texels outside its ``coverage.png`` may hold anything; values there that are not finite count as 0.
    """
    path = folder / "coverage.png"
    coverage = read_gray(path) if path.exists() else None
    found = {name: _read_map(folder / f"{name}.exr", channels, coverage) for name, channels in MAP_FILES.items()}
    if found["diffuse_albedo"] is None:
        raise MapsError(f"{folder}: diffuse_albedo.exr is missing; a face cannot be relit without it")
    for name in ("diffuse_albedo", "specular_albedo"):
        if found[name] is not None and (negative := int((found[name] < 0).sum())):
            warn(f"{folder / name}.exr: {negative} values are negative and count as 0")
            found[name] = found[name].clip(0)
    return ChartMaps(**found)


def _read_map(path: Path, channels: tuple[str, ...], coverage: np.ndarray | None) -> np.ndarray | None:
    if not path.exists():
        return None
    planes = read_exr(path, colour=path.stem == "diffuse_albedo", finite=False)
    missing = [channel for channel in channels if channel not in planes]
    if missing:
        raise MapsError(
            f"{path}: channel {missing[0]} is missing among {', '.join(sorted(planes))}; write {', '.join(channels)}"
        )
    values = np.stack([planes[channel] for channel in channels], -1)
    if values.shape[0] != values.shape[1]:
        raise MapsError(f"{path}: is {values.shape[1]} x {values.shape[0]} texels; write a square map")
    if coverage is not None and coverage.shape == values.shape[:2]:
        values[(coverage == 0) & ~np.isfinite(values).all(-1)] = 0
    require_finite(path, values, list(channels))
    return values if len(channels) > 1 else values[..., 0]

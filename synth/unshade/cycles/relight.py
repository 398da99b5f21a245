"""Recovered maps relit in Cycles: the pictures of `render.relight`, by a renderer that shares no code with it."""

from __future__ import annotations

import json
import shutil
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..export.surface import Mesh, Surface
from ..fingerprint import fingerprint
from ..heads import build_head
from ..render import lights
from ..render.folder import ResumableFolder, content_hash
from ..render.meter import Meter, Progress
from ..render.pictures import write_exr, write_text
from ..render.relight import MAP_FILES, read_maps
from ..render.rigs import cameras
from ..render.scene_text import scene_text
from ..scene_file import Scene
from . import description, interpreter
from .pictures import PASSES, read_layers, samples_each, seeds


def relight(
    scene: Scene,
    maps: Path,
    out: Path,
    *,
    scales: Mapping[str, float],
    seed_offset: int = 0,
    progress: Progress,
    warn: Callable[[str], None],
) -> None:
    """Writes ``out/<scale>/<light>/<frame>.exr`` as `render.relight.relight` does, rendered by Cycles.

    Maps of the truth make the true pictures: name the capture's ``truth`` folder as ``maps``. Raises
    `RendererError` where Blender is missing, `MapsError` for maps that cannot be rendered.
    """
    blender = interpreter.command()
    chart_maps = read_maps(maps, warn)
    render = scene.render
    if render.tier != "opaque":
        warn(f"tier {render.tier}: Cycles renders the opaque skin; compare with a capture of that tier")
    views = [camera for camera in cameras(scene.rig, render.width, render.height) if not camera.train]
    hashes = [content_hash(maps / f"{name}.exr") for name in MAP_FILES]
    key = f"cycles {blender} {scene_text(scene)}\n{fingerprint()}\n{hashes}\n{sorted(scales.items())}\n{seed_offset}"
    folder = ResumableFolder(out, key)
    pictures = len(set(scales.values())) * len(scene.lights) * len(views) * PASSES
    meter = Meter(progress, pictures, render.width * render.height * samples_each(render.samples))
    meter.note("face")
    face = build_head(scene.face)
    chart = face.chart
    mesh = Mesh(chart.vertices, chart.normals, chart.uv, chart.triangles.astype(np.int64))
    done: dict[float, str] = {}
    for scale, factor in scales.items():
        if factor in done:  # the same factor gives the same pictures
            shutil.copytree(folder.path / done[factor], folder.path / scale, dirs_exist_ok=True)
            continue
        done[factor] = scale
        scaled = replace(chart_maps, diffuse_albedo=chart_maps.diffuse_albedo * np.float32(factor))
        with tempfile.TemporaryDirectory(prefix="unshade-cycles-") as temporary:
            work = Path(temporary)
            job = description.write_job(
                work,
                meshes=description.write_meshes(work, Surface(mesh, scaled), face.parts),
                lights=[
                    description.write_light(work, light.name, lights.exposed(light, chart.vertices, chart.normals))
                    for light in scene.lights
                ],
                views=[
                    description.view(
                        view, {light.name: seeds(render.seed, seed_offset, light.name, view.name) for light in scene.lights}
                    )
                    for view in views
                ],
                samples=samples_each(render.samples),
                depth=render.depth,
                out=str(work / "pictures"),
            )
            interpreter.run(job, lambda what, scale=scale: meter.begin(f"{what}, scale {scale}")(1, 1))  # type: ignore[misc]
            for light in scene.lights:
                for view in views:
                    layers = read_layers(work / "pictures" / light.name, view.name)
                    path = folder.path / scale / light.name / f"{view.name}.exr"
                    write_exr(path, {"": layers.total, **layers.channels()})
    document = {
        "renderer": "cycles",
        "scales": dict(scales),
        "samples": samples_each(render.samples) * PASSES,
        "seed": render.seed,
        "seed_offset": seed_offset,
    }
    write_text(folder.path / "relit.json", json.dumps(document, indent=1) + "\n")
    folder.commit()
    meter.note("relit")

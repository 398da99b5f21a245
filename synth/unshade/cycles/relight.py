"""Recovered maps relit in Cycles: the pictures of `render.relight`, by a renderer that shares no code with it."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ..files.folder import ResumableFolder, content_hash
from ..files.pictures import write_exr, write_json
from ..fingerprint import fingerprint
from ..heads import build_head
from ..render import lights
from ..render.given_light import GivenLight
from ..render.meter import Meter, Progress
from ..render.relight import MAP_FILES, read_maps
from ..render.rigs import cameras, light_of_view
from ..render.scene_text import scene_text
from ..scene_file import Scene
from ..surface import Mesh, Surface
from . import description, interpreter
from .pictures import PASSES, read_layers, samples_each, seeds


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
    """Writes ``out/<scale>/<light>/<frame>.exr`` as `render.relight.relight` does, rendered by Cycles.

    Maps of the truth make the true pictures: name the capture's ``truth`` folder as ``maps``. Raises
    `RendererError` where Blender is missing, `MapsError` for maps that cannot be rendered.
    """
    blender = interpreter.command()
    chart_maps = read_maps(maps, warn)
    render = scene.render
    if render.material != "skin":
        warn(f"material {render.material}: Cycles renders the skin; compare with a capture of that material")
    if render.tier != "opaque":
        warn(f"tier {render.tier}: Cycles renders the opaque skin; compare with a capture of that tier")
    views = [camera for camera in cameras(scene.rig, render.width, render.height) if not camera.train]
    hashes = [content_hash(maps / f"{name}.exr") for name in MAP_FILES]
    key = f"cycles {blender} {scene_text(scene)}\n{fingerprint(__name__)}\n{hashes}\n{sorted(scales.items())}\n{seed_offset}"
    folder = ResumableFolder(out, f"{key}\n{given.key}" if given else key)
    pictures = len(set(scales.values())) * (1 if given else len(scene.lights)) * len(views) * PASSES
    meter = Meter(progress, pictures, render.width * render.height * samples_each(render.samples))
    meter.note("face")
    face = build_head(scene.face)
    chart, raised = face.chart, face.surface
    surface = Surface(Mesh(raised.vertices, raised.normals, raised.uv, raised.triangles.astype(np.int64)), chart_maps)
    exposed: dict[str, lights.AnyLight] = {}
    # For each view and light, the name of the light as it is turned for the view.
    shining: dict[tuple[str, str], str] = {}
    for light in [given.light] if given else scene.lights:
        for view in views:
            own = light_of_view(scene, light, view)
            name = light.name if own == light else f"{light.name}@{view.name}"
            shining[view.name, light.name] = name
            if name not in exposed:
                exposed[name] = given.model if given else lights.exposed(own, chart.vertices, chart.normals)
    first: dict[float, str] = {}
    for scale, factor in scales.items():
        target = folder.path / scale
        if first.setdefault(factor, scale) != scale:  # the same factor gives the same pictures
            shutil.copytree(folder.path / first[factor], target, dirs_exist_ok=True)
            continue
        if all((target / light / f"{view}.exr").exists() for view, light in shining):
            continue
        # Beside the pictures, so that an interrupted call leaves nothing elsewhere.
        work = folder.path / "cycles-work"
        shutil.rmtree(work, ignore_errors=True)
        work.mkdir()
        scaled = replace(chart_maps, diffuse_albedo=chart_maps.diffuse_albedo * np.float32(factor))
        job = description.write_job(
            work,
            meshes=description.write_meshes(work, replace(surface, maps=scaled), face.parts),
            lights=[description.write_light(work, name, light) for name, light in exposed.items()],
            views=[
                description.view(
                    view,
                    {
                        name: seeds(render.seed, seed_offset, light, view.name)
                        for (of_view, light), name in shining.items()
                        if of_view == view.name
                    },
                )
                for view in views
            ],
            samples=samples_each(render.samples),
            depth=render.depth,
            out=str((work / "pictures").resolve()),
        )

        def keep(
            event: dict[str, Any], scale: str = scale, target: Path = target, raw: Path = work / "pictures"
        ) -> None:
            meter.begin(f"{event['done']}, scale {scale}")(1, 1)
            if event["number"] == PASSES - 1:
                light, view = event["light"], event["view"]
                layers = read_layers(raw / light, view)
                write_exr(target / light.split("@")[0] / f"{view}.exr", {"": layers.total, **layers.channels()})

        interpreter.run(job, keep)
        shutil.rmtree(work)
    document = {
        "renderer": "cycles",
        "scales": dict(scales),
        "samples": samples_each(render.samples) * PASSES,
        "seed": render.seed,
        "seed_offset": seed_offset,
    }
    write_json(folder.path / "relit.json", document)
    folder.commit()
    meter.finish("relit")

"""A .blend with the skin as nodes: two GGX lobes and Lambert, each layer with its own object-space normal.

Made by Blender itself (`cycles.interpreter`); maps are packed as float pictures, so nothing is rounded. Light and
camera are the capture's, Z is up.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

from ..camera.camera import Camera
from ..cycles import description, interpreter
from ..cycles.pictures import read_layers, samples_each, seeds
from ..face import Part
from ..render.layers import Layers
from ..render.lights import AnyLight
from ..surface import Surface

FILE = "face.blend"


def write_blender(
    surface: Surface, folder: Path, light_name: str, light: AnyLight, camera: Camera, depth: int
) -> dict[str, Any]:
    """Writes ``face.blend``; returns the asset's description. Raises `RendererError` where Blender is missing."""
    with tempfile.TemporaryDirectory(prefix="unshade-blender-") as temporary:
        work = Path(temporary)
        job = description.write_job(
            work,
            meshes=description.write_meshes(work, surface, []),
            lights=[description.write_light(work, light_name, light)],
            views=[description.view(camera, {light_name: [0]})],
            samples=256,
            depth=depth,
            save=str((folder / FILE).resolve()),
        )
        interpreter.run(job, lambda _: None)
    return {
        "file": FILE,
        "material": "nodes: Diffuse BSDF, two Metallic BSDFs (GGX, F82 of base colour 0.04 and white edge) as weighted sums",
        "maps": "float, packed; normals in object space",
        "left_out": ["separable masking: Cycles' GGX correlates the heights of both directions"],
    }


def render_blend(path: Path, parts: list[Part], light_name: str, camera: Camera, depth: int, samples: int) -> Layers:
    """The file's own face, light and camera, with the other parts of the head put in."""
    with tempfile.TemporaryDirectory(prefix="unshade-blender-") as temporary:
        work = Path(temporary)
        job = description.write_job(
            work,
            open=str(path.resolve()),
            meshes=[description.write_part(work, part) for part in parts],
            lights=[{"name": light_name}],
            views=[description.view(camera, {light_name: seeds("fidelity", light_name)})],
            samples=samples_each(samples),
            depth=depth,
            out=str(work / "pictures"),
        )
        interpreter.run(job, lambda _: None)
        return read_layers(work / "pictures" / light_name, camera.name)

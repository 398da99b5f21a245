"""The lights that a method of pictures is to relight in, as it is handed them."""

from __future__ import annotations

from pathlib import Path

from ..files.folder import ResumableFolder
from ..files.pictures import write_exr
from ..fingerprint import fingerprint
from ..heads import build_head
from ..scene_file import Scene
from .lights import exposed
from .scene_text import scene_text


def write_lights(scene: Scene, out: Path) -> list[str]:
    """Writes ``out/<light>.exr`` for every light but the capture's own; returns their names.

    Linear Rec.709 radiance, lat-long in Mitsuba's convention, exposed for this face as the relit truth is.
    """
    folder = ResumableFolder(out, f"{fingerprint(__name__)}\n{scene_text(scene)}")
    chart = build_head(scene.face).chart
    others = [light for light in scene.lights if light.name != scene.light.name]
    for light in others:
        write_exr(folder.path / f"{light.name}.exr", {"": exposed(light, chart.vertices, chart.normals).latlong()})
    folder.commit()
    return [light.name for light in others]

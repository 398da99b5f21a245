"""Writes a scene back as TOML, with every default spelt out and the renderer's versions."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..own_head.keep import kept
from ..own_head.spec import HeadFiles
from ..scene_file import FORMAT, Light, Scene


def scene_text(scene: Scene) -> str:
    """TOML that `scene_file.read_scene` reads back to an equal scene."""
    tables: list[tuple[str, Mapping[str, Any]]] = [
        ("face", scene.face.to_table()),
        ("light", scene.light.to_table()),
        ("rig", scene.rig.to_table()),
        ("render", scene.render.to_table()),
        ("image_formation", scene.formation.to_table()),
        ("captured_mesh", scene.captured_mesh.to_table()),
        ("labels", scene.labels.to_table()),
        ("versions", scene.versions),
    ]
    blocks = [f"format = {FORMAT}\nname = {_value(scene.name)}\n"]
    blocks += [f"[{name}]\n{_lines(table)}" for name, table in tables if table]
    blocks += [f"[[relight]]\n{_lines(light.to_table())}" for light in scene.relight]
    return "\n".join(blocks)


def with_own_files(scene: Scene, lights: Path, head: Path) -> Scene:
    """The scene with the environment maps of its lights at ``lights/<light>.exr``, and the files
    of your own head in ``head``."""

    def moved(light: Light) -> Light:
        path = str(lights / f"{light.name}.exr") if light.path else None
        return replace(light, path=path, lights=tuple(map(moved, light.lights)))

    face = kept(scene.face, head) if isinstance(scene.face, HeadFiles) else scene.face
    return replace(scene, face=face, light=moved(scene.light), relight=tuple(map(moved, scene.relight)))


def _lines(table: Mapping[str, Any]) -> str:
    return "".join(f"{key} = {_value(value)}\n" for key, value in table.items())


def _value(value: Any) -> str:
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {_value(v)}" for key, v in value.items()) + " }"
    if isinstance(value, list) and value and isinstance(value[0], Mapping):
        return f"[{', '.join(map(_value, value))}]"
    # Texts (without DEL, which JSON leaves bare), numbers and booleans are spelt alike.
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")

"""A whole scene file."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import SceneError
from ..tables import Table
from .captured_mesh import CapturedMesh, parse_captured_mesh
from .face import AnyHead, parse_face
from .formation import Formation, parse_formation
from .labels import LabelFaults, parse_labels
from .light import Light, parse_light
from .render import Render, parse_render
from .rig import Rig, parse_rig

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

FORMAT = 1
_KEYS = (
    "format",
    "name",
    "face",
    "light",
    "relight",
    "rig",
    "render",
    "image_formation",
    "captured_mesh",
    "labels",
    "versions",
)


@dataclass(frozen=True)
class Scene:
    """Everything that a capture depends on, beside the renderer itself."""

    name: str
    face: AnyHead
    light: Light
    relight: tuple[Light, ...]
    rig: Rig
    render: Render
    versions: Mapping[str, str]
    """The renderer that made the capture; empty before there is one."""
    formation: Formation = Formation()
    captured_mesh: CapturedMesh = CapturedMesh()
    labels: LabelFaults = LabelFaults()

    @property
    def lights(self) -> tuple[Light, ...]:
        """The light of the capture, then the others."""
        return (self.light, *self.relight)

    @property
    def single_lights(self) -> tuple[Light, ...]:
        """The lights, with those of the capture one by one, each once."""
        return tuple(dict.fromkeys((*self.light.groups, *self.relight)))


def read_scene(path: Path) -> Scene:
    """Opens a resolved scene file. Raises `SceneError` (or `FaceError` for its face)."""
    return parse_scene(read_table(path), str(path), path.parent)


def read_table(path: Path) -> dict[str, Any]:
    """A TOML file. Raises `SceneError`."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise SceneError(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}") from error
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise SceneError(f"{path}: is not valid TOML: {error}") from error


def parse_scene(values: Mapping[str, Any], place: str, folder: Path) -> Scene:
    """Checks a scene's table; ``folder`` is what relative picture paths start from."""
    table = Table(values, place)
    table.require_known(_KEYS)
    if values.get("format") != FORMAT:
        raise SceneError(f"{place}: format is {values.get('format', 'missing')}; this version reads format = {FORMAT}")
    name = table.text("name")
    with SceneError.in_table("face"):
        face = parse_face(table.subtable("face"), f"[face] of {place}", folder)
    with SceneError.in_table("light"):
        light = parse_light(table.subtable("light"), f"[light] of {place}", folder)
    others = values.get("relight", [])
    if not isinstance(others, list) or not all(isinstance(other, dict) for other in others):
        raise SceneError(f"{place}: relight must be tables [[relight]]", key="relight")
    with SceneError.in_table("relight"):
        relight = tuple(
            parse_light(other, f"[[relight]] number {number} of {place}", folder)
            for number, other in enumerate(others, 1)
        )
    for one in relight:
        if one.lights:
            raise SceneError(f"{place}: relight has {one.name!r}, which is several lights; name each", key="relight")
    names = [light.name, *(one.name for one in dict.fromkeys((*light.lights, *relight)))]
    for one in names:
        if names.count(one) > 1:
            raise SceneError(f"{place}: two lights are named {one!r}; give each its own name")
    with SceneError.in_table("rig"):
        rig = parse_rig(table.subtable("rig"), f"[rig] of {place}")
    with SceneError.in_table("render"):
        render = parse_render(table.subtable("render"), f"[render] of {place}")
    with SceneError.in_table("image_formation"):
        formation = parse_formation(values.get("image_formation", {}), f"[image_formation] of {place}")
    with SceneError.in_table("captured_mesh"):
        captured_mesh = parse_captured_mesh(values.get("captured_mesh", {}), f"[captured_mesh] of {place}")
    with SceneError.in_table("labels"):
        labels = parse_labels(values.get("labels", {}), f"[labels] of {place}")
    return Scene(name, face, light, relight, rig, render, _versions(values, place), formation, captured_mesh, labels)


def _versions(values: Mapping[str, Any], place: str) -> dict[str, str]:
    versions = values.get("versions", {})
    if not isinstance(versions, dict) or not all(isinstance(v, str) for v in versions.values()):
        raise SceneError(f"{place}: [versions] must hold texts; it is written by synth, leave it out")
    return versions

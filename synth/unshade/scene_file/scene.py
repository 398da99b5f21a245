"""A whole scene file."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import SceneError
from .captured_mesh import CapturedMesh, parse_captured_mesh
from .checks import known_keys, subtable, text
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


def parse_scene(table: Mapping[str, Any], place: str, folder: Path) -> Scene:
    """Checks a scene's table; ``folder`` is what relative picture paths start from."""
    known_keys(table, _KEYS, place)
    if table.get("format") != FORMAT:
        raise SceneError(f"{place}: format is {table.get('format', 'missing')}; this version reads format = {FORMAT}")
    name = text(table, "name", place)
    face = parse_face(subtable(table, "face", place), f"[face] of {place}", folder)
    light = parse_light(subtable(table, "light", place), f"[light] of {place}", folder)
    others = table.get("relight", [])
    if not isinstance(others, list) or not all(isinstance(other, dict) for other in others):
        raise SceneError(f"{place}: relight must be tables [[relight]]")
    relight = tuple(
        parse_light(other, f"[[relight]] number {number} of {place}", folder) for number, other in enumerate(others, 1)
    )
    names = [one.name for one in (light, *relight)]
    for one in names:
        if names.count(one) > 1:
            raise SceneError(f"{place}: two lights are named {one!r}; give each its own name")
    rig = parse_rig(subtable(table, "rig", place), f"[rig] of {place}")
    render = parse_render(subtable(table, "render", place), f"[render] of {place}")
    if getattr(face, "displacement", False) and render.tier == "volume":
        raise SceneError(
            f'{place}: tier = "volume" fills the smooth head; leave displacement out, or set tier = "diffusion"'
        )
    formation = parse_formation(table.get("image_formation", {}), f"[image_formation] of {place}")
    captured_mesh = parse_captured_mesh(table.get("captured_mesh", {}), f"[captured_mesh] of {place}")
    labels = parse_labels(table.get("labels", {}), f"[labels] of {place}")
    return Scene(name, face, light, relight, rig, render, _versions(table, place), formation, captured_mesh, labels)


def _versions(table: Mapping[str, Any], place: str) -> dict[str, str]:
    versions = table.get("versions", {})
    if not isinstance(versions, dict) or not all(isinstance(v, str) for v in versions.values()):
        raise SceneError(f"{place}: [versions] must hold texts; it is written by synth, leave it out")
    return versions

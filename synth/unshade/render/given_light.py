"""A light that the caller of a relighting gives in the place of the capture's."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from ..files.folder import content_hash
from ..scene_file import Light
from .lights import Environment, environment


@dataclass(frozen=True)
class GivenLight:
    """A lat-long picture with the radiance that it has; ``key`` changes with its content."""

    light: Light
    model: Environment
    key: str


def given_light(path: Path) -> GivenLight:
    """Reads an EXR or Radiance file, called by its name. Raises `PictureError` or `SceneError`."""
    name = re.sub(r"[^A-Za-z0-9_-]+", "-", path.stem).strip("-") or "light"
    light = Light(name, "envmap", path=str(path))
    return GivenLight(light, environment(light), f"given {name} {content_hash(path)}")

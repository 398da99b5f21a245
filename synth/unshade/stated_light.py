"""How the light of a capture moves, as its ``transforms.json`` states it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .errors import CaptureError

LIGHT_FRAMES = ("head", "camera")
"""Frames of reference in which a light can stand still."""


@dataclass(frozen=True)
class StatedLight:
    """``frame`` is one of `LIGHT_FRAMES`; ``groups`` are the names of the lights of frames by their own names,
    empty if all share one light; ``has_unknown_exposure``: each frame has unknown factors on its channels."""

    frame: str
    groups: Mapping[str, str]
    has_unknown_exposure: bool = False

    @property
    def fault(self) -> str | None:
        """Why a method that assumes one still light cannot use the capture; None if it can."""
        if self.frame == "camera":
            return "the light moves with the camera (light_frame in transforms.json)"
        if self.has_unknown_exposure:
            return "exposures of frames are unknown (exposure in transforms.json)"
        if len(set(self.groups.values())) > 1:
            return "frames have different lights (light in transforms.json)"
        return None


def stated_light(capture: Path) -> StatedLight:
    """Reads the light of the capture folder ``capture``. Raises `CaptureError`."""
    path = capture / "transforms.json"
    try:
        document = json.loads(path.read_text(encoding="utf-8-sig"))
    except (OSError, ValueError) as error:
        raise CaptureError(f"{path}: cannot be read: {error}") from error
    try:
        names = {one.get("name") or Path(one["file_path"]).stem: one.get("light") for one in document["frames"]}
    except (AttributeError, KeyError, TypeError) as error:
        raise CaptureError(f"{path}: has no list of frames, each with a file_path") from error
    frame = light_frame_of(path, document)
    groups = {name: light for name, light in names.items() if light is not None}
    return StatedLight(frame, groups, document.get("exposure") == "unknown")


def light_frame_of(path: Path, document: Mapping[str, Any]) -> str:
    """The frame of reference in which the light stands still, by a ``transforms.json``. Raises `CaptureError`."""
    frame: str = document.get("light_frame", LIGHT_FRAMES[0])
    if frame not in LIGHT_FRAMES:
        raise CaptureError(f"{path}: light_frame is {frame!r}; write one of {', '.join(LIGHT_FRAMES)}")
    return frame

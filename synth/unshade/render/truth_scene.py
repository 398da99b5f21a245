"""The scene that a capture was rendered from, as it states itself."""

from __future__ import annotations

from pathlib import Path

from ..errors import CaptureError
from ..scene_file import Scene, read_scene


def captured_scene(capture: Path) -> Scene:
    """Reads ``capture/truth/scene.toml``. Raises `CaptureError` where it cannot be relit."""
    path = capture / "truth" / "scene.toml"
    if not path.is_file():
        raise CaptureError(f"{path}: is missing, so its lights are unknown; relight synthetic captures only")
    scene = read_scene(path)
    if "variant" not in scene.versions:
        raise CaptureError(f"{path}: [versions] names no variant; render the capture again")
    return scene

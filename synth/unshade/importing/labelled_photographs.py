"""The photographs that labels of cameras name: by group and path first; a label of several photographs is refused."""

from __future__ import annotations

import os
from pathlib import Path

from ..errors import CaptureError
from .view_names import tails, without_ending

_PICTURES = (".exr", ".tif", ".tiff", ".png", ".jpg", ".jpeg")

DEPTH = 4
"""Levels of folders that are searched below one that holds photographs."""


class LabelledPhotographs:
    """The photographs in and below some folders, by the ends of their paths in lower case, with and without endings.
    ``folders`` has the levels that are searched below each."""

    def __init__(self, folders: dict[Path, int]) -> None:
        self._folders = list(folders)
        self._at: dict[str, list[Path]] = {}
        """Photographs by their path below a folder, and in ``_below`` by every end of it."""
        self._below: dict[str, list[Path]] = {}
        for folder, depth in folders.items():
            for file in _pictures(folder, depth):
                path = file.relative_to(folder)
                for end in tails(path):
                    known = self._at if end == path.as_posix() else self._below
                    for key in {end.casefold(), without_ending(end).casefold()}:
                        if file not in known.setdefault(key, []):
                            known[key].append(file)

    def find(self, label: str, groups: list[str], camera: str) -> Path:
        """The photograph of a label: below the folder of a group, at the label's own path, then anywhere. The path
        where it should be if it is not there. Raises `CaptureError` if several could be meant; ``camera`` is named."""
        plain = label.replace("\\", "/").strip("/")
        name = plain.rsplit("/", 1)[-1]
        keys = [f"{group}/{name}" for group in groups if group] + list(dict.fromkeys((plain, name)))
        for key in keys:
            for known in (self._at, self._below):
                for form in (key.casefold(), without_ending(key).casefold()):
                    found = known.get(form, [])
                    if len(found) > 1:
                        raise CaptureError(
                            f"{camera}: {label!r} could be {found[0]} or {found[1]}; keep one of them, "
                            "or name the folder that holds one alone (--pictures)"
                        )
                    if found:
                        return found[0]
        return self._folders[-1] / plain


def _pictures(folder: Path, depth: int) -> list[Path]:
    found: list[Path] = []
    for place, folders, files in os.walk(folder):
        here = Path(place)
        deep = len(here.relative_to(folder).parts) >= depth
        folders[:] = [] if deep else sorted(name for name in folders if not name.startswith("."))
        found += [here / name for name in sorted(files) if Path(name).suffix.lower() in _PICTURES]
    return found

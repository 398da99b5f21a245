"""Pictures and painted maps kept by content, so that only what changed is made again.

The key of a value is the hash of all that decides it (`content_key`): for a picture shapes, maps, light, camera,
samples, seed, and the renderer's own sources and versions. So a store is never wrong, only full: the files that were
used longest ago make room.
"""

from __future__ import annotations

import contextlib
import os
import zipfile
from dataclasses import fields
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from ..cache_folder import cache_folder
from ..errors import StorageError

_Value = TypeVar("_Value")

SWITCH = "UNSHADE_RENDER_CACHE"
"""Environment variable: a folder, or ``off``."""

LIMIT_BYTES = 4 << 30


class ArrayStore:
    """``folder`` None keeps nothing."""

    def __init__(self, folder: Path | None, limit_bytes: int = LIMIT_BYTES) -> None:
        self.folder = folder
        self.limit_bytes = limit_bytes

    @classmethod
    def of_user(cls) -> ArrayStore:
        """The store of this machine's user: in `cache_folder`, or where `SWITCH` names."""
        said = os.environ.get(SWITCH)
        if said == "off":
            return cls(None)
        return cls(Path(said) if said else cache_folder() / "renders")

    def get(self, key: str, kind: type[_Value]) -> _Value | None:
        """The dataclass ``kind`` of arrays that has this key, if it is there and whole."""
        if self.folder is None:
            return None
        path = self._path(key)
        try:
            with np.load(path, allow_pickle=False) as stored:
                value = kind(**{name: stored[name] for name in stored.files})
            os.utime(path)
        except (OSError, ValueError, TypeError, EOFError, zipfile.BadZipFile):
            return None
        return value

    def put(self, key: str, value: Any) -> None:
        """Keeps a dataclass of arrays, of which some may be None. Raises `StorageError` if the folder cannot be written."""
        if self.folder is None:
            return
        path = self._path(key)
        partial = path.with_name(f"{path.name}.{os.getpid()}.partial")
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            with partial.open("wb") as file:
                arrays = {field.name: getattr(value, field.name) for field in fields(value)}
                np.savez(file, **{name: array for name, array in arrays.items() if array is not None})
            os.replace(partial, path)
            self._make_room()
        except OSError as error:
            with contextlib.suppress(OSError):
                partial.unlink()
            raise StorageError(
                f"{self.folder}: cannot keep a file: {error.strerror}; make room, let {SWITCH} name another folder, or {SWITCH}=off"
            ) from error

    def _path(self, key: str) -> Path:
        return self.folder / f"{key}.npz"

    def _make_room(self) -> None:
        files = []
        for path in self.folder.glob("*.npz"):
            with contextlib.suppress(OSError):  # another process may be making room too
                state = path.stat()
                files.append((state.st_mtime_ns, state.st_size, path))
        excess = sum(size for _, size, _ in files) - self.limit_bytes
        for _, size, path in sorted(files):
            if excess <= 0:
                break
            with contextlib.suppress(OSError):
                path.unlink()
            excess -= size

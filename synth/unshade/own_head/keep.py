"""Copies of a head's files, so that a capture can be lit again without the originals."""

from __future__ import annotations

import dataclasses
import shutil
from pathlib import Path

from ..files.pictures import unwritten
from .spec import HeadFiles


def kept(head: HeadFiles, folder: Path) -> HeadFiles:
    """``head`` with its files named as `keep` names them in ``folder``."""
    return dataclasses.replace(head, **{key: str(folder / _name(key, path)) for key, path in head.files().items()})


def keep(head: HeadFiles, folder: Path) -> None:
    """Copies all files of the head into ``folder``. Raises `StorageError`."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for key, path in head.files().items():
            shutil.copyfile(path, folder / _name(key, path))
    except OSError as error:
        raise unwritten(folder, error) from error


def _name(key: str, path: str) -> str:
    return f"{key}{Path(path).suffix.lower()}"

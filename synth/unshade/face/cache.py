"""The shared head on disk, because making it is slow."""

from __future__ import annotations

import contextlib
import dataclasses
import functools
import hashlib
import importlib.metadata
import io
import os
import zipfile
from pathlib import Path

import numpy as np

from ..cache_folder import cache_folder
from . import base_mesh, chart, expression, head, subdivide
from .head import Head, make_head


def _key() -> str:
    digest = hashlib.blake2b(digest_size=12)
    for module in (base_mesh, chart, expression, head, subdivide):
        digest.update(Path(module.__file__).read_bytes())
    for package in ("numpy", "scipy", "libigl"):
        digest.update(importlib.metadata.version(package).encode())
    digest.update(base_mesh.data_version().encode())
    return digest.hexdigest()


@functools.cache
def load_head(wide: bool = False) -> Head:
    """The shared head (see `make_head`): from the cache, else made and, where the folder can be written, kept.

    The key holds the sources that make the head and the versions of what they use. A
    file that cannot be read is made anew; a folder that cannot be written costs time only.
    """
    path = cache_folder() / f"head-{'wide-' if wide else ''}{_key()}.npz"
    try:
        with np.load(path, allow_pickle=False) as stored:
            return Head(**{field.name: stored[field.name] for field in dataclasses.fields(Head)})
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
        made = make_head(wide)
    partial = path.with_name(f"{path.name}.{os.getpid()}.partial")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        buffer = io.BytesIO()
        np.savez(buffer, **{field.name: getattr(made, field.name) for field in dataclasses.fields(Head)})
        partial.write_bytes(buffer.getvalue())
        partial.replace(path)
    except OSError:
        with contextlib.suppress(OSError):
            partial.unlink()
    return made

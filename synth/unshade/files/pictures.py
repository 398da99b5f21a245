"""Picture files: float EXRs whose channels have names, and 8-bit grey PNGs.

The solver's own reader reads them; faults are `PictureError`. A file is written beside its place as ``X.partial`` and
renamed. Equal pictures give equal bytes.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from .. import _native
from ..errors import PictureError, StorageError

ROUGHNESS_CHANNELS = ("alpha1", "alpha2", "share1")
"""Channels of a roughness map: GGX alphas of the two lobes, share of the first (all 0 to 1)."""


def write_exr(path: Path, channels: dict[str, np.ndarray]) -> None:
    """Writes float32 channels: ``{"": [H, W, 3]}`` as R, G, B, ``{"diffuse": ...}`` as
    diffuse.R and so on, ``{"Y": [H, W]}`` as one channel.

    Raises `PictureError` for NaN or infinity, `StorageError` if the file cannot be written.
    """
    names, planes = [], []
    for name, picture in channels.items():
        if picture.ndim == 2:
            names.append(name)
            planes.append(picture)
        else:
            names += [f"{name}.{c}" if name else c for c in "RGB"]
            planes += list(np.moveaxis(picture, -1, 0))
    stack = np.ascontiguousarray(np.stack(planes, -1), dtype=np.float32)
    require_finite(path, stack, names)
    # Mitsuba takes any LLVM if it is imported before one is chosen.
    import mitsuba as mi

    if names == ["R", "G", "B"]:
        bitmap = mi.Bitmap(stack, mi.Bitmap.PixelFormat.RGB)
    else:
        bitmap = mi.Bitmap(stack, mi.Bitmap.PixelFormat.MultiChannel, names)
    replace_file(path, lambda partial: bitmap.write(partial, mi.Bitmap.FileFormat.OpenEXR))


def write_gray(path: Path, picture: np.ndarray) -> None:
    """Writes an 8-bit grey PNG from an array [H, W] of uint8."""
    replace_file(path, lambda partial: Image.fromarray(picture).save(partial, format="PNG"))


def write_text(path: Path, text: str) -> None:
    """Writes a UTF-8 text file with Unix line ends."""
    write_bytes(path, text.encode())


def write_json(path: Path, document: Any, *, ensure_ascii: bool = True) -> None:
    """Writes a JSON file."""
    write_text(path, json.dumps(document, indent=1, ensure_ascii=ensure_ascii) + "\n")


def write_bytes(path: Path, data: bytes) -> None:
    """Writes a file, completely or not at all. Raises `StorageError`."""
    replace_file(path, lambda partial: Path(partial).write_bytes(data))


def read_exr(path: Path, *, colour: bool = False, finite: bool = True) -> dict[str, np.ndarray]:
    """All channels of a float EXR by name, each [H, W] float32; R, G, B are those of its colour layer.

    ``colour`` converts each R, G, B to linear Rec.709 where the file states other primaries;
    without it, as for normals and roughness, numbers are those of the file.
    """
    names, values = _native.read_exr(path, colour=colour, finite=finite)
    return {name: values[..., i] for i, name in enumerate(names)}


def read_rgb(path: str | Path) -> np.ndarray:
    """Linear Rec.709 radiance [H, W, 3] float32 of an EXR or Radiance HDR file, finite."""
    return _native.read_colour(path)


def read_light(path: str | Path) -> np.ndarray:
    """As `read_rgb`; refuses a picture that is not lat-long, 2 : 1, such as a cube map or a light probe."""
    return _native.read_light(path)


def read_gray(path: Path) -> np.ndarray:
    """An 8-bit grey PNG as [H, W] uint8."""
    return _native.read_gray(path)


def require_finite(path: str | Path, values: np.ndarray, names: list[str]) -> None:
    """Raises `PictureError` with the place of the first of ``values`` [H, W, C] that is NaN or infinite."""
    bad = np.argwhere(~np.isfinite(values))
    if len(bad):
        row, column, channel = bad[0]
        raise PictureError(
            f"{path}: {values[row, column, channel]} in channel {names[channel]} at column {column}, "
            f"row {row} ({len(bad)} values in all); radiance and maps must be finite"
        )


def make_folder(path: Path) -> None:
    """Makes a folder and those above it. Raises `StorageError`."""
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise unwritten(path, error) from error


def unwritten(path: Path, error: Exception) -> StorageError:
    """The error for a file or folder that cannot be written."""
    reason = getattr(error, "strerror", None) or str(error).strip().splitlines()[-1]
    return StorageError(f"{path}: cannot be written: {reason}; make room or choose another folder")


def replace_file(path: Path, write: Callable[[str], object]) -> None:
    """Lets ``write`` make a file beside ``path``, and renames it. Raises `StorageError`."""
    partial = path.with_name(f"{path.name}.partial")
    make_folder(path.parent)
    try:
        write(str(partial))
        os.replace(partial, path)
    except (OSError, RuntimeError) as error:
        partial.unlink(missing_ok=True)
        raise unwritten(path, error) from error

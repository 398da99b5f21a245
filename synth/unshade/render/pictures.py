"""Picture files: float EXRs whose channels have names, and 8-bit grey PNGs.

Written beside as ``X.partial`` and renamed; equal pictures give equal bytes.
"""

from __future__ import annotations

import os
from pathlib import Path

import mitsuba as mi
import numpy as np
from PIL import Image

from ..errors import PictureError, StorageError

ROUGHNESS_CHANNELS = ("alpha1", "alpha2", "share1")
"""Of a roughness map: GGX alphas of the two lobes, and the share of the first."""

_OPENEXR = mi.Bitmap.FileFormat.OpenEXR


def write_exr(path: Path, channels: dict[str, np.ndarray]) -> None:
    """Writes float32 channels: ``{"": [H, W, 3]}`` as R, G, B, ``{"diffuse": ...}`` as
    diffuse.R and so on, ``{"Y": [H, W]}`` as one channel.

    Raises `PictureError` for NaN or infinity, `StorageError` if it cannot be written.
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
    _require_finite(path, stack, names)
    if names == ["R", "G", "B"]:
        bitmap = mi.Bitmap(stack, mi.Bitmap.PixelFormat.RGB)
    else:
        bitmap = mi.Bitmap(stack, mi.Bitmap.PixelFormat.MultiChannel, names)
    _replace(path, lambda partial: bitmap.write(partial, _OPENEXR))


def write_gray(path: Path, picture: np.ndarray) -> None:
    """Writes an 8-bit grey PNG from an array [H, W] of uint8."""
    _replace(path, lambda partial: Image.fromarray(picture).save(partial, format="PNG"))


def write_text(path: Path, text: str) -> None:
    """Writes a UTF-8 text file with Unix line ends."""
    _replace(path, lambda partial: Path(partial).write_bytes(text.encode()))


def read_exr(path: Path) -> dict[str, np.ndarray]:
    """All channels of a float EXR by name, each [H, W] float32, finite."""
    bitmap = _open(path)
    names = [field.name for field in bitmap.struct_()]
    values = np.array(bitmap).astype(np.float32)
    values = values.reshape(*values.shape[:2], -1)
    _require_finite(path, values, names)
    return {name: values[..., i] for i, name in enumerate(names)}


def read_rgb(path: str | Path) -> np.ndarray:
    """Linear radiance [H, W, 3] float32 of an EXR or Radiance HDR file, finite."""
    bitmap = _open(Path(path)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)
    values = np.array(bitmap, dtype=np.float32)
    _require_finite(path, values, list("RGB"))
    return values


def read_gray(path: Path) -> np.ndarray:
    """An 8-bit grey PNG as [H, W] uint8."""
    try:
        with Image.open(path) as image:
            return np.array(image.convert("L"))
    except OSError as error:
        raise PictureError(f"{path}: cannot be read: {error}; write an 8-bit PNG") from error


def _open(path: Path) -> mi.Bitmap:
    if not path.is_file():
        raise PictureError(f"{path}: there is no such picture")
    try:
        return mi.Bitmap(str(path))
    except RuntimeError as error:
        reason = str(error).strip().splitlines()[-1]
        raise PictureError(f"{path}: cannot be read: {reason}; write it as a float EXR") from error


def _require_finite(path: str | Path, values: np.ndarray, names: list[str]) -> None:
    bad = np.argwhere(~np.isfinite(values))
    if len(bad):
        row, column, channel = bad[0]
        raise PictureError(
            f"{path}: {values[row, column, channel]} in channel {names[channel]} at column {column}, "
            f"row {row} ({len(bad)} values in all); radiance and maps must be finite"
        )


def _replace(path: Path, write) -> None:
    partial = path.with_name(f"{path.name}.partial")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write(str(partial))
        os.replace(partial, path)
    except (OSError, RuntimeError) as error:
        partial.unlink(missing_ok=True)
        reason = getattr(error, "strerror", None) or str(error).strip().splitlines()[-1]
        raise StorageError(f"{path}: cannot be written: {reason}; make room or choose another folder") from error

"""Textures as files: PNG of 8 or 16 bits, float EXR."""

from __future__ import annotations

import io
from pathlib import Path

import mitsuba as mi
import numpy as np
from PIL import Image

from ..files.pictures import write_bytes
from ..srgb import encoded


def srgb(linear: np.ndarray) -> np.ndarray:
    """Codes 0 to 1 of linear values (IEC 61966-2-1), clipped to what they can hold."""
    return encoded(np.clip(linear, 0, 1))


def encoded_normals(normals: np.ndarray, *, green_up: bool = True) -> np.ndarray:
    """Unit vectors (N,N,3) as codes 0 to 1."""
    codes = normals * 0.5 + 0.5
    if not green_up:
        codes = np.concatenate([codes[..., :1], 1 - codes[..., 1:2], codes[..., 2:]], -1)
    return codes


def png_bytes(codes: np.ndarray, bits: int) -> bytes:
    """A PNG of codes 0 to 1: (N,N) grey, (N,N,3) RGB, (N,N,4) RGBA, 8 or 16 bits."""
    maximum = (1 << bits) - 1
    samples = np.rint(np.clip(codes, 0, 1) * maximum).astype(np.uint16 if bits == 16 else np.uint8)
    if bits == 8:
        stream = io.BytesIO()
        Image.fromarray(samples).save(stream, format="PNG")
        return stream.getvalue()
    # Pillow has no RGB of 16 bits.
    samples = np.ascontiguousarray(samples[..., None] if samples.ndim == 2 else samples)
    stream = mi.MemoryStream()
    mi.Bitmap(samples).write(stream, mi.Bitmap.FileFormat.PNG)
    stream.seek(0)
    return bytes(stream.read(stream.size()))


def write_png(path: Path, codes: np.ndarray, bits: int) -> None:
    """Writes `png_bytes`. Raises `StorageError`."""
    write_bytes(path, png_bytes(codes, bits))

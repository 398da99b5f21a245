"""Map files as square arrays of the chart's texels, with colours decoded to linear."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import mitsuba as mi
import numpy as np
from PIL import Image

from ..errors import PictureError
from ..face.spec import FaceError
from ..render.pictures import ROUGHNESS_CHANNELS, read_exr

_ORDERS = (tuple("RGB"), tuple("XYZ"), ROUGHNESS_CHANNELS)
"""Channels of an EXR with three values a texel."""


def read_picture(path: str) -> np.ndarray:
    """Values [H, W, 3] f32 as they are in the file; PNGs from 0 to 1, grey ones repeated."""
    planes = _exr(Path(path)) if path.lower().endswith(".exr") else _png(Path(path))
    return planes if planes.shape[-1] == 3 else np.repeat(planes[..., :1], 3, -1)


def read_labels(path: str, size: int) -> np.ndarray:
    """Region ids [size, size] u8 of a grey PNG, nearest texels."""
    try:
        with Image.open(path) as image:
            if image.mode not in ("L", "P", "I", "I;16", "1"):
                raise FaceError(f"{path}: labels are of mode {image.mode}; write one grey channel of region ids")
            ids = np.array(image).astype(np.int64)
    except OSError as error:
        raise PictureError(f"{path}: cannot be read: {error}; write an 8-bit PNG") from error
    rows, columns = ((np.arange(size) + 0.5) / size * extent for extent in ids.shape)
    ids = ids[rows.astype(int)[:, None], columns.astype(int)]
    return ids.clip(-1, 255).astype(np.uint8)


def linear(values: np.ndarray, space: str) -> np.ndarray:
    """Linear values of sRGB-coded ones (IEC 61966-2-1)."""
    if space == "linear":
        return values
    return np.where(values <= 0.04045, values / 12.92, ((values.clip(0.04045) + 0.055) / 1.055) ** 2.4).astype(np.float32)


def resampled(values: np.ndarray, nearest: Callable[[int], tuple[np.ndarray, np.ndarray]], size: int) -> np.ndarray:
    """A map [H, W, C] at ``size`` x ``size`` texels.

    What lies outside the UV islands in the file is replaced by the nearest texel inside
    before anything is averaged, so no background bleeds in over their rims. ``nearest``
    gives row and column of that texel for a square map of any side.
    """
    side = max(values.shape[:2])
    return _resized(_resized(values, side)[nearest(side)], size)


def _resized(values: np.ndarray, size: int) -> np.ndarray:
    """Bilinear where it grows, weighed over the covered texels where it shrinks."""
    if values.shape[:2] == (size, size):
        return np.ascontiguousarray(values, dtype=np.float32)
    planes = [
        np.asarray(Image.fromarray(np.ascontiguousarray(plane, dtype=np.float32)).resize((size, size), Image.Resampling.BILINEAR))
        for plane in np.moveaxis(values, -1, 0)
    ]
    return np.stack(planes, -1)


def _exr(path: Path) -> np.ndarray:
    planes = read_exr(path)
    for order in _ORDERS:
        if all(channel in planes for channel in order):
            return np.stack([planes[channel] for channel in order], -1)
    if "Y" in planes or len(planes) == 1:
        return next(iter(planes.values()))[..., None] if "Y" not in planes else planes["Y"][..., None]
    raise FaceError(f"{path}: has the channels {', '.join(sorted(planes))}; write R, G, B, or one channel")


def _png(path: Path) -> np.ndarray:
    # Not through Pillow, which cuts 16-bit colours down to 8.
    try:
        values = np.array(mi.Bitmap(str(path)))
    except RuntimeError as error:
        reason = str(error).strip().splitlines()[-1]
        raise PictureError(f"{path}: cannot be read: {reason}; write an 8- or 16-bit PNG") from error
    values = values.reshape(*values.shape[:2], -1)
    largest = np.iinfo(values.dtype).max
    # One or two channels are grey without and with alpha, four are colour with alpha.
    return values[..., : 1 if values.shape[-1] < 3 else 3].astype(np.float32) / np.float32(largest)

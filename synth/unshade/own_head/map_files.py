"""Map files as square arrays of the chart's texels, with colours decoded to linear."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from PIL import Image

from .. import _native
from ..face.spec import FaceError
from ..files.pictures import ROUGHNESS_CHANNELS, read_exr
from ..srgb import decoded

_ORDERS = (tuple("RGB"), tuple("XYZ"), ROUGHNESS_CHANNELS)
"""Channels of an EXR with three values a texel."""


def read_picture(path: str, *, colour: bool = False) -> np.ndarray:
    """Values [H, W, 3] f32 as they are in the file; PNGs from 0 to 1, grey ones repeated.

    An EXR's ``colour`` is converted to linear Rec.709 if the file states other primaries.
    """
    planes = _planes(path, colour)
    return planes if planes.shape[-1] == 3 else np.repeat(planes[..., :1], 3, -1)


def read_normals(path: str) -> np.ndarray:
    """Vectors [H, W, 3] f32: of an EXR as they are, of a PNG 2 v - 1. Refuses what holds no vectors."""
    vectors = _planes(path, False)
    if vectors.shape[-1] != 3:
        raise FaceError(f"{path}: has one channel, as a bump map; write normals as R, G, B")
    if _is_png(path):
        return 2 * vectors - 1
    if _coded(vectors):
        raise FaceError(
            f"{path}: holds n/2 + 1/2, not unit vectors n; write 2 v - 1 as float EXR, or a 16-bit PNG, which is decoded"
        )
    return vectors


def _coded(vectors: np.ndarray) -> bool:
    """Whether no vector is near unit length as it is, but as 2 v - 1."""
    length, decoded = np.linalg.norm(vectors, axis=-1), np.linalg.norm(2 * vectors - 1, axis=-1)
    known = (length > 0.1) & (decoded > 0.1)
    if not known.any() or vectors[known].min() < -0.01:
        return False
    off, off_decoded = (np.median(np.abs(a[known] - 1)) for a in (length, decoded))
    return bool(off > 0.03 and off_decoded < 0.03)


def read_labels(path: str, size: int) -> np.ndarray:
    """Region ids [size, size] u8 of a grey PNG, nearest texels."""
    ids = _native.read_ids(path).astype(np.int64)
    rows, columns = ((np.arange(size) + 0.5) / size * extent for extent in ids.shape)
    ids = ids[rows.astype(int)[:, None], columns.astype(int)]
    return ids.clip(0, 255).astype(np.uint8)


def linear(values: np.ndarray, space: str) -> np.ndarray:
    """Linear values of sRGB-coded ones (IEC 61966-2-1)."""
    if space == "linear":
        return values
    return decoded(values).astype(np.float32)


def resampled(values: np.ndarray, nearest: Callable[[int], tuple[np.ndarray, np.ndarray]], size: int) -> np.ndarray:
    """A map [H, W, C] at ``size`` x ``size`` texels.

    Texels outside the UV islands in the file are replaced by the nearest texel inside
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
        np.asarray(
            Image.fromarray(np.ascontiguousarray(plane, dtype=np.float32)).resize(
                (size, size), Image.Resampling.BILINEAR
            )
        )
        for plane in np.moveaxis(values, -1, 0)
    ]
    return np.stack(planes, -1)


def _planes(path: str, colour: bool) -> np.ndarray:
    return _native.read_png(path) if _is_png(path) else _exr(Path(path), colour)


def _is_png(path: str) -> bool:
    return path.lower().endswith(".png")


def _exr(path: Path, colour: bool) -> np.ndarray:
    planes = read_exr(path, colour=colour)
    for order in _ORDERS:
        if all(channel in planes for channel in order):
            return np.stack([planes[channel] for channel in order], -1)
    if "Y" in planes or len(planes) == 1:
        return next(iter(planes.values()))[..., None] if "Y" not in planes else planes["Y"][..., None]
    raise FaceError(f"{path}: has the channels {', '.join(sorted(planes))}; write R, G, B, or one channel")

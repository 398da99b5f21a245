"""OpenEXR files as numpy arrays."""

from __future__ import annotations

import os
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from .errors import PictureError

_Path = str | os.PathLike[str]


def exr_channels(path: _Path) -> list[str]:
    """Return the names of the channels of an EXR file, in its order. Raises ``errors.PictureError``."""
    return _native.exr_channels(path)


def read_exr(path: _Path, channels: Sequence[str] | None = None) -> NDArray[np.float32]:
    """Read channels of an EXR file, float32, row 0 on top.

    Without ``channels``: R, G and B as linear Rec.709, (height, width, 3), or the one channel that the file has,
    (height, width). With them: their values as they are in the file, (height, width, len(channels)). Pixels beside
    the data window are 0. Raises ``errors.PictureError`` for a file that is not an EXR or has no such channel.
    """
    if channels is not None:
        return _native.read_exr(path, list(channels), finite=False)[1]
    found = _native.exr_channels(path)
    if {"R", "G", "B"} <= set(found):
        return _native.read_exr(path, ["R", "G", "B"], colour=True, finite=False)[1]
    if len(found) == 1:
        return _native.read_exr(path, finite=False)[1][..., 0]
    names = ", ".join(found)
    raise PictureError(f"{os.fspath(path)}: has no R, G and B among its channels {names}; choose by channels=[...]")


def write_exr(path: _Path, picture: ArrayLike, channels: Sequence[str] | None = None) -> None:
    """Write an array (height, width) or (height, width, n) as an EXR file of 32-bit floats.

    ``channels`` names the n channels; without it they are R, G, B of three and Y of one. Equal arrays give equal
    bytes. Raises ``errors.PictureError`` for another shape, another type, and where the file cannot be written.
    """
    array = _native.picture_array("picture", picture)
    array = array.reshape(*array.shape[:2], -1)
    count = array.shape[2]
    names = list(channels) if channels is not None else {1: ["Y"], 3: ["R", "G", "B"]}.get(count)
    if names is None:
        raise PictureError(f"picture: has {count} channels; name them by channels=[...]")
    if len(names) != count or len(set(names)) != count or not all(names):
        raise PictureError(f"channels: {', '.join(names)} are not {count} different names; name every channel once")
    _native.write_exr(path, array, names)

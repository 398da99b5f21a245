"""EXIF orientation, applied here and by nothing else: libraries that decode get pictures without it."""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

ORIENTATION = 0x0112
"""EXIF's tag, in TIFF files a tag of the picture itself."""

_UP = {1: (0, 1), 2: (0, 1), 3: (0, -1), 4: (0, -1), 5: (-1, 0), 6: (-1, 0), 7: (1, 0), 8: (1, 0)}
"""The direction (x to the right, y up) in the stored picture that points up in the picture as shown."""

_INVERSE = {6: 8, 8: 6}
"""The inverses of the orientations that are not their own."""

_CODES = {3: "H", 4: "I"}
"""`struct` codes of TIFF's unsigned integers of 16 and 32 bits."""


def oriented(picture: NDArray[Any], orientation: int) -> NDArray[Any]:
    """A stored picture [H, W(, C)] as its EXIF ``orientation`` (1 to 8) has it shown."""
    if orientation in (5, 7):
        picture = picture.swapaxes(0, 1)
        return np.ascontiguousarray(picture if orientation == 5 else np.rot90(picture, 2))
    if orientation in (2, 4):
        return np.ascontiguousarray(picture[:, ::-1] if orientation == 2 else picture[::-1])
    return np.ascontiguousarray(np.rot90(picture, {3: 2, 6: -1, 8: 1}.get(orientation, 0)))


def inverse(orientation: int) -> int:
    """The orientation that undoes ``orientation``."""
    return _INVERSE.get(orientation, orientation)


def shown_up(orientation: int) -> tuple[int, int]:
    """The direction (x to the right, y up) in a stored picture that is up in the picture as shown."""
    return _UP[orientation]


def as_stored(data: bytes) -> tuple[bytes, int | None]:
    """A file's bytes, of which every library decodes the pixels as they are stored, and the orientation that a
    TIFF file states (None of other files, and where it states none).

    OpenCV and Pillow turn TIFF files by their tag, OpenCV even against its flag, and leave other files
    alone. The tag of the copy is 1.
    """
    place = _tiff_tag(data)
    if place is None:
        return data, None
    offset, code = place
    (value,) = struct.unpack_from(code, data, offset)
    copy = bytearray(data)
    struct.pack_into(code, copy, offset, 1)
    return bytes(copy), value if value in _UP else 1


def _tiff_tag(data: bytes) -> tuple[int, str] | None:
    """Offset and `struct` code of the orientation in the first directory of a TIFF or BigTIFF file, if it has one."""
    order = {b"II": "<", b"MM": ">"}.get(data[:2])
    if order is None:
        return None
    try:
        (version,) = struct.unpack_from(f"{order}H", data, 2)
        big = version == 43
        if version not in (42, 43):
            return None
        (start,) = struct.unpack_from(f"{order}{'Q' if big else 'I'}", data, 8 if big else 4)
        (count,) = struct.unpack_from(f"{order}{'Q' if big else 'H'}", data, start)
        size, first, value = (20, start + 8, 12) if big else (12, start + 2, 8)
        for entry in range(first, min(first + count * size, len(data) - size + 1), size):
            tag, kind = struct.unpack_from(f"{order}HH", data, entry)
            if tag == ORIENTATION and kind in _CODES:
                return entry + value, order + _CODES[kind]
    except (struct.error, OverflowError):
        return None
    return None

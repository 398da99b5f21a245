"""Colour spaces that EXIF states without a profile, as cameras write them (DCF 2.0, EXIF 2.3)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

ADOBE_RGB = "Adobe RGB (1998)"

ADOBE_TO_REC709: NDArray[np.float64] = np.array(
    [[1.3983557, -0.3983557, 0.0], [0.0, 1.0, 0.0], [0.0, -0.0429290, 1.0429290]]
)
"""From linear Adobe RGB to linear Rec.709, which share their white (D65) and the chromaticities of red and blue."""

_COLOUR_SPACE, _INTEROPERABILITY, _INDEX = 0xA001, 0xA005, 1
_SRGB, _ADOBE, _UNCALIBRATED = 1, 2, 0xFFFF


def exif_colour_space(tags: dict[int, Any], exif: Image.Exif, name: str) -> tuple[str | None, str]:
    """The colour space that EXIF states, ``srgb`` or `ADOBE_RGB`, and by what; None with what it leaves open.

    ``tags`` are those of the Exif directory of ``exif``. Cameras write 2, which is outside the standard, or
    65535 (uncalibrated) with the interoperability index R03 and, as DCF asks, a file ``name`` that begins
    with an underscore; exiv2 and darktable read the same.
    """
    space = tags.get(_COLOUR_SPACE)
    if space == _ADOBE:
        return ADOBE_RGB, "EXIF (ColorSpace 2)"
    if space != _UNCALIBRATED:
        return "srgb", "EXIF"
    stated = exif.get_ifd(_INTEROPERABILITY) if _INTEROPERABILITY in tags else {}
    index = str(stated.get(_INDEX, "")).strip("\0 ")
    if index == "R03":
        return ADOBE_RGB, "EXIF (ColorSpace 65535, InteropIndex R03)"
    if index == "R98":
        return "srgb", "EXIF"
    if name.startswith("_"):
        return ADOBE_RGB, "EXIF (ColorSpace 65535) and the underscore that begins the file's name (DCF)"
    return None, "EXIF says that the colours are not sRGB (ColorSpace 65535) and nothing states which they are"

"""Exposure brackets, as cameras write them one after the other, merged to one radiance."""

from __future__ import annotations

import math
from pathlib import Path

import cv2
import numpy as np

from ..errors import PictureError
from .pictures import Floats, Photograph, decode, read_photograph

_DARKEST = 0.25 / 255
"""Stands for code 0, whose logarithm the merge takes."""


def bracket(picture: Path, count: int) -> list[Path]:
    """The picture that a camera was fitted to and the ``count`` - 1 that follow it in its folder.

    Raises `PictureError` if there are not so many.
    """
    named = [path for path in sorted(picture.parent.glob(f"*{picture.suffix}")) if path.is_file()]
    start = named.index(picture) if picture in named else len(named)
    found = named[start : start + count]
    if len(found) < count:
        raise PictureError(
            f"{picture}: has {max(len(found) - 1, 0)} pictures after it, but brackets are {count} each; copy all of them beside it"
        )
    return found


def merged(paths: list[Path], curve: str) -> tuple[Floats, Photograph]:
    """Radiance [H, W, 3] of a bracket (Debevec and Malik 1997, as OpenCV merges it) over what the camera let
    through, and the first picture. Raises `PictureError`.
    """
    taken = [read_photograph(path, curve) for path in paths]
    codes = []
    for path, photograph in zip(paths, taken):
        if photograph.codes is None:
            raise PictureError(f"{path}: is a bracket of more than 8 bits; merge brackets to EXR beforehand")
        if photograph.exposure is None:
            raise PictureError(
                f"{path}: has no exposure time in its EXIF; keep it, or merge brackets to EXR beforehand"
            )
        if photograph.codes.shape != taken[0].radiance.shape or photograph.orientation != taken[0].orientation:
            raise PictureError(f"{path}: has another size than {paths[0].name} of its bracket; fix the order of files")
        codes.append(photograph.codes)
    exposures = np.array([photograph.exposure for photograph in taken], np.float32)
    if not exposures.max() > 1.05 * exposures.min():
        raise PictureError(f"{paths[0]}: all pictures of its bracket have one exposure; state how many belong together")
    middle = math.exp(float(np.log(exposures).mean()))
    values = np.arange(256, dtype=np.float32) / 255
    response = decode(np.maximum(values, _DARKEST), taken[0].curve)
    response = np.repeat(response[:, None, None], 3, 2)
    radiance = cv2.createMergeDebevec().process(codes, exposures / np.float32(middle), response)
    radiance = np.nan_to_num(np.asarray(radiance, np.float32), posinf=0.0).clip(0) / np.float32(middle)
    return np.asarray(radiance, np.float32), taken[0]

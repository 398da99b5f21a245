"""Takes a lens out of a picture, by OpenCV."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from .source import Lens


def undistorted(
    picture: NDArray[Any], lens: Lens, focal: tuple[float, float], centre: tuple[float, float], *, smooth: bool
) -> NDArray[Any]:
    """The picture of a pinhole with the same focal length and principal point, 0 where the lens saw nothing.
    ``smooth`` interpolates; masks and ids take the nearest pixel.
    """
    height, width = picture.shape[:2]
    # OpenCV's pixel centres are whole numbers.
    camera = np.array([[focal[0], 0, centre[0] - 0.5], [0, focal[1], centre[1] - 0.5], [0, 0, 1]])
    size, terms, turn = (width, height), lens.coefficients(), np.eye(3)
    maker = cv2.fisheye.initUndistortRectifyMap if lens.fisheye else cv2.initUndistortRectifyMap
    columns, rows = maker(camera, terms, turn, camera, size, cv2.CV_32FC1)
    # Beyond the middle of the last pixel the picture ends; up to its edge the last pixel goes on.
    inside = (columns > -0.5) & (columns < width - 0.5) & (rows > -0.5) & (rows < height - 0.5)
    how = cv2.INTER_LINEAR if smooth else cv2.INTER_NEAREST
    result = cv2.remap(picture, columns, rows, how, borderMode=cv2.BORDER_REPLICATE)
    result[~inside] = 0
    return result

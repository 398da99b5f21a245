"""Chooses some of a video's frames: from all directions of the head that it covers, and sharp ones."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ..vectors import unit
from .chart_mesh import ChartMesh
from .photographs import ImportedView
from .pictures import Floats
from .source import Matrix

_SIDE = 1000
"""Longest side (pixels) at which sharpness is measured: noise of single pixels is not sharpness."""


def sharpness(taken: ImportedView, mesh: ChartMesh | None) -> float:
    """The variance of the Laplacian (Pech-Pacheco et al. 2000) of the logarithm of grey inside the mask, so that no
    exposure changes it; without a mask inside the silhouette of ``mesh``, else of the whole picture. 0 where the face is
    not seen."""
    small = taken.smaller(-(-max(taken.radiance.shape[:2]) // _SIDE))
    if small.mask is not None:
        inside = small.mask > 0
    elif mesh is not None:
        inside = small.camera.silhouette(mesh.vertices, mesh.triangles)
    else:
        inside = np.ones(small.radiance.shape[:2], bool)
    # The outline is sharp where the face is not; a picture has none.
    inside = cv2.erode(inside.astype(np.uint8), np.ones((5, 5), np.uint8)) > 0
    if not inside.any():
        return 0.0
    grey: Floats = small.radiance.mean(-1)
    dark = 0.05 * float(np.median(grey[inside])) + 1e-9
    return float(cv2.Laplacian(np.log(grey.clip(0) + dark), cv2.CV_32F)[inside].var())


def directions(cameras: list[Matrix], centre: NDArray[np.float64]) -> NDArray[np.float64]:
    """The unit directions (V, 3) of cameras (camera to world) as seen from the head's ``centre``."""
    return unit(np.array([camera[:3, 3] for camera in cameras]) - centre)


def chosen_frames(seen_from: NDArray[np.float64], sharp: list[float], count: int) -> list[int]:
    """The numbers of ``count`` frames, ascending, of those seen from unit directions (V, 3) with a sharpness each.

    Greedy: the direction farthest from all chosen ones (Gonzalez 1985) is next, and of the frames about it, closer than
    half its distance to the chosen ones, the sharpest is taken. Frames of one place count only after all places have one.
    """
    values = np.array(sharp)
    chosen: list[int] = []
    left = np.ones(len(values), bool)
    nearest = np.full(len(values), np.pi)
    while len(chosen) < min(count, len(values)):
        # The first is the sharpest of those about the mean direction.
        far = int(np.argmax(np.where(left, nearest, -1))) if chosen else int(np.argmax(seen_from @ seen_from.mean(0)))
        reach = nearest[far] / 2 if chosen else np.radians(15)
        about = left & (_angles(seen_from, seen_from[far]) <= reach)
        number = int(np.argmax(np.where(about, values, -1)))
        chosen.append(number)
        left[number] = False
        nearest = np.minimum(nearest, _angles(seen_from, seen_from[number]))
    return sorted(chosen)


def _angles(directions: NDArray[np.float64], one: NDArray[np.float64]) -> NDArray[np.float64]:
    # The chord is exact for small angles, where the dot product is not.
    return 2 * np.arcsin((np.linalg.norm(directions - one, axis=1) / 2).clip(0, 1))

"""Masks where there are none: GrabCut (Rother, Kolmogorov, Blake 2004) around the ball that all cameras look at."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ..errors import CaptureError
from .pinhole import Pinhole
from .source import Matrix

_SIDE = 512
"""Longest side (pixels) of the small pictures that are cut; masks are as coarse."""
_ROUNDS = 5
_SURE = 0.35
"""Radius of the disc that is taken for the head, in radii of the ball."""


def looked_at(cameras: list[Matrix]) -> NDArray[np.float64]:
    """The point (3,) that is nearest to the optical axes of cameras (camera to world)."""
    eyes = np.array([camera[:3, 3] for camera in cameras])
    ways = -np.array([camera[:3, 2] for camera in cameras])
    across = np.eye(3) - ways[:, :, None] * ways[:, None, :]
    return np.linalg.lstsq(across.sum(0), np.einsum("nij,nj->i", across, eyes), rcond=None)[0]


def discs_of_common_ball(cameras: list[Pinhole]) -> list[tuple[float, float, float]]:
    """The disc (column, row, radius; pixels) of each picture that shows the largest ball around the point that the
    cameras look at, with all of it in every frame. Raises `CaptureError` if cameras do not look at one place."""
    centre = looked_at([camera.camera_to_world for camera in cameras])
    places, radii = [], []
    for camera in cameras:
        x, y, z = (centre - camera.camera_to_world[:3, 3]) @ camera.camera_to_world[:3, :3]
        if z >= 0:
            raise CaptureError("masks grabcut: the cameras do not look at one place; name a folder of masks")
        column = camera.centre[0] - camera.focal[0] * x / z
        row = camera.centre[1] + camera.focal[1] * y / z
        room = min(column, row, camera.width - column, camera.height - row)
        places.append((column, row, min(camera.focal) / -z))
        radii.append(room * -z / min(camera.focal))
    if min(radii) <= 0:
        raise CaptureError("masks grabcut: the cameras do not look at one place; name a folder of masks")
    return [(column, row, min(radii) * scale) for column, row, scale in places]


def cut(picture: NDArray[np.float32], disc: tuple[float, float, float]) -> NDArray[np.uint8]:
    """The mask [H, W] (0, 255) of a linear picture [H, W, 3]: what differs from the surroundings of the disc."""
    height, width = picture.shape[:2]
    scale = min(1.0, _SIDE / max(height, width))
    size = max(1, round(width * scale)), max(1, round(height * scale))
    small = cv2.resize(picture, size, interpolation=cv2.INTER_AREA)
    shown = (255 * np.clip(small / max(float(np.percentile(small, 99)), 1e-6), 0, 1) ** (1 / 2.2)).astype(np.uint8)
    column, row, radius = (scale * value for value in disc)
    away = np.hypot(np.arange(size[0]) + 0.5 - column, np.arange(size[1])[:, None] + 0.5 - row)
    state = np.full(away.shape, cv2.GC_BGD, np.uint8)
    state[away < radius] = cv2.GC_PR_FGD
    state[away < _SURE * radius] = cv2.GC_FGD
    cv2.setRNGSeed(0)
    cv2.grabCut(shown, state, None, np.zeros((1, 65)), np.zeros((1, 65)), _ROUNDS, cv2.GC_INIT_WITH_MASK)
    head = np.isin(state, (cv2.GC_FGD, cv2.GC_PR_FGD)).astype(np.uint8)
    _, pieces, stats, _ = cv2.connectedComponentsWithStats(head)
    largest = 1 + int(np.argmax(stats[1:, cv2.CC_STAT_AREA]))
    mask = np.where(pieces == largest, 255, 0).astype(np.uint8)
    return cv2.resize(mask, (width, height), interpolation=cv2.INTER_NEAREST)

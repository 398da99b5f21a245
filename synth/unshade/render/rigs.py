"""Cameras: where they stand, and what a scene's rig makes of them.

A camera is a pinhole with square pixels. Its matrix maps camera to world with OpenGL axes
(x right, y up, looking down -z); pixel (i, j) has its centre at (i + .5, j + .5), row 0 at
the top.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import mitsuba as mi
import numpy as np

from ..scene_file import Rig, passes_for

_UP = np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True)
class Camera:
    """One camera: name of its frame, pixels, focal length in pixels, 4x4 camera to world."""

    name: str
    width: int
    height: int
    focal: float
    matrix: np.ndarray
    train: bool

    @property
    def position(self) -> np.ndarray:
        return self.matrix[:3, 3]

    def pixel_directions(self) -> np.ndarray:
        """Unit directions [height * width, 3] through the pixel centres, row by row."""
        x = (np.arange(self.width) + 0.5 - self.width / 2) / self.focal
        y = (self.height / 2 - np.arange(self.height) - 0.5) / self.focal
        x, y = np.meshgrid(x, y)
        local = np.stack([x, y, np.full_like(x, -1.0)], -1).reshape(-1, 3)
        local /= np.linalg.norm(local, axis=1, keepdims=True)
        return local @ self.matrix[:3, :3].T

    def project(self, points: np.ndarray) -> np.ndarray:
        """Pixel coordinates [N, 2] (x right, y down) of world points [N, 3] in front."""
        local = (points - self.position) @ self.matrix[:3, :3]
        plane = self.focal * local[:, :2] / -local[:, 2:]
        return np.stack([plane[:, 0] + self.width / 2, self.height / 2 - plane[:, 1]], 1)

    def frame(self) -> dict:
        """The camera's entry in ``transforms.json``."""
        return {
            "name": self.name,
            "file_path": f"images/{self.name}.exr",
            "mask_path": f"masks/{self.name}.png",
            "label_path": f"labels/{self.name}.png",
            "w": self.width,
            "h": self.height,
            "fl_x": self.focal,
            "fl_y": self.focal,
            "cx": self.width / 2,
            "cy": self.height / 2,
            "transform_matrix": self.matrix.tolist(),
        }

    def sensor(self, samples: int):
        """The camera in Mitsuba, whose own axes are x left, y up, z forward."""
        to_world = self.matrix @ np.diag([-1.0, 1.0, -1.0, 1.0])
        return mi.load_dict(
            {
                "type": "perspective",
                "fov": math.degrees(2 * math.atan(self.width / 2 / self.focal)),
                "fov_axis": "x",
                "to_world": mi.ScalarTransform4f(to_world),
                "near_clip": 0.01,
                "far_clip": 100.0,
                "film": {
                    "type": "hdrfilm",
                    "width": self.width,
                    "height": self.height,
                    "rfilter": {"type": "box"},
                },
                "sampler": {"type": "multijitter", "sample_count": samples // passes_for(samples)},
            }
        )


def look_at(position: np.ndarray, target: np.ndarray) -> np.ndarray:
    """Camera-to-world matrix (OpenGL axes) of an upright camera."""
    back = position - target
    back = back / np.linalg.norm(back)
    right = np.cross(_UP, back)
    right /= np.linalg.norm(right)
    matrix = np.eye(4)
    matrix[:3] = np.stack([right, np.cross(back, right), back, position], 1)
    return matrix


def cameras(rig: Rig, width: int, height: int) -> list[Camera]:
    """The rig's cameras: training views first, withheld ones last."""
    poses = _phone(rig, width, height) if rig.kind == "phone" else _emily(height)
    return [
        Camera(f"{number:03d}", width, height, focal, look_at(position, target), train)
        for number, (position, target, focal, train) in enumerate(poses)
    ]


_FACE = np.array([0.0, 0.0, 0.06])
"""What cameras are pointed at: the middle of the face, seen from the head's centre (m)."""

_ELEVATION_SHARE = 0.6
"""A walk around a face moves more sideways than up and down."""


def _phone(rig: Rig, width: int, height: int):
    """A walk around the face at arm's length: a 26 mm-equivalent picture cropped to the
    head. Azimuths and elevations are stratified, then jittered; withheld views lie in the
    inner half of the range."""
    rng = np.random.default_rng(rig.seed)
    focal = min(width, height) / 2 / math.tan(math.radians(rig.fov_degrees) / 2)
    for count, reach, train in ((rig.train, 1.0, True), (rig.test, 0.5, False)):
        sideways = 2 * (np.arange(count) + rng.uniform(0, 1, count)) / max(count, 1) - 1
        upwards = 2 * (rng.permutation(count) + rng.uniform(0, 1, count)) / max(count, 1) - 1
        reach *= math.radians(rig.max_angle_degrees)
        for x, y in zip(sideways, upwards):
            azimuth = reach * x
            # An ellipse, so that no corner view leaves the permitted angle.
            elevation = reach * _ELEVATION_SHARE * y * math.sqrt(1 - x * x)
            distance = rig.distance_metres * rng.uniform(0.95, 1.05)
            level = math.cos(elevation)
            away = np.array([level * math.sin(azimuth), math.sin(elevation), level * math.cos(azimuth)])
            yield _FACE + distance * away, _FACE + rng.uniform(-0.008, 0.008, 3), focal, train


_EMILY = (
    # position, point looked at (cm; origin at the head), horizontal field of view (degrees)
    ((-119.556, 3.04448, 103.007), (-115.837, 3.102, 99.665), 8.677),
    ((-74.56, 2.88304, 140.152), (-72.263, 2.918, 135.711), 8.734),
    ((-8.58372, -30.0317, 153.529), (-8.320, -28.991, 148.646), 8.753),
    ((49.8907, -28.5511, 146.874), (48.325, -27.550, 142.232), 8.850),
    ((104.115, 7.06966, 114.286), (100.768, 7.010, 110.572), 8.682),
    ((142.351, 8.12443, 66.5077), (137.859, 8.015, 64.314), 8.796),
    ((13.8972, -73.1344, 107.281), (13.405, -70.198, 103.264), 11.923),
)
"""The seven public cameras of Digital Emily 2."""

_EMILY_MIRRORED = (3, 5)
"""The paper uses nine views; two are not public. These are mirrored onto the emptier side."""

_EMILY_WITHHELD = 2
"""The frontal view, which the others surround."""

_EMILY_CENTRE = np.array([0.0, 0.046, -0.027])
"""Where the optical axes of these cameras meet to within 25 mm (m, in the data set's frame)."""

EMILY_OFFSET = _FACE - _EMILY_CENTRE
"""From the data set's frame to ours: the axes then meet in the middle of the face."""

_EMILY_ASPECT = 1.5
"""Height : width of its 24 x 36 mm portrait film."""


def _emily(height: int):
    """The light stage's rig. The film's full height is kept at any picture shape, so 2 : 3
    pictures show the whole film and others are cropped or widened sideways."""
    poses = [(np.array(at) / 100, np.array(to) / 100, fov) for at, to, fov in _EMILY]
    mirror = np.array([-1.0, 1.0, 1.0])
    poses += [(poses[i][0] * mirror, poses[i][1] * mirror, poses[i][2]) for i in _EMILY_MIRRORED]
    order = [i for i in range(len(poses)) if i != _EMILY_WITHHELD] + [_EMILY_WITHHELD]
    for i in order:
        position, target, fov = poses[i]
        half_height = _EMILY_ASPECT * math.tan(math.radians(fov) / 2)
        focal = height / 2 / half_height
        yield position + EMILY_OFFSET, target + EMILY_OFFSET, focal, i != _EMILY_WITHHELD

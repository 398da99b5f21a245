"""What cameras a scene's rig stands for, and where they stand."""

from __future__ import annotations

import math

import numpy as np

from ..scene_file import Rig
from .camera import Camera, look_at


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

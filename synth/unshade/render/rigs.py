"""Cameras of a scene's rig: names, poses and lenses."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ..camera.camera import Camera, look_at
from ..scene_file import Light, Rig, Scene
from ..vectors import away


def cameras(rig: Rig, width: int, height: int) -> list[Camera]:
    """The rig's cameras: training views first, withheld ones last, each group in the order
    of the names. Naming other withheld views leaves every camera where it is."""
    poses = _POSES[rig.kind](rig, width, height)
    views = [
        Camera(
            name,
            width,
            height,
            focal,
            look_at(position, target),
            train if rig.withheld is None else name not in rig.withheld,
        )
        for name, (position, target, focal, train) in zip(rig.view_names(), poses, strict=True)
    ]
    groups = ([view for view in views if view.train == train] for train in (True, False))
    return [replace(view, place=place) for group in groups for place, view in enumerate(group)]


def light_of_view(scene: Scene, light: Light, camera: Camera) -> Light:
    """``light`` as the head has it while ``camera`` takes its picture.

    Of several lights by turns the view has the one of its place; the light of the capture stands where the rig's
    `light_frame` says. Every other light stands still with respect to the head.
    """
    if light != scene.light:
        return light
    groups = light.groups
    own = groups[camera.place % len(groups)]
    return moving_with(camera, own) if scene.rig.light_frame == "camera" else own


def moving_with(camera: Camera, light: Light) -> Light:
    """A light that stands still in the camera's axes, as the head has it."""
    return replace(light, to_head=tuple(camera.matrix[:3, :3].ravel().tolist()))


FACE_CENTRE = np.array([0.0, 0.0, 0.06])
"""Point that cameras aim at: the middle of the face, from the head's centre (m)."""

_ELEVATION_FRACTION = 0.6
"""A walk around a face moves more sideways than up and down."""


def _phone(rig: Rig, width: int, height: int):
    """A walk around the face at arm's length. Azimuths and elevations are stratified, then
    jittered; withheld views lie in the inner half of the range.

    The default 25 degrees at 0.55 m are what a phone's main camera (26 mm equivalent, 49.6
    degrees across its shorter side) shows in the middle 48 % of its frame, cropped to the
    head; perspective depends on the distance alone. ``equivalent_mm = 26`` keeps the frame.
    """
    rng = np.random.default_rng(rig.seed)
    focal = _focal(rig, width, height)
    for count, reach, train in ((rig.train, 1.0, True), (rig.test, 0.5, False)):
        sideways = 2 * (np.arange(count) + rng.uniform(0, 1, count)) / max(count, 1) - 1
        upwards = 2 * (rng.permutation(count) + rng.uniform(0, 1, count)) / max(count, 1) - 1
        reach *= math.radians(rig.max_angle_degrees)
        for x, y in zip(sideways, upwards):
            azimuth = reach * x
            # An ellipse, so that no corner view leaves the permitted angle.
            elevation = reach * _ELEVATION_FRACTION * y * math.sqrt(1 - x * x)
            distance = rig.distance_metres * rng.uniform(0.95, 1.05)
            yield (
                FACE_CENTRE + distance * away(azimuth, elevation),
                FACE_CENTRE + rng.uniform(-0.008, 0.008, 3),
                focal,
                train,
            )


_DESKTOP = (
    # azimuth, elevation (degrees, seen from the face), distance (share of the rig's)
    (-45.0, 4.0, 1.0),
    (-20.0, 20.0, 1.0),
    (0.0, -14.0, 0.95),
    (20.0, 20.0, 1.0),
    (45.0, 4.0, 1.0),
    (0.0, 6.0, 1.0),  # withheld: the frontal view, which the others surround
)
"""Five cameras on two desk stands and a monitor's rim, and a sixth that judges them."""

_DESKTOP_PLAY = (0.010, 0.008)
"""By how much (m) a camera of a desk rig misses its nominal place, and its aim the face's middle."""


def _desktop(rig: Rig, width: int, height: int):
    """A small fixed rig of five cameras for training; no two seeds mount it quite alike."""
    rng = np.random.default_rng(rig.seed)
    place_play, aim_play = _DESKTOP_PLAY
    focal = _focal(rig, width, height)
    for number, (azimuth, elevation, scale) in enumerate(_DESKTOP):
        position = FACE_CENTRE + rig.distance_metres * scale * away(math.radians(azimuth), math.radians(elevation))
        position = position + rng.uniform(-place_play, place_play, 3)
        yield position, FACE_CENTRE + rng.uniform(-aim_play, aim_play, 3), focal, number < len(_DESKTOP) - 1


_GOLDEN_ANGLE = math.pi * (3 - math.sqrt(5))


def _dome(rig: Rig, width: int, height: int):
    """Views spread evenly over a cap of a sphere in front of the face: Vogel's spiral (1979),
    turned by the seed. Withheld views are taken evenly from the middle to the rim."""
    count = rig.train + rig.test
    turn = np.random.default_rng(rig.seed).uniform(0, 2 * math.pi)
    fraction = (np.arange(count) + 0.5) / count
    # Equal steps of height on the sphere enclose equal solid angles.
    cosine = 1 - fraction * (1 - math.cos(math.radians(rig.max_angle_degrees)))
    sine = np.sqrt(1 - cosine**2)
    around = turn + _GOLDEN_ANGLE * np.arange(count)
    directions = np.stack([sine * np.cos(around), sine * np.sin(around), cosine], 1)
    withheld = _evenly(rig.test, count)
    training = np.setdiff1d(np.arange(count), withheld)
    focal = _focal(rig, width, height)
    for number in (*training, *withheld):
        yield FACE_CENTRE + rig.distance_metres * directions[number], FACE_CENTRE, focal, number not in withheld


def _ring(rig: Rig, width: int, height: int):
    """Views at even angles about the vertical axis of the head, from its right to its left hand, some of them withheld
    evenly. A still camera sees the same of a head that turns."""
    count = rig.train + rig.test
    azimuths = np.radians(rig.sweep_degrees) * ((np.arange(count) + 0.5) / count - 0.5)
    withheld = _evenly(rig.test, count)
    focal = _focal(rig, width, height)
    for number in (*np.setdiff1d(np.arange(count), withheld), *withheld):
        yield rig.distance_metres * away(azimuths[number], 0.0), np.zeros(3), focal, number not in withheld


def _evenly(chosen: int, count: int) -> np.ndarray:
    """``chosen`` numbers below ``count`` with even gaps."""
    return ((np.arange(chosen) + 0.5) / max(chosen, 1) * count).astype(int)


def _focal(rig: Rig, width: int, height: int) -> float:
    """Focal length in pixels."""
    return min(width, height) / 2 / math.tan(math.radians(rig.short_side_degrees) / 2)


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

EMILY_OFFSET = FACE_CENTRE - _EMILY_CENTRE
"""From the data set's frame to ours: the axes then meet in the middle of the face."""

_EMILY_ASPECT = 1.5
"""Height : width of its 24 x 36 mm portrait film."""


def _emily(rig: Rig, width: int, height: int):
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


_POSES = {"phone": _phone, "emily": _emily, "desktop": _desktop, "dome": _dome, "ring": _ring, "turntable": _ring}
"""Position, target, focal length (pixels) and use of each view of a kind, in order."""

"""Single changes of cameras, mesh or masks after which a capture may fit: mistakes that are often made."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from .pinhole import Pinhole
from .source import OPENCV_AXES, Matrix

_SENSORS = (36.0, 23.6, 22.3, 17.3)
"""Widths of sensors, millimetres: full frame, APS-C (two), Micro Four Thirds."""

_UNITS = (("mm", 0.001), ("cm", 0.01), ("inches", 0.0254), ("dm", 0.1))

FOCAL = "focal"
"""Begins the ids of changes of the focal length."""

CENTRE = "principal-point"
"""Begins the ids of changes of the principal point; those that keep what is stated of it come first."""


@dataclass(frozen=True)
class Change:
    """One change. ``camera`` is what becomes of each camera, ``mesh_scale`` of the mesh's size, ``orientation``
    (of EXIF's eight) of pictures, masks and labels; ``inverted`` masks are turned inside out, and ``no_lens`` takes
    photographs for undistorted ones."""

    id: str
    words: str
    camera: Callable[[Pinhole], Pinhole] = lambda camera: camera
    mesh_scale: float = 1.0
    orientation: int = 1
    inverted: bool = False
    no_lens: bool = False


PLAIN = Change("none", "nothing is changed")


def single_changes(elsewhere: tuple[str, str, Matrix] | None, camera: Pinhole, *, lens: bool) -> list[Change]:
    """Every change that is tried, the likelier ones first. ``camera`` is one of the cameras; ``lens``: whether
    they have lenses, which are tried left out, alone and with each other principal point."""
    width, square = camera.width, camera.width == camera.height  # A square picture may lie on its side unseen.
    changes: list[Change] = _centres(camera)
    if lens:
        bare = Change("no-lens", "the photographs are undistorted already: drop the lens", no_lens=True)
        changes += [
            replace(change, id=f"{change.id}+no-lens", words=f"{change.words}, and {bare.words}", no_lens=True)
            for change in changes
        ]
        changes.append(bare)
    if elsewhere is not None:
        name, words, matrix = elsewhere
        changes.append(Change(name, words, _world(matrix)))
    changes += [
        Change("opencv-axes", "the cameras have OpenCV's axes (y down, looking along z)", _axes(OPENCV_AXES)),
        Change(
            "pytorch3d-axes",
            "the cameras have PyTorch3D's axes (x left, looking along z)",
            _axes(np.diag([-1.0, 1, -1, 1])),
        ),
        Change("inverse", "the matrices are world to camera", _inverted(np.eye(4))),
        Change("inverse-opencv-axes", "the matrices are world to camera, with OpenCV's axes", _inverted(OPENCV_AXES)),
        Change(
            "inverse-of-world-to-camera",
            "the poses are camera to world, not world to camera as the format has them",
            _undone,
        ),
        Change("inverted-masks", "the masks are inverted: 255 belongs where the face is", inverted=True),
        Change("upside-down-rows", "the rows of pictures and masks run upwards", orientation=4),
        Change("mirrored", "pictures and masks are mirrored, left is right", orientation=2),
        Change("half-turn", "pictures and masks stand on their heads: they were turned by 180 degrees", orientation=3),
    ]
    for sensor in _SENSORS:
        words = f"the focal length is in mm of a sensor {sensor:g} mm wide, not in pixels"
        changes.append(Change(f"{FOCAL}-mm-{sensor:g}", words, _focal(width / sensor)))
    if square:
        changes.append(
            Change("turn-right", "pictures and masks lie on their sides: turn them to the right", orientation=6)
        )
        changes.append(
            Change("turn-left", "pictures and masks lie on their sides: turn them to the left", orientation=8)
        )
    changes += [
        Change(
            f"{FOCAL}-share", "the focal length is a share of the picture's width, not in pixels", _focal(float(width))
        ),
        Change(f"{FOCAL}-half", "the focal length is of pictures twice as large", _focal(0.5)),
        Change(f"{FOCAL}-double", "the focal length is of pictures half as large", _focal(2.0)),
    ]
    for unit, metres in _UNITS:
        changes.append(Change(f"mesh-{unit}", f"the mesh is in {unit}, the cameras in metres", mesh_scale=metres))
        changes.append(Change(f"cameras-{unit}", f"the cameras are in {unit}, the mesh in metres", _scaled(metres)))
    for words, matrix in _turns():
        changes.append(
            Change(
                f"mesh-axes-{words}",
                f"the mesh has other axes than the cameras: its (x, y, z) is their {words}",
                _world(matrix),
            )
        )
    return changes


def _centres(camera: Pinhole) -> list[Change]:
    """Other principal points that lie in the picture: as stated but counted from elsewhere, then the middle."""
    x, y, (width, height) = *camera.centre, (camera.width, camera.height)
    tried = [
        Change(f"{CENTRE}-from-corner", "the principal point counts from the picture's corner, not its middle",
               lambda c: _shifted(-c.width / 2, -c.height / 2)(c)),
        Change(f"{CENTRE}-from-middle", "the principal point counts from the picture's middle, not its corner",
               lambda c: _shifted(c.width / 2, c.height / 2)(c)),
        Change(f"{CENTRE}-from-below", "the principal point counts rows from below", _from_below),
        Change(CENTRE, "the principal point is wrong: it is the picture's middle", _centred),
    ]  # fmt: skip
    inside = [
        change for change in tried if all(0 < p < 1 for p in np.divide(change.camera(camera).centre, (width, height)))
    ]
    middle = (width / 2, height / 2)
    # Two names for one place would claim more than is known.
    return (
        [c for c in inside if c.id == CENTRE or not np.allclose(c.camera(camera).centre, middle)]
        if (x, y) != middle
        else []
    )


def half_pixels() -> list[Change]:
    """The two changes that only many pixels can show."""
    return [
        Change(
            "half-pixel",
            "the principal point counts pixel centres as whole numbers (OpenCV): add .5",
            _shifted(0.5, 0.5),
        ),
        Change(
            "half-pixel-back", "half a pixel was added to the principal point twice: take .5 away", _shifted(-0.5, -0.5)
        ),
    ]


def shift(dx: float, dy: float) -> Change:
    """A principal point elsewhere, pixels."""
    return Change("shift", f"the principal point is off by ({dx:g}, {dy:g}) pixels", _shifted(dx, dy))


def focal_factor(factor: float) -> Change:
    """Another focal length, whatever made it wrong."""
    return Change(
        f"{FOCAL}-times-{factor:.4g}",
        f"the focal length in pixels is {factor:.4g} times what is stated",
        _focal(factor),
    )


def distance_factor(factor: float) -> Change:
    """Another scale of the cameras' world than the mesh's."""
    words = f"cameras and mesh have different scales: the cameras' positions are to be multiplied by {factor:.4g}"
    return Change(f"cameras-times-{factor:.4g}", words, _scaled(factor))


def _placed(camera: Pinhole, matrix: Matrix) -> Pinhole:
    return replace(camera, camera_to_world=matrix)


def _world(similarity: Matrix) -> Callable[[Pinhole], Pinhole]:
    """Moves all cameras by a similarity of their world."""
    scale = np.cbrt(abs(np.linalg.det(similarity[:3, :3])))

    def change(camera: Pinhole) -> Pinhole:
        matrix = similarity @ camera.camera_to_world
        matrix[:3, :3] /= scale
        return _placed(camera, matrix)

    return change


def _axes(axes: Matrix) -> Callable[[Pinhole], Pinhole]:
    return lambda camera: _placed(camera, camera.camera_to_world @ axes)


def _inverted(axes: Matrix) -> Callable[[Pinhole], Pinhole]:
    # The matrix was taken for camera to world with OpenGL's axes, and whatever it was is rigid.
    return lambda camera: _placed(camera, np.linalg.inv(camera.camera_to_world) @ axes)


def _centred(camera: Pinhole) -> Pinhole:
    return replace(camera, centre=(camera.width / 2, camera.height / 2))


def _undone(camera: Pinhole) -> Pinhole:
    return _placed(camera, OPENCV_AXES @ np.linalg.inv(camera.camera_to_world) @ OPENCV_AXES)


def _from_below(camera: Pinhole) -> Pinhole:
    return replace(camera, centre=(camera.centre[0], camera.height - camera.centre[1]))


def _focal(factor: float) -> Callable[[Pinhole], Pinhole]:
    return lambda camera: replace(camera, focal=(camera.focal[0] * factor, camera.focal[1] * factor))


def _shifted(dx: float, dy: float) -> Callable[[Pinhole], Pinhole]:
    return lambda camera: replace(camera, centre=(camera.centre[0] + dx, camera.centre[1] + dy))


def _scaled(factor: float) -> Callable[[Pinhole], Pinhole]:
    def change(camera: Pinhole) -> Pinhole:
        matrix = camera.camera_to_world.copy()
        matrix[:3, 3] *= factor
        return _placed(camera, matrix)

    return change


def _turns() -> list[tuple[str, Matrix]]:
    """The 23 quarter turns of the world: what (x, y, z) becomes, and the matrix."""
    turns = []
    for order in itertools.permutations(range(3)):
        for signs in itertools.product((1.0, -1.0), repeat=3):
            matrix = np.zeros((4, 4))
            matrix[3, 3] = 1
            for row, (axis, sign) in enumerate(zip(order, signs)):
                matrix[row, axis] = sign
            if np.linalg.det(matrix) > 0 and not np.allclose(matrix, np.eye(4)):
                parts = [("-" if sign < 0 else "") + "xyz"[axis] for axis, sign in zip(order, signs)]
                # Turning the mesh one way is turning the cameras the other.
                turns.append((f"({', '.join(parts)})", matrix.T))
    # A turn about x, from z-up to y-up and back, is what happens most.
    likely = ("(x, z, -y)", "(x, -z, y)")
    return sorted(turns, key=lambda turn: (turn[0] not in likely, turn[0].count("-"), turn[0]))

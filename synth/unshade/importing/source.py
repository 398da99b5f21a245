"""Another program's capture before a picture is opened: cameras in the mesh's coordinates."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from ..errors import CaptureError
from ..stated_light import LIGHT_FRAMES

Matrix = NDArray[np.float64]

OPENCV_AXES: Matrix = np.diag([1.0, -1.0, -1.0, 1.0])
"""From OpenGL camera axes (y up, looking down -z) to OpenCV's (y down, looking along z), and back."""

_RIGID = 1e-3
"""How far the rotation of a camera may be from one, per entry of its product with its transpose."""

BROWN = ("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6")
"""OpenCV's terms of a lens, in OpenCV's order."""

FISHEYE = ("k1", "k2", "k3", "k4")
"""OpenCV's terms of an equidistant fisheye, in OpenCV's order."""


@dataclass(frozen=True)
class Lens:
    """How a lens departs from a pinhole: OpenCV's polynomial, or its fisheye."""

    terms: dict[str, float] = field(default_factory=lambda: dict[str, float]())
    fisheye: bool = False

    @property
    def straight(self) -> bool:
        """Whether it is a pinhole."""
        return not self.fisheye and not any(self.terms.values())

    @property
    def kept(self) -> bool:
        """Whether ``transforms.json`` of a capture can state it: no more than k1, k2, p1, p2."""
        return not self.fisheye and not any(self.terms.get(name) for name in BROWN[4:])

    def coefficients(self) -> NDArray[np.float64]:
        """OpenCV's array of them."""
        names = FISHEYE if self.fisheye else BROWN
        return np.array([self.terms.get(name, 0.0) for name in names])


@dataclass(frozen=True)
class FieldOfView:
    """Full angles (rad) across a picture's width and height, where a file states these and no size. One of them
    may be None; pixels are square then."""

    along: float | None
    across: float | None

    def focal(self, width: int, height: int) -> tuple[float, float]:
        """Focal lengths (x, y) in pixels of a picture of this size."""
        x = None if self.along is None else width / 2 / math.tan(self.along / 2)
        y = None if self.across is None else height / 2 / math.tan(self.across / 2)
        return x or y or 0.0, y or x or 0.0


@dataclass(frozen=True)
class SourceView:
    """One photograph and its camera.

    ``focal`` and ``centre`` are in pixels, the top left corner of the picture is (0, 0) and pixel
    centres lie at +.5; ``camera_to_world`` has OpenGL axes and is rigid. ``width`` and ``height`` are
    None where the file does not state them; then they are the picture's. ``light`` names the light, if views have
    different ones. ``stated`` is what the file calls
    the camera, for messages.
    """

    name: str
    picture: Path
    camera_to_world: Matrix
    focal: tuple[float, float] | FieldOfView
    centre: tuple[float, float] | None
    width: int | None
    height: int | None
    lens: Lens = field(default_factory=Lens)
    mask: Path | None = None
    label: Path | None = None
    light: str | None = None
    stated: str = ""


@dataclass(frozen=True)
class Source:
    """A capture as another program left it.

    ``origin`` is the file that the cameras came from, ``withheld`` the names that it sets aside.
    ``metres`` is the length of its unit, if the format fixes it. ``objects`` names the mesh's objects
    that are the face; none means all. ``label_names`` are the names of its label pictures by id.
    ``exif_applied``: whether the program counts pixels after a photograph's EXIF orientation was applied.
    ``left_out`` lists the views that the file states and ``views`` lacks, each with the reason;
    ``whole_folders``: whether the program was given every photograph of a folder.
    ``elsewhere`` is where the cameras would be if the mesh lies in the other of two coordinate systems
    that the file speaks of: a name, what it would mean, and the similarity of the cameras' world.
    ``light_frame`` is what the light stands still with; ``unknown_exposure``: each view has unknown factors on its
    channels. ``vertices`` (V, 3) take the place of those of the mesh's file, line by line.
    """

    origin: Path
    views: tuple[SourceView, ...]
    mesh: Path | None = None
    withheld: tuple[str, ...] = ()
    elsewhere: tuple[str, str, Matrix] | None = None
    metres: float | None = None
    objects: tuple[str, ...] = ()
    exif_applied: bool = True
    label_names: dict[int, str] = field(default_factory=lambda: dict[int, str]())
    assumed: tuple[str, ...] = ()
    left_out: tuple[tuple[str, str], ...] = ()
    whole_folders: bool = False
    light_frame: str = LIGHT_FRAMES[0]
    unknown_exposure: bool = False
    vertices: NDArray[np.float64] | None = None

    def __post_init__(self) -> None:
        if not self.views:
            raise CaptureError(f"{self.origin}: holds no camera with a pose; export the cameras again, aligned")
        for view in self.views:
            _check(self.origin, view)


def _check(origin: Path, view: SourceView) -> None:
    where = f"{origin}: camera {view.name!r}"
    focal = view.focal.focal(1, 1) if isinstance(view.focal, FieldOfView) else view.focal
    numbers = [*focal, *(view.centre or ()), *view.lens.terms.values(), *view.camera_to_world.ravel()]
    if not np.isfinite(numbers).all():
        raise CaptureError(f"{where}: holds a number that is not finite; export the cameras again")
    if min(focal) <= 0:
        raise CaptureError(f"{where}: its focal length is {min(focal):g}; it must be positive")
    for side in (view.width, view.height):
        if side is not None and not 0 < side <= 65535:
            raise CaptureError(f"{where}: its picture is {view.width} x {view.height}; fix the size")
    rotation = view.camera_to_world[:3, :3]
    off = np.abs(rotation.T @ rotation - np.eye(3)).max()
    if off > _RIGID or np.linalg.det(rotation) < 0:
        raise CaptureError(f"{where}: its matrix is not a rotation and translation; export the cameras again")


def rigid(matrix: Matrix) -> Matrix:
    """A camera's matrix without the scale that its rotation may carry; `Source` refuses what is not rigid then."""
    result = np.array(matrix, float)
    scale = np.cbrt(abs(np.linalg.det(result[:3, :3])))
    if scale > 0 and np.isfinite(scale):
        result[:3, :3] /= scale
    return result


def moved(similarity: Matrix, camera_to_world: Matrix) -> Matrix:
    """A camera's matrix after its world was moved, turned and scaled."""
    return rigid(similarity @ camera_to_world)


def frame_names(pictures: list[str]) -> list[str]:
    """A short name for each picture: its stem, or with its folders where stems are not unique."""
    plain = [picture.replace("\\", "/") for picture in pictures]
    stems = [_stem(path.rsplit("/", 1)[-1]) for path in plain]
    if len({stem.casefold() for stem in stems}) < len(stems):
        stems = [_stem(path).strip("./").replace("/", "_") for path in plain]
    names: list[str] = []
    for stem in stems:
        clean = "".join(c if c.isalnum() or c in "._-" else "_" for c in stem).lstrip(".") or "frame"
        name, number = clean, 1
        while name.casefold() in {other.casefold() for other in names}:
            number += 1
            name = f"{clean}_{number}"
        names.append(name)
    return names


def _stem(path: str) -> str:
    """A path without its ending, as far as it has one."""
    head, dot, ending = path.rpartition(".")
    return head if dot and head and "/" not in ending else path


def quaternion_matrix(w: float, x: float, y: float, z: float) -> Matrix:
    """The rotation (3, 3) of a quaternion of any length above 0, NaN for any other."""
    try:
        with np.errstate(over="ignore"):
            return Rotation.from_quat([x, y, z, w]).as_matrix()
    except ValueError:
        return np.full((3, 3), np.nan)

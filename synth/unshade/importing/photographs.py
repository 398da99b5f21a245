"""One view of an imported capture: its photograph, mask and labels, sorted out to agree with its camera."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ..errors import CaptureError
from .brackets import bracket, merged
from .detective import Evidence
from .grabcut import cut
from .lens import undistorted
from .orientation import inverse, oriented, shown_up
from .parser_labels import our_labels
from .pictures import Floats, Photograph, Plane, orientation_and_size, read_photograph, read_plane
from .pinhole import Pinhole
from .placement import UpDirections
from .source import FieldOfView, Lens, Matrix, Source, SourceView

_ASPECT = 0.01
"""By how much the sides of pictures of another size than their camera's may disagree on the factor."""

Bytes = NDArray[np.uint8]


@dataclass(frozen=True)
class ImportedView:
    """A view with its pictures, all of the camera's size: radiance [H, W, 3], mask and labels [H, W] or None."""

    name: str
    camera: Pinhole
    lens: Lens
    radiance: Floats
    mask: Bytes | None
    labels: Bytes | None
    photograph: Photograph

    def evidence(self) -> Evidence:
        """The view for the comparison with the mesh; it has a mask."""
        assert self.mask is not None
        return Evidence(self.camera, self.mask > 0, self.lens)

    def undistorted(self) -> ImportedView:
        """The view as a pinhole would have taken it."""
        if self.lens.straight:
            return self
        focal, centre = self.camera.focal, self.camera.centre

        def straight(picture: NDArray[Any], *, smooth: bool = False) -> NDArray[Any]:
            return undistorted(picture, self.lens, focal, centre, smooth=smooth)

        return replace(
            self,
            lens=Lens(),
            radiance=straight(self.radiance, smooth=True),
            mask=None if self.mask is None else straight(self.mask),
            labels=None if self.labels is None else straight(self.labels),
        )

    def oriented(self, orientation: int, *, inverted: bool) -> ImportedView:
        """The view with its pictures turned or mirrored, and its mask inside out."""
        mask = None if self.mask is None else oriented(self.mask, orientation)
        return replace(
            self,
            radiance=oriented(self.radiance, orientation),
            mask=None if mask is None else (255 - mask if inverted else mask),
            labels=None if self.labels is None else oriented(self.labels, orientation),
        )

    def smaller(self, every: int) -> ImportedView:
        """The view with pixels of ``every`` x ``every`` of the camera's; a last part row or column is dropped."""
        if every == 1:
            return self
        camera = self.camera.smaller(every)
        rows, columns = camera.height * every, camera.width * every

        def nearest(picture: Bytes | None) -> Bytes | None:
            return None if picture is None else picture[every // 2 : rows : every, every // 2 : columns : every]

        radiance = cv2.resize(
            self.radiance[:rows, :columns], (camera.width, camera.height), interpolation=cv2.INTER_AREA
        )
        return replace(
            self,
            camera=camera,
            radiance=np.asarray(radiance, np.float32),
            mask=nearest(self.mask),
            labels=nearest(self.labels),
        )


@dataclass(frozen=True)
class Reading:
    """How to read pictures: their curve, pictures of one bracket, the exposure that all are scaled to,
    whether masks are the photographs' alpha or the mesh's silhouette whatever there is, the names of the ids
    of label pictures, and by view's name the disc that holds the head, where masks are cut by GrabCut."""

    curve: str
    brackets: int
    reference: float | None
    alpha: bool
    silhouette: bool
    names: dict[int, str]
    discs: dict[str, tuple[float, float, float]] = field(default_factory=dict)


def take(source: Source, view: SourceView, reading: Reading, notes: set[str]) -> ImportedView:
    """Reads a view. Raises `CaptureError` or `PictureError`; what is assumed is added to ``notes``."""
    if reading.brackets > 1:
        radiance, photograph = merged(bracket(view.picture, reading.brackets), reading.curve)
    else:
        photograph = read_photograph(view.picture, reading.curve)
        radiance = photograph.radiance
    if reading.reference is not None:
        if photograph.exposure is None:
            raise CaptureError(
                f"{view.picture}: has no exposure time in its EXIF; keep it, or even exposures beforehand"
            )
        # A merged bracket is radiance over exposure already.
        radiance = radiance * np.float32(reading.reference / (1.0 if reading.brackets > 1 else photograph.exposure))
    if photograph.colour_warning is not None:
        notes.add(f"{photograph.colour_warning}: Rec.709 primaries are assumed")
    height, width = photograph.radiance.shape[:2]
    applied = _applied(source, view, photograph.orientation, width, height)
    orientation = photograph.orientation if applied else 1
    if photograph.orientation != 1:
        what = "applied" if applied else "left out, as the cameras are those of the pixels as stored"
        notes.add(f"EXIF orientation {photograph.orientation}: {what}")
    radiance = oriented(radiance, orientation)
    camera = _camera(view, radiance.shape[1], radiance.shape[0], notes)

    def beside(plane: Plane, path: Path) -> NDArray[Any]:
        """The values of a mask or label picture in the camera's pixels: its own EXIF orientation counts as the
        photograph's does. Without one it is in the camera's pixels if it has their size, else as the photograph
        is stored, or shown."""
        values, size = plane.values, radiance.shape[:2]
        if plane.orientation != 1:
            values = oriented(values, plane.orientation)
            values = values if applied else oriented(values, inverse(photograph.orientation))
        elif values.shape != size and values.shape == size[::-1]:
            turn = photograph.orientation if applied else inverse(photograph.orientation)
            values = oriented(values, turn)
        if values.shape != size:
            found = f"{plane.values.shape[1]} x {plane.values.shape[0]}"
            raise CaptureError(
                f"{path}: is {found}, but its photograph {camera.width} x {camera.height}; write it in the photograph's size"
            )
        return values

    return ImportedView(
        name=view.name,
        camera=camera,
        lens=view.lens,
        radiance=radiance,
        mask=cut(radiance, reading.discs[view.name])
        if reading.discs
        else _mask(view, reading, photograph, orientation, beside),
        labels=_labels(view, reading, beside),
        photograph=photograph,
    )


def camera_of(source: Source, view: SourceView) -> Pinhole:
    """The camera of a view, by its photograph's header. Raises `CaptureError` or `PictureError`."""
    orientation, width, height = orientation_and_size(view.picture)
    if orientation >= 5 and _applied(source, view, orientation, width, height):
        width, height = height, width
    return _camera(view, width, height, set())


def up_directions(source: Source, cameras: list[Matrix], *, turned: bool) -> UpDirections:
    """Up in the world of each photograph as EXIF has it shown; of its ``cameras`` (camera to world) if photographs
    were ``turned`` by another rule than EXIF's. Raises `PictureError`."""
    axes = [(0, 1)] * len(cameras) if turned else [_shown_axis(source, view) for view in source.views]
    directions = [camera[:3, :2] @ np.array(axis, float) for camera, axis in zip(cameras, axes)]
    return UpDirections(np.array(directions), sum(axis != (0, 1) for axis in axes))


def _shown_axis(source: Source, view: SourceView) -> tuple[int, int]:
    orientation, width, height = orientation_and_size(view.picture)
    return shown_up(1 if _applied(source, view, orientation, width, height) else orientation)


def _applied(source: Source, view: SourceView, orientation: int, width: int, height: int) -> bool:
    """Whether the camera counts the pixels of a photograph of ``width`` x ``height`` after its EXIF orientation."""
    if view.width is not None and view.height is not None and orientation >= 5 and width != height:
        return (view.width < view.height) != (width < height)
    return source.exif_applied


def _camera(view: SourceView, width: int, height: int, notes: set[str]) -> Pinhole:
    stated = (view.width or width, view.height or height)
    along, across = width / stated[0], height / stated[1]
    if abs(along / across - 1) > _ASPECT:
        raise CaptureError(
            f"{view.picture}: is {width} x {height}, but its camera states {stated[0]} x {stated[1]}; "
            "name the pictures that the cameras were fitted to"
        )
    if (width, height) != stated:
        notes.add(
            f"pictures are {along:.6g} times as large as their cameras state: focal lengths and principal points are scaled"
        )
    focal = view.focal.focal(*stated) if isinstance(view.focal, FieldOfView) else view.focal
    centre = view.centre or (stated[0] / 2, stated[1] / 2)
    if view.centre is None:
        notes.add("no principal point is stated: it is the picture's middle")
    return Pinhole(
        width,
        height,
        (focal[0] * along, focal[1] * across),
        (centre[0] * along, centre[1] * across),
        view.camera_to_world,
    )


def _mask(view: SourceView, reading: Reading, photograph: Photograph, orientation: int, beside: Any) -> Bytes | None:
    if reading.silhouette:
        return None
    if reading.alpha:
        if photograph.alpha is None:
            raise CaptureError(f"{view.picture}: has no alpha; name a folder of masks, or take the mesh's silhouette")
        alpha = oriented(photograph.alpha, orientation)
        return np.where(alpha >= 0.5, 255, 0).astype(np.uint8)
    path = view.mask
    if path is None:
        return None
    plane = beside(read_plane(path), path)
    # Masks of 0 and 1, of 8 bits and of 16.
    maximum = int(plane.max(initial=0))
    full = 1 if maximum <= 1 else 255 if maximum <= 255 else 65535
    return np.where(plane.astype(np.int64) * 2 >= full, 255, 0).astype(np.uint8)


def _labels(view: SourceView, reading: Reading, beside: Any) -> Bytes | None:
    path = view.label
    if path is None:
        return None
    return our_labels(path, beside(read_plane(path), path), reading.names)

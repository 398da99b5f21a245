"""From another program's capture to a capture folder."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from .capture_import import CaptureImport, CaptureWarning, Progress
from .choices import HULL, MASKS, Choices
from .programs import read_source

AnyPath = str | os.PathLike[str]


def import_capture(
    format: str,
    path: AnyPath,
    out: AnyPath,
    *,
    mesh: AnyPath | None = None,
    objects: Sequence[str] = (),
    uv: str = "auto",
    pictures: AnyPath | None = None,
    masks: AnyPath | None = None,
    labels: AnyPath | None = None,
    parser: str | None = None,
    curve: str = "auto",
    brackets: int = 1,
    even_exposure: bool = False,
    unknown_exposure: bool = False,
    frames: int | None = None,
    holdout: int | Sequence[str] | None = None,
    shrink: int = 1,
    unit: str | None = None,
    place: str = "auto",
    front: str | None = None,
    apply: bool = False,
    skip_missing: bool = False,
    leave_out: Sequence[str] = (),
    light_frame: str | None = None,
    progress: Progress | None = None,
) -> Path:
    """Bring a capture of ``format`` (``transforms``, ``colmap``, ``metashape``, ``emily``, ``tracked``) at ``path`` into the
    capture folder ``out``, with ``import.json``, which lists the assumptions; returns the folder.

    ``mesh`` is an OBJ with texture coordinates, of which ``objects`` are the face, or ``hull``: the visual hull of
    the masks. ``uv`` is ``auto`` (a mesh without texture coordinates, or with a hundred islands of them or more, is
    unwrapped), ``keep`` or ``new``. ``pictures`` is the folder of the photographs, where the files do not name it.
    ``masks`` is a folder of masks, ``alpha`` (that of the photographs), ``silhouette`` (of the mesh) or ``grabcut``
    (what differs from the surroundings of the place that the cameras look at); by default those that the file names,
    else alpha, else the silhouette, or for a hull ``grabcut``. ``labels`` is a folder of a face parser's pictures and
    ``parser`` its name or a JSON file of names by id. ``curve`` is the photographs' transfer curve (``auto``, ``srgb``,
    ``linear``, ``rec709``, ``gamma=2.2``), ``brackets`` how many exposures each view has, ``even_exposure`` divides by
    what EXIF says the camera let through, ``unknown_exposure`` states that exposure and white balance differ by unknown
    factors, which a solve estimates. ``frames`` chooses so many frames of a video, sharp ones from all sides.
    ``holdout`` withholds every n-th view (from the n-th on) or those named; ``shrink`` averages so many pixels a side.
    ``unit`` (``m``, ``cm``, ``mm``, ``dm``, ``in``) is the source's; ``place`` is ``auto``, ``keep`` or ``cameras``
    (upright by the cameras), ``front`` the name of a view that looks at the face, where cameras stand all round. If one
    change of a convention makes masks and mesh fit, ``apply`` makes it; without it that change is the error.
    ``skip_missing`` leaves out views whose photograph or mask is missing, ``leave_out`` those named. ``light_frame`` is
    ``camera`` if the light stands still with respect to the camera (a head that turns in a room, or a lamp on the
    camera), by default what the file states, else ``head``.

    Raises `CaptureError`, `PictureError` or `StorageError`.
    """

    def path_of(value: AnyPath | None) -> Path | None:
        return None if value is None else Path(value)

    choices = Choices(
        mesh=mesh if mesh == HULL else path_of(mesh),
        objects=tuple(objects),
        uv=uv,
        pictures=path_of(pictures),
        masks=masks if isinstance(masks, str) and masks in MASKS else path_of(masks),
        labels=path_of(labels),
        holdout=holdout if holdout is None or isinstance(holdout, int) else tuple(holdout),
        leave_out=tuple(leave_out),
        parser=parser, curve=curve, brackets=brackets, even_exposure=even_exposure,
        unknown_exposure=unknown_exposure, frames=frames, shrink=shrink, unit=unit, place=place,
        front=front, apply=apply, skip_missing=skip_missing,
        light_frame=light_frame,
    )  # fmt: skip
    choices.check()
    source = read_source(format, Path(path), choices.pictures)
    CaptureImport(format, Path(path), source, choices, progress or (lambda done, total, what: None)).write(Path(out))
    return Path(out)


__all__ = ["CaptureWarning", "import_capture"]

"""``transforms.json`` as nerfstudio, instant-ngp and programs after them write it."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import CaptureError
from ..stated_light import light_frame_of
from .source import FieldOfView, Lens, Matrix, Source, SourceView, frame_names, moved, rigid

_MODELS = {
    "PINHOLE": (),
    "SIMPLE_PINHOLE": (),
    "SIMPLE_RADIAL": ("k1",),
    "RADIAL": ("k1", "k2"),
    "OPENCV": ("k1", "k2", "p1", "p2", "k3"),
    "FULL_OPENCV": ("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"),
    "OPENCV_FISHEYE": ("k1", "k2", "k3", "k4"),
}
"""Lens models and the terms that they have."""

_ENDINGS = (".exr", ".png", ".jpg", ".jpeg", ".tif", ".tiff", ".JPG", ".JPEG", ".PNG", ".TIF", ".TIFF")
"""Endings of a picture that is named without one; Blender's exporters name none."""


_TRAIN, *_SET_ASIDE = _SPLIT = ("transforms_train.json", "transforms_val.json", "transforms_test.json")
"""The files of a capture that is split by files; all but the first hold views that are withheld."""


@dataclass(frozen=True)
class _Frames:
    """The frames of one file, the paths of their pictures, and the matrix that the file states as applied."""

    path: Path
    document: dict[str, Any]
    frames: list[dict[str, Any]]
    pictures: list[str]
    undo: Matrix
    applied: Matrix | None


def read_transforms(path: Path) -> Source:
    """Reads the file, or the folder that holds it or the files of a split. Raises `CaptureError`."""
    parts = [_frames(file) for file in transforms_files(path)]
    paths = [picture for part in parts for picture in part.pictures]
    names = [str(frame.get("name") or "") for part in parts for frame in part.frames]
    if not all(names) or frame_names(names) != names:
        names = frame_names(paths)
    views: list[SourceView] = []
    withheld: list[str] = []
    for part in parts:
        own = names[len(views) : len(views) + len(part.frames)]
        views += [_view(part.path, part.document, *pair, part.undo) for pair in zip(part.frames, own)]
        withheld += own if part.path.name in _SET_ASIDE and len(parts) > 1 else _withheld(part, own)
    views, withheld = _once(views, withheld)
    first = parts[0]
    elsewhere = None
    if first.applied is not None:
        words = "the mesh was moved by applied_transform as the cameras were, so it is not to be undone"
        elsewhere = ("applied-transform", words, first.applied)
    mesh = first.document.get("mesh")
    return Source(
        origin=first.path,
        views=tuple(views),
        mesh=_beside(first.path, mesh) if isinstance(mesh, str) else None,
        withheld=tuple(withheld),
        elsewhere=elsewhere,
        label_names=_label_names(first.path, first.document.get("label_names")),
        light_frame=light_frame_of(first.path, first.document),
        unknown_exposure=first.document.get("exposure") == "unknown",
        assumed=_not_read(first.path, parts),
    )


def transforms_files(path: Path) -> list[Path]:
    """The file that ``path`` is or holds, or the files of a split. Raises `CaptureError`."""
    if not path.is_dir():
        return [path]
    split = [path / name for name in _SPLIT if (path / name).is_file()]
    if (path / "transforms.json").is_file() or not split:
        return [path / "transforms.json"]
    if split[0].name != _TRAIN:
        raise CaptureError(f"{path}: has {split[0].name}, but not {_TRAIN}; add it, or name one file")
    return split


def _not_read(path: Path, parts: list[_Frames]) -> tuple[str, ...]:
    read = {part.path.name for part in parts}
    beside = [name for name in _SPLIT if name not in read and (path.parent / name).is_file()]
    return (f"{path.name} is read, {', '.join(beside)} next to it is not",) if beside else ()


def _frames(path: Path) -> _Frames:
    document = read_document(path)
    listed = document.get("frames")
    if not isinstance(listed, list) or not all(isinstance(frame, dict) for frame in listed):
        raise CaptureError(f"{path}: has no list of frames; export the cameras as nerfstudio or instant-ngp do")
    undo, applied = _undone(path, document)
    return _Frames(path, document, listed, [_text(path, frame, "file_path") for frame in listed], undo, applied)


def _once(views: list[SourceView], withheld: list[str]) -> tuple[list[SourceView], list[str]]:
    """The views without those that are withheld twice, as where val repeats test."""
    kept: list[SourceView] = []
    aside: dict[Path, SourceView] = {}
    for view in views:
        if view.name in withheld:
            same = aside.setdefault(view.picture, view)
            if same is not view and np.allclose(same.camera_to_world, view.camera_to_world):
                continue
        kept.append(view)
    names = {view.name for view in kept}
    return kept, [name for name in withheld if name in names]


def read_document(path: Path) -> dict[str, Any]:
    """The table of a file. Raises `CaptureError`."""
    try:
        document = json.loads(path.read_bytes().decode("utf-8-sig"))
    except OSError as error:
        raise CaptureError(f"{path}: cannot be read: {error.strerror}; name transforms.json or its folder") from error
    except (ValueError, RecursionError) as error:
        raise CaptureError(f"{path}: is not JSON: {error}; export it again") from error
    if not isinstance(document, dict):
        raise CaptureError(f"{path}: is a JSON list, not a table with frames; export it again")
    return document


def _undone(path: Path, document: Mapping[str, Any]) -> tuple[Matrix, Matrix | None]:
    """Matrix from the cameras' world to the mesh's, and the matrix that the file states as applied."""
    stated = document.get("applied_transform")
    scale = document.get("applied_scale", 1.0)
    if stated is None and scale == 1.0:
        return np.eye(4), None
    applied = np.eye(4)
    if stated is not None:
        applied = _matrix(path, "applied_transform", stated)
    if not isinstance(scale, (int, float)) or not 0 < scale < math.inf:
        raise CaptureError(f"{path}: applied_scale is {scale!r}; it must be a positive number")
    # nerfstudio turns the cameras first, and scales the outcome.
    whole = np.diag([scale, scale, scale, 1.0]) @ applied
    try:
        return np.asarray(np.linalg.inv(whole), np.float64), whole
    except np.linalg.LinAlgError as error:
        raise CaptureError(
            f"{path}: applied_transform cannot be undone; drop it if the mesh was moved likewise"
        ) from error


def _view(path: Path, document: Mapping[str, Any], frame: Mapping[str, Any], name: str, undo: Matrix) -> SourceView:
    def value(key: str) -> float | None:
        return _number(path, name, frame, key, _number(path, name, document, key, None))

    file_path = _text(path, frame, "file_path")
    width, height = value("w"), value("h")
    for key, side in (("w", width), ("h", height)):
        if side is not None and (side != int(side) or not 0 < side <= 65535):
            raise CaptureError(f"{path}: frame {name!r}: {key} is {side:g}; it must be a whole number of pixels")
    focal = _focal(path, name, (frame, document), width, height)
    cx, cy = value("cx"), value("cy")
    centre = None
    if cx is not None or cy is not None:
        if width is None or height is None:
            raise CaptureError(f"{path}: frame {name!r}: has cx or cy without w and h; state all four")
        centre = (width / 2 if cx is None else cx, height / 2 if cy is None else cy)
    mask, label = frame.get("mask_path"), frame.get("label_path")
    return SourceView(
        name=name,
        stated=f"frame {file_path!r} of {path.name}",
        picture=picture_file(path, file_path),
        camera_to_world=moved(
            undo, rigid(_matrix(path, f"transform_matrix of frame {name!r}", frame.get("transform_matrix")))
        ),
        focal=focal,
        centre=centre,
        width=None if width is None else int(width),
        height=None if height is None else int(height),
        lens=_lens(path, name, document, frame, value),
        mask=_beside(path, mask) if isinstance(mask, str) else None,
        label=_beside(path, label) if isinstance(label, str) else None,
        light=None if frame.get("light") is None else _text(path, frame, "light"),
    )


def _focal(
    path: Path, name: str, tables: tuple[Mapping[str, Any], ...], width: float | None, height: float | None
) -> tuple[float, float] | FieldOfView:
    """Focal lengths, or what fields of view make of them; the frame's own go before those for all."""
    angles: list[float | None] = []
    lengths: list[float | None] = []
    for key, angle, side in (("fl_x", "camera_angle_x", width), ("fl_y", "camera_angle_y", height)):
        length = field = None
        for table in tables:
            length, field = (_number(path, name, table, word, None) for word in (key, angle))
            if length is not None or field is not None:
                break
        if length is None and field is not None:
            if not 0 < field < math.pi:
                raise CaptureError(f"{path}: frame {name!r}: {angle} is {field:g}; it is an angle in radians, 0 to pi")
            length = None if side is None else side / 2 / math.tan(field / 2)
        lengths.append(length)
        angles.append(field if length is None else None)
    x, y = lengths
    if x is None and y is None:
        if angles == [None, None]:
            raise CaptureError(f"{path}: frame {name!r}: has no fl_x; state fl_x and fl_y, the focal length in pixels")
        return FieldOfView(*angles)
    return x or y or 0.0, y or x or 0.0


def _lens(path: Path, name: str, document: Mapping[str, Any], frame: Mapping[str, Any], value: Any) -> Lens:
    model = frame.get("camera_model", document.get("camera_model"))
    if frame.get("is_fisheye", document.get("is_fisheye", False)):
        model = "OPENCV_FISHEYE"
    terms = {key: value(key) or 0.0 for key in ("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6")}
    if model is None:
        # instant-ngp names no model; its terms are OpenCV's, and k3 and k4 those of its fisheye.
        model = "FULL_OPENCV" if any(terms[key] for key in ("k4", "k5", "k6")) else "OPENCV"
    if model not in _MODELS:
        known = ", ".join(_MODELS)
        raise CaptureError(f"{path}: frame {name!r}: camera_model {model!r} is unknown; undistort to one of {known}")
    own = _MODELS[model]
    strange = [key for key, term in terms.items() if term and key not in own]
    if strange:
        raise CaptureError(
            f"{path}: frame {name!r}: camera_model {model} has no {strange[0]}; state the model that has it, or drop the term"
        )
    return Lens({key: terms[key] for key in own if terms[key]}, fisheye=model == "OPENCV_FISHEYE")


def _withheld(part: _Frames, names: list[str]) -> list[str]:
    document = part.document
    listed = [*(document.get("test_filenames") or []), *(document.get("val_filenames") or [])]
    plain = {_plain(file_path): name for file_path, name in zip(part.pictures, names)}
    strange = [file_path for file_path in map(str, listed) if _plain(file_path) not in plain]
    if strange:
        raise CaptureError(
            f"{part.path}: test_filenames names {strange[0]}, which no frame has; add the frame or drop the name"
        )
    return [plain[_plain(str(file_path))] for file_path in listed]


def _label_names(path: Path, table: Any) -> dict[int, str]:
    try:
        return {int(number): str(name).lower() for number, name in (table or {}).items()}
    except (AttributeError, ValueError) as error:
        raise CaptureError(
            f'{path}: label_names is not a table of names by id, as {{"1": "skin"}}; fix or drop it'
        ) from error


def _matrix(path: Path, what: str, value: Any) -> Matrix:
    try:
        matrix = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        matrix = np.zeros(0)
    if matrix.shape == (3, 4):
        matrix = np.concatenate([matrix, [[0.0, 0.0, 0.0, 1.0]]])
    if matrix.shape != (4, 4) or not np.isfinite(matrix).all() or not np.allclose(matrix[3], [0, 0, 0, 1], atol=1e-6):
        raise CaptureError(
            f"{path}: {what} is not a matrix of four rows of four numbers with 0, 0, 0, 1 last; export it again"
        )
    return matrix


def _number(path: Path, name: str, table: Mapping[str, Any], key: str, default: float | None) -> float | None:
    value = table.get(key)
    if value is None:
        return default
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise CaptureError(f"{path}: frame {name!r}: {key} is {value!r}; it must be a number")
    return float(value)


def _text(path: Path, frame: Mapping[str, Any], key: str) -> str:
    value = frame.get(key)
    if not isinstance(value, str) or not value:
        raise CaptureError(f"{path}: a frame has no {key}; name its picture")
    return value


def _plain(file_path: str) -> str:
    return "/".join(part for part in file_path.replace("\\", "/").split("/") if part not in ("", "."))


def _beside(path: Path, name: str) -> Path:
    return path.parent / name.replace("\\", "/")


def picture_file(path: Path, file_path: str) -> Path:
    """The picture's file; a name without an ending takes the one that is there."""
    named = _beside(path, file_path)
    if named.is_file():
        return named
    there = [file for ending in _ENDINGS if (file := named.with_name(named.name + ending)).is_file()]
    others = [file for file in there[1:] if not file.samefile(there[0])]
    if others:
        raise CaptureError(
            f"{path}: {file_path!r} could be {there[0].name} or {others[0].name}; state the ending in file_path"
        )
    return there[0] if there else named

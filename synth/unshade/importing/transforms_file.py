"""``transforms.json`` as nerfstudio, instant-ngp and programs after them write it."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import CaptureError
from .source import Lens, Matrix, Source, SourceView, frame_names, moved, rigid

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


def read_transforms(path: Path) -> Source:
    """Reads the file, or the folder that holds it. Raises `CaptureError`."""
    path = path / "transforms.json" if path.is_dir() else path
    document = _document(path)
    listed = document.get("frames")
    if not isinstance(listed, list) or not all(isinstance(frame, dict) for frame in listed):
        raise CaptureError(f"{path}: has no list of frames; export the cameras as nerfstudio or instant-ngp do")
    undo, applied = _undone(path, document)
    elsewhere = None
    if applied is not None:
        words = "the mesh was moved by applied_transform as the cameras were, so it is not to be undone"
        elsewhere = ("applied-transform", words, applied)
    paths = [_text(path, frame, "file_path") for frame in listed]
    names = [str(frame.get("name") or "") for frame in listed]
    if not all(names) or frame_names(names) != names:
        names = frame_names(paths)
    views = [_view(path, document, frame, name, undo) for frame, name in zip(listed, names)]
    mesh = document.get("mesh")
    return Source(
        origin=path,
        views=tuple(views),
        mesh=_beside(path, mesh) if isinstance(mesh, str) else None,
        withheld=_withheld(path, document, paths, names),
        elsewhere=elsewhere,
        label_names=_label_names(path, document.get("label_names")),
    )


def _document(path: Path) -> dict[str, Any]:
    try:
        document = json.loads(path.read_bytes().decode("utf-8-sig"))
    except OSError as error:
        raise CaptureError(f"{path}: cannot be read: {error.strerror}; name transforms.json or its folder") from error
    except (ValueError, RecursionError) as error:
        raise CaptureError(f"{path}: is no JSON: {error}; export it again") from error
    if not isinstance(document, dict):
        raise CaptureError(f"{path}: is a JSON list, not a table with frames; export it again")
    return document


def _undone(path: Path, document: Mapping[str, Any]) -> tuple[Matrix, Matrix | None]:
    """Matrix from the cameras' world to the mesh's, and the matrix that the file says was applied."""
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
    along = _focal(path, name, frame, document, "fl_x", "camera_angle_x", width)
    across = _focal(path, name, frame, document, "fl_y", "camera_angle_y", height)
    if along is None and across is None:
        raise CaptureError(f"{path}: frame {name!r}: has no fl_x; state fl_x and fl_y, the focal length in pixels")
    focal = (along or across or 0.0, across or along or 0.0)
    cx, cy = value("cx"), value("cy")
    centre = None
    if cx is not None or cy is not None:
        if width is None or height is None:
            raise CaptureError(f"{path}: frame {name!r}: has cx or cy without w and h; state all four")
        centre = (width / 2 if cx is None else cx, height / 2 if cy is None else cy)
    mask, label = frame.get("mask_path"), frame.get("label_path")
    return SourceView(
        name=name,
        picture=_picture(path, file_path),
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
    )


def _focal(
    path: Path,
    name: str,
    frame: Mapping[str, Any],
    document: Mapping[str, Any],
    key: str,
    angle: str,
    side: float | None,
) -> float | None:
    """A focal length, or what a field of view makes of it; the frame's own go before those for all."""
    for table in (frame, document):
        stated = _number(path, name, table, key, None)
        if stated is not None:
            return stated
        field = _number(path, name, table, angle, None)
        if field is not None:
            if side is None:
                raise CaptureError(
                    f"{path}: frame {name!r}: has {angle} without w and h; state the picture's size in pixels"
                )
            if not 0 < field < math.pi:
                raise CaptureError(f"{path}: frame {name!r}: {angle} is {field:g}; it is an angle in radians, 0 to pi")
            return side / 2 / math.tan(field / 2)
    return None


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


def _withheld(path: Path, document: Mapping[str, Any], paths: list[str], names: list[str]) -> tuple[str, ...]:
    listed = [*(document.get("test_filenames") or []), *(document.get("val_filenames") or [])]
    if "test_filenames" not in document and "val_filenames" not in document:
        return ()
    plain = {_plain(file_path): name for file_path, name in zip(paths, names)}
    found = []
    for file_path in map(str, listed):
        if _plain(file_path) not in plain:
            raise CaptureError(
                f"{path}: test_filenames names {file_path}, which no frame has; add the frame or drop the name"
            )
        found.append(plain[_plain(file_path)])
    return tuple(found)


def _label_names(path: Path, table: Any) -> dict[int, str]:
    try:
        return {int(number): str(name).lower() for number, name in (table or {}).items()}
    except (AttributeError, ValueError) as error:
        raise CaptureError(
            f'{path}: label_names is no table of names by id, as {{"1": "skin"}}; mend or drop it'
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
            f"{path}: {what} is no matrix of four rows of four numbers with 0, 0, 0, 1 last; export it again"
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


def _picture(path: Path, file_path: str) -> Path:
    """The picture's file; a name without an ending takes the first that is there."""
    named = _beside(path, file_path)
    if named.is_file():
        return named
    for ending in _ENDINGS:
        candidate = named.with_name(named.name + ending)
        if candidate.is_file():
            return candidate
    return named

"""A COLMAP model, text or binary: ``cameras`` and ``images``, as RealityCapture exports them too.

Newer versions add ``rigs`` and ``frames``; ``images`` still holds every picture's own pose, so they are
not needed. COLMAP's pixel centres lie at +.5, as ours do.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

import numpy as np

from ..errors import CaptureError
from .source import OPENCV_AXES, Lens, Source, SourceView, frame_names, quaternion_matrix

_MODELS: tuple[tuple[str, tuple[str, ...]], ...] = (
    ("SIMPLE_PINHOLE", ("f", "cx", "cy")),
    ("PINHOLE", ("fx", "fy", "cx", "cy")),
    ("SIMPLE_RADIAL", ("f", "cx", "cy", "k1")),
    ("RADIAL", ("f", "cx", "cy", "k1", "k2")),
    ("OPENCV", ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2")),
    ("OPENCV_FISHEYE", ("fx", "fy", "cx", "cy", "k1", "k2", "k3", "k4")),
    ("FULL_OPENCV", ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6")),
    ("FOV", ("fx", "fy", "cx", "cy", "omega")),
    ("SIMPLE_RADIAL_FISHEYE", ("f", "cx", "cy", "k1")),
    ("RADIAL_FISHEYE", ("f", "cx", "cy", "k1", "k2")),
    ("THIN_PRISM_FISHEYE", ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "k4", "sx1", "sy1")),
)
"""Camera models in the order of their ids, and their parameters (COLMAP: src/colmap/sensor/models.h)."""

_NO_POINT = 24
"""Bytes of a picture's point in images.bin: two coordinates and the id of its 3D point."""

_LONGEST_NAME = 4096

_Camera = tuple[int, int, dict[str, float], bool]
"""Width, height, parameters by name, whether the model is a fisheye."""

_Image = tuple[int, list[float], str]
"""Id of its camera, quaternion w x y z and translation (world to camera, OpenCV axes), picture."""


def read_colmap(path: Path, pictures: Path | None = None) -> Source:
    """Reads a model's folder, or a project's with ``sparse`` in it, of whose models the largest.

    ``pictures`` is the folder that names of pictures are below; without it, ``images`` beside or above
    the model. Raises `CaptureError`.
    """
    models = [(folder, *_read(folder)) for folder in _models(path)]
    models.sort(key=lambda model: -len(model[2]))
    (folder, cameras, images), others = models[0], models[1:]
    if others and len(others[0][2]) == len(images):
        raise CaptureError(
            f"{path}: the models {folder} and {others[0][0]} have {len(images)} views each; "
            "name the one that the mesh was made from"
        )
    origin = folder / f"images{_ending(folder)}"
    in_largest = {picture for _, _, picture in images}
    left_out = [
        (picture, f"is in {other} alone, a model of {len(theirs)} views; {folder} has {len(images)}")
        for other, _, theirs in others
        for _, _, picture in sorted(theirs, key=lambda image: image[2])
        if picture not in in_largest
    ]
    below = pictures or _pictures(path, folder, [name for _, _, name in images])
    # By their names: the order of a model is that of a hash table.
    images = sorted(images, key=lambda image: image[2])
    names = frame_names([picture for _, _, picture in images])
    views = []
    for (camera_id, pose, picture), name in zip(images, names):
        if camera_id not in cameras:
            raise CaptureError(f"{origin}: {picture}: its camera {camera_id} is not in cameras; export the model again")
        width, height, parameters, fisheye = cameras[camera_id]
        focal = parameters.get("f", 0.0)
        views.append(
            SourceView(
                name=name,
                picture=below / picture.replace("\\", "/"),
                camera_to_world=_camera_to_world(pose),
                focal=(parameters.get("fx", focal), parameters.get("fy", focal)),
                centre=(parameters["cx"], parameters["cy"]),
                width=width,
                height=height,
                lens=Lens({k: v for k, v in parameters.items() if k[0] in "kp" and v}, fisheye),
                stated=f"image {picture!r}",
            )
        )
    # COLMAP reads the pixels as they are stored and ignores EXIF orientation.
    assumed = [f"{folder} is the largest of {len(models)} models"] if others else []
    return Source(
        origin=origin,
        views=tuple(views),
        exif_applied=False,
        assumed=tuple(assumed),
        left_out=tuple(left_out),
        whole_folders=True,
    )


def _models(path: Path) -> list[Path]:
    """The models of a project: the folder itself, or all that COLMAP left beside one another, in no order of size."""
    if _ending(path):
        return [path]
    for parent in (path / "sparse", path / "colmap" / "sparse", path):
        if _ending(parent):
            return [parent]
        found = [folder for folder in sorted(parent.iterdir()) if _ending(folder)] if parent.is_dir() else []
        if found:
            return found
    raise CaptureError(f"{path}: holds no cameras and images, .bin or .txt; name a COLMAP model's folder")


def _ending(folder: Path) -> str | None:
    """The ending of a model's files, None where there is no model."""
    for ending in (".bin", ".txt"):
        if (folder / f"cameras{ending}").is_file() and (folder / f"images{ending}").is_file():
            return ending
    return None


def _read(folder: Path) -> tuple[dict[int, _Camera], list[_Image]]:
    if _ending(folder) == ".bin":
        return _read_binary(folder)
    return _text_cameras(folder / "cameras.txt"), _text_images(folder / "images.txt")


def _pictures(path: Path, folder: Path, names: list[str]) -> Path:
    """The folder that has most of the pictures: ``images`` of the project, or where it lies beside the model."""
    tried = [
        path / "images",
        folder / "images",
        folder.parent / "images",
        folder.parent.parent / "images",
        folder,
        path,
    ]
    return max(tried, key=lambda below: sum((below / name.replace("\\", "/")).is_file() for name in names))


def _camera_to_world(pose: list[float]) -> np.ndarray:
    rotation = quaternion_matrix(*pose[:4])
    matrix = np.eye(4)
    matrix[:3, :3] = rotation.T
    matrix[:3, 3] = -rotation.T @ pose[4:]
    return matrix @ OPENCV_AXES


def _camera(where: str, model: str, width: int, height: int, values: list[float]) -> _Camera:
    known = dict(_MODELS)
    if model not in known or model in ("FOV", "THIN_PRISM_FISHEYE"):
        raise CaptureError(f"{where}: camera model {model} is not read; undistort with `colmap image_undistorter`")
    if len(values) != len(known[model]):
        raise CaptureError(
            f"{where}: {model} has {len(known[model])} parameters, not {len(values)}; export the model again"
        )
    return width, height, dict(zip(known[model], values)), model.endswith("FISHEYE")


def _lines(path: Path) -> Iterator[tuple[int, str]]:
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
    except OSError as error:
        raise CaptureError(f"{path}: cannot be read: {error.strerror}; export the model again") from error
    for number, line in enumerate(text.splitlines(), 1):
        if not line.startswith("#"):
            yield number, line


def _text_cameras(path: Path) -> dict[int, _Camera]:
    cameras: dict[int, _Camera] = {}
    for number, line in _lines(path):
        words = line.split()
        if not words:
            continue
        where = f"{path}:{number}"
        try:
            key, model, width, height = int(words[0]), words[1], int(words[2]), int(words[3])
            values = [float(word) for word in words[4:]]
        except (ValueError, IndexError) as error:
            raise CaptureError(
                f"{where}: is not an id, model, width, height and parameters; export the model again"
            ) from error
        cameras[key] = _camera(where, model, width, height, values)
    return cameras


def _text_images(path: Path) -> list[_Image]:
    images: list[_Image] = []
    lines = _lines(path)
    for number, line in lines:
        words = line.split(maxsplit=9)
        if not words:
            continue
        try:
            pose = [float(word) for word in words[1:8]]
            images.append((int(words[8]), pose, words[9].strip()))
        except (ValueError, IndexError) as error:
            raise CaptureError(
                f"{path}:{number}: is not an id, quaternion, translation, camera and name; export the model again"
            ) from error
        next(lines, None)  # The line of its points, which may be empty.
    return images


def _read_binary(folder: Path) -> tuple[dict[int, _Camera], list[_Image]]:
    path = folder / "cameras.bin"
    try:
        with path.open("rb") as file:
            cameras = _binary_cameras(path, file)
        path = folder / "images.bin"
        with path.open("rb") as file:
            return cameras, _binary_images(file, path.stat().st_size)
    except OSError as error:
        raise CaptureError(f"{path}: cannot be read: {error.strerror}; export the model again") from error
    except (struct.error, ValueError) as error:
        raise CaptureError(f"{path}: ends early or is not a COLMAP file; export the model again") from error


def _unpack(file: BinaryIO, form: str) -> tuple[float, ...]:
    return struct.unpack("<" + form, file.read(struct.calcsize("<" + form)))


def _binary_cameras(path: Path, file: BinaryIO) -> dict[int, _Camera]:
    cameras: dict[int, _Camera] = {}
    (count,) = _unpack(file, "Q")
    for _ in range(int(count)):
        key, model, width, height = (int(value) for value in _unpack(file, "iiQQ"))
        where = f"{path}: camera {key}"
        if not 0 <= model < len(_MODELS):
            raise CaptureError(f"{where}: camera model {model} is not read; undistort with `colmap image_undistorter`")
        name, parameters = _MODELS[model]
        cameras[key] = _camera(where, name, width, height, list(_unpack(file, f"{len(parameters)}d")))
    return cameras


def _binary_images(file: BinaryIO, size: int) -> list[_Image]:
    images: list[_Image] = []
    (count,) = _unpack(file, "Q")
    for _ in range(int(count)):
        _, *pose, camera = _unpack(file, "i7di")
        name = bytearray()
        while (letter := file.read(1)) != b"\0":
            if not letter or len(name) > _LONGEST_NAME:
                raise ValueError("a name without an end")
            name += letter
        (points,) = _unpack(file, "Q")
        if points * _NO_POINT > size - file.tell():
            raise ValueError("more points than the file holds")
        file.seek(int(points) * _NO_POINT, 1)
        images.append((int(camera), list(pose), name.decode("utf-8", "replace")))
    return images

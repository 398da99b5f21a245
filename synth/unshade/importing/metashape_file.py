"""Cameras as Agisoft Metashape exports them (XML): sensors, cameras, and the transforms of chunks.

A camera's matrix is in the coordinates of its component or chunk, OpenCV axes; the transform of these
puts it where exported meshes are. Metashape counts pixels from the corner, as we do, and its principal
point from the middle of the picture.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as xml
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import CaptureError
from .source import OPENCV_AXES, Lens, Matrix, Source, SourceView, frame_names, moved, rigid

_PICTURES = (".exr", ".tif", ".tiff", ".png", ".jpg", ".jpeg")

_NO_TERM = ("b2", "k4", "p3", "p4")
"""Terms of Metashape's frame cameras that OpenCV's lens has not."""

_LARGEST = 1 << 28
"""Bytes of a camera file, at most; a thousand cameras with their covariances take a few million."""


@dataclass(frozen=True)
class _Sensor:
    width: int
    height: int
    focal: tuple[float, float]
    centre: tuple[float, float]
    lens: Lens


def read_metashape(path: Path, pictures: Path | None = None) -> Source:
    """Reads the file. ``pictures`` is the folder of the photographs, by default the file's own or its
    ``images``; a camera's label names its photograph, with or without its ending. Raises `CaptureError`.
    """
    root = _document(path)
    chunks = [chunk for chunk in root.iter("chunk") if chunk.find("cameras") is not None]
    if not chunks:
        raise CaptureError(f"{path}: has no chunk with cameras; export cameras as Agisoft XML")
    found: list[tuple[str, _Sensor, Matrix]] = []
    outer: list[Matrix] = []
    left_out: list[str] = []
    for chunk in chunks:
        if chunk.get("enabled") in ("false", "0"):
            left_out.append(f"chunk {chunk.get('label', '?')!r} is disabled")
            continue
        sensors = _sensors(path, chunk)
        placed = {c.get("id"): t for c in chunk.iter("component") if (t := _similarity(path, c)) is not None}
        whole = _similarity(path, chunk)
        for camera in chunk.iter("camera"):
            label = camera.get("label") or f"camera {camera.get('id', '?')}"
            reason = _unusable(camera, sensors)
            if reason:
                left_out.append(f"{label}: {reason}")
                continue
            place = placed.get(camera.get("component_id"), whole)
            matrix = _numbers(path, f"transform of {label}", camera.findtext("transform"), 16).reshape(4, 4)
            outer.append(np.eye(4) if place is None else place)
            found.append((label, sensors[camera.get("sensor_id")], matrix))
    if not found:
        told = f" ({'; '.join(left_out[:3])})" if left_out else ""
        raise CaptureError(
            f"{path}: no camera is enabled, aligned and calibrated{told}; align the photographs and export again"
        )
    files = _photographs(path, pictures)
    labels = [label for label, _, _ in found]
    views = tuple(
        SourceView(
            name=name,
            picture=_photograph(files, label, pictures or path.parent),
            camera_to_world=moved(place, rigid(matrix)) @ OPENCV_AXES,
            focal=sensor.focal,
            centre=sensor.centre,
            width=sensor.width,
            height=sensor.height,
            lens=sensor.lens,
        )
        for (label, sensor, matrix), place, name in zip(found, outer, frame_names(labels))
    )
    elsewhere = None
    if all(np.allclose(place, outer[0]) for place in outer) and not np.allclose(outer[0], np.eye(4)):
        words = "the mesh is in the chunk's own coordinates, so the chunk's transform is to be left out"
        elsewhere = ("chunk-transform", words, np.asarray(np.linalg.inv(outer[0]), np.float64))
    return Source(
        origin=path, views=views, elsewhere=elsewhere, assumed=tuple(f"left out: {reason}" for reason in left_out)
    )


def _document(path: Path) -> xml.Element:
    try:
        data = path.read_bytes()
    except OSError as error:
        raise CaptureError(f"{path}: cannot be read: {error.strerror}; name the XML file of the cameras") from error
    # Entities could grow without end; no export has any.
    if len(data) > _LARGEST or b"<!ENTITY" in data:
        raise CaptureError(f"{path}: is no camera file of Metashape; export cameras as Agisoft XML")
    try:
        return xml.fromstring(data)
    except (xml.ParseError, ValueError, LookupError) as error:
        raise CaptureError(f"{path}: is no XML: {error}; export cameras as Agisoft XML") from error


def _sensors(path: Path, chunk: xml.Element) -> dict[str | None, _Sensor]:
    sensors: dict[str | None, _Sensor] = {}
    for element in chunk.iter("sensor"):
        calibrations = element.findall("calibration")
        adjusted = [c for c in calibrations if c.get("class") == "adjusted"]
        # A sensor that was never calibrated has a focal length neither here nor there.
        usable = [c for c in (*adjusted, *calibrations) if c.find("f") is not None or c.find("fx") is not None]
        if usable:
            sensors[element.get("id")] = _sensor(path, element, usable[0])
    return sensors


def _sensor(path: Path, element: xml.Element, calibration: xml.Element) -> _Sensor:
    where = f"{path}: sensor {element.get('label') or element.get('id', '?')!r}"
    resolution = calibration.find("resolution")
    resolution = element.find("resolution") if resolution is None else resolution
    try:
        assert resolution is not None
        width, height = int(resolution.get("width", "")), int(resolution.get("height", ""))
    except (AssertionError, ValueError) as error:
        raise CaptureError(f"{where}: has no resolution; export the cameras again") from error

    def term(key: str, default: float = 0.0) -> float:
        text = calibration.findtext(key)
        return default if text is None else float(_numbers(path, f"{key} of a sensor", text, 1)[0])

    kind = element.get("type") or calibration.get("type") or "frame"
    if kind not in ("frame", "fisheye"):
        raise CaptureError(f"{where}: is of type {kind!r}; frame and fisheye are read: export undistorted photographs")
    fisheye = kind == "fisheye"
    strange = [key for key in (*(("b2", "p1", "p2") if fisheye else _NO_TERM),) if term(key)]
    if strange:
        raise CaptureError(
            f"{where}: has {strange[0]}, which OpenCV's lens has not; undistort the photographs in Metashape"
        )
    focal = term("f", term("fy"))
    terms = {"k1": term("k1"), "k2": term("k2"), "k3": term("k3")}
    # Metashape's first tangential term is OpenCV's second.
    terms |= {"k4": term("k4")} if fisheye else {"p1": term("p2"), "p2": term("p1")}
    return _Sensor(
        width,
        height,
        (term("fx", focal + term("b1")), term("fy", focal)),
        (width / 2 + term("cx"), height / 2 + term("cy")),
        Lens({key: value for key, value in terms.items() if value}, fisheye),
    )


def _unusable(camera: xml.Element, sensors: dict[str | None, _Sensor]) -> str | None:
    """Why a camera is left out, if it is."""
    if camera.get("enabled") in ("false", "0"):
        return "is disabled"
    if not (camera.findtext("transform") or "").strip():
        return "was not aligned"
    if camera.get("sensor_id") not in sensors:
        return "its sensor has no calibration"
    return None


def _similarity(path: Path, element: xml.Element) -> Matrix | None:
    """The transform of a chunk or component, if it has one."""
    transform = element.find("transform")
    if transform is None:
        return None
    matrix = np.eye(4)
    rotation, translation = transform.findtext("rotation"), transform.findtext("translation")
    scale = float(_numbers(path, "scale of a transform", transform.findtext("scale") or "1", 1)[0])
    if rotation is None and translation is None and (transform.text or "").strip():
        return _numbers(path, "transform of a chunk", transform.text, 16).reshape(4, 4)
    if rotation:
        matrix[:3, :3] = _numbers(path, "rotation of a transform", rotation, 9).reshape(3, 3)
    if translation:
        matrix[:3, 3] = _numbers(path, "translation of a transform", translation, 3)
    matrix[:3, :3] *= scale
    if abs(np.linalg.det(matrix)) < 1e-30:
        raise CaptureError(f"{path}: a chunk's transform has no size; export the cameras again")
    return matrix


def _numbers(path: Path, what: str, text: str | None, count: int) -> Matrix:
    try:
        values = [float(word) for word in (text or "").split()]
    except ValueError:
        values = []
    if len(values) != count or not all(map(math.isfinite, values)):
        raise CaptureError(f"{path}: {what} is no list of {count} numbers; export the cameras again")
    return np.array(values)


def _photographs(path: Path, pictures: Path | None) -> dict[str, Path]:
    """Photographs by name and by stem, lower case."""
    files: dict[str, Path] = {}
    for folder in [pictures] if pictures else [path.parent, path.parent / "images"]:
        if folder.is_dir():
            for file in sorted(folder.iterdir()):
                if file.suffix.lower() in _PICTURES:
                    files.setdefault(file.stem.casefold(), file)
                    files.setdefault(file.name.casefold(), file)
    return files


def _photograph(files: dict[str, Path], label: str, below: Path) -> Path:
    name = label.replace("\\", "/").rsplit("/", 1)[-1]
    return files.get(name.casefold()) or files.get(Path(name).stem.casefold()) or below / name

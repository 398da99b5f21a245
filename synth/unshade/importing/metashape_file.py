"""Cameras as Agisoft Metashape exports them (XML): sensors, cameras, and the transforms of chunks.

A camera's matrix is in the coordinates of its component or chunk, OpenCV axes; the transform of these
puts it where exported meshes are. Metashape counts pixels from the corner, as we do, and its principal
point from the middle of the picture; PhotoScan up to 1.2 counted that from the corner too.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as xml
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import CaptureError
from .labelled_photographs import DEPTH, LabelledPhotographs
from .source import OPENCV_AXES, Lens, Matrix, Source, SourceView, frame_names, moved, rigid

_NO_TERM = ("b2", "skew", "k4", "p3", "p4")
"""Terms of Metashape's frame cameras that OpenCV's lens lacks."""

_FAR = 0.25
"""Shares of the picture's sides; no principal point lies so far from the middle."""

_OFF = ("false", "0")
"""Values of ``enabled``."""

_LARGEST = 1 << 28
"""Bytes of a camera file, at most; a thousand cameras with their covariances take a few million."""


@dataclass(frozen=True)
class _Sensor:
    width: int
    height: int
    focal: tuple[float, float]
    centre: tuple[float, float]
    lens: Lens
    from_corner: bool


@dataclass(frozen=True)
class _Camera:
    """A camera with a pose in the coordinates of its ``frame``, a component or chunk, and that frame's transform."""

    label: str
    groups: list[str]
    sensor: _Sensor
    pose: Matrix
    frame: str
    transform: Matrix | None
    is_slave: bool

    @property
    def stated(self) -> str:
        return f"camera {'/'.join([*self.groups[:1], self.label])!r} of {self.frame}"


def read_metashape(path: Path, pictures: Path | None = None) -> Source:
    """Reads the file. ``pictures`` is the folder of the photographs, by default the file's own or its
    ``images``; a camera's group and label name its photograph, with or without its ending. Raises `CaptureError`.
    """
    root = _document(path)
    chunks = [chunk for chunk in root.iter("chunk") if chunk.find("cameras") is not None]
    if not chunks:
        raise CaptureError(f"{path}: has no chunk with cameras; export cameras as Agisoft XML")
    found: list[_Camera] = []
    left_out: list[tuple[str, str]] = []
    for number, chunk in enumerate(chunks, 1):
        found += _cameras(path, chunk, chunk.get("label") or f"chunk {number}", left_out)
    if not found:
        told = f" ({'; '.join(f'{name}: {reason}' for name, reason in left_out[:3])})" if left_out else ""
        raise CaptureError(
            f"{path}: no camera is enabled, aligned and calibrated{told}; align the photographs and export again"
        )
    found = _in_one_frame(path, found, left_out)
    # Beside the file may lie anything, such as captures that were imported before.
    below = {pictures: DEPTH} if pictures else {path.parent: 0, path.parent / "images": DEPTH}
    photographs = LabelledPhotographs(below)
    files = [photographs.find(camera.label, camera.groups, f"{path}: {camera.stated}") for camera in found]
    views = tuple(
        SourceView(
            name=name,
            picture=file,
            camera_to_world=moved(np.eye(4) if camera.transform is None else camera.transform, rigid(camera.pose))
            @ OPENCV_AXES,
            focal=camera.sensor.focal,
            centre=camera.sensor.centre,
            width=camera.sensor.width,
            height=camera.sensor.height,
            lens=camera.sensor.lens,
            stated=camera.stated,
        )
        for camera, file, name in zip(found, files, frame_names([_below(file, [*below]) for file in files]))
    )
    elsewhere = None
    outer = [np.eye(4) if camera.transform is None else camera.transform for camera in found]
    if all(np.allclose(place, outer[0]) for place in outer) and not np.allclose(outer[0], np.eye(4)):
        words = "the mesh is in the chunk's own coordinates, so the chunk's transform is to be left out"
        elsewhere = ("chunk-transform", words, np.asarray(np.linalg.inv(outer[0]), np.float64))
    assumed = []
    if any(camera.sensor.from_corner for camera in found):
        assumed.append("principal points count from the picture's corner, as PhotoScan up to 1.2 wrote them")
    if any(camera.is_slave and not np.isclose(_scale(camera.transform), 1) for camera in found):
        assumed.append("locations of a rig's sensors are in the units of the cameras' matrices, as these are before the "
                       "chunk's scale")  # fmt: skip
    return Source(origin=path, views=views, elsewhere=elsewhere, assumed=tuple(assumed), left_out=tuple(left_out))


def _scale(transform: Matrix | None) -> float:
    return 1.0 if transform is None else float(np.cbrt(abs(np.linalg.det(transform[:3, :3]))))


def _below(file: Path, folders: list[Path]) -> str:
    """A photograph's path below its folder."""
    return next((file.relative_to(folder).as_posix() for folder in folders[::-1] if folder in file.parents), file.name)


def _cameras(path: Path, chunk: xml.Element, name: str, left_out: list[tuple[str, str]]) -> list[_Camera]:
    """The cameras of a chunk that have a pose and a calibration; the others go to ``left_out``."""
    sensors = _sensors(path, chunk)
    components = {element.get("id"): element for element in chunk.iter("component")}
    groups = {camera: group for group in chunk.iter("group") for camera in group.iter("camera")}
    # In the file of a project, frames list cameras again, by camera_id, with the paths of their photographs.
    elements = [camera for camera in chunk.iter("camera") if camera.get("camera_id") is None]
    by_id = {camera.get("id"): camera for camera in elements}
    found: list[_Camera] = []
    for camera in elements:
        label = camera.get("label") or f"camera {camera.get('id', '?')}"
        reason = f"chunk {name!r} is disabled" if chunk.get("enabled") in _OFF else _unusable(camera, by_id, sensors)
        if reason:
            left_out.append((label, reason))
            continue
        component = components.get(camera.get("component_id"))
        own = None if component is None else _similarity(path, component)
        frame = f"chunk {name!r}"
        if component is not None and len(components) > 1:
            frame += f", component {component.get('label') or component.get('id')!r}"
        group = groups.get(camera)
        found.append(
            _Camera(
                label=label,
                groups=[word for word in (None if group is None else group.get("label"), chunk.get("label")) if word],
                sensor=sensors[camera.get("sensor_id")],
                pose=_pose(path, label, camera, by_id, chunk),
                frame=frame,
                transform=_similarity(path, chunk) if own is None else own,
                is_slave=not (camera.findtext("transform") or "").strip(),
            )
        )
    return found


def _pose(
    path: Path, label: str, camera: xml.Element, by_id: dict[str | None, xml.Element], chunk: xml.Element
) -> Matrix:
    """Camera to chunk (4, 4), OpenCV axes. A slave of a rig has its master's, after its sensor's in the master."""
    text = camera.findtext("transform") or ""
    if text.strip():
        return _numbers(path, f"transform of {label}", text, 16).reshape(4, 4)
    master = by_id[camera.get("master_id")]
    sensor = next(element for element in chunk.iter("sensor") if element.get("id") == camera.get("sensor_id"))
    where = f"sensor {sensor.get('label') or sensor.get('id', '?')!r}"
    rotation, location = (sensor.findtext(key) or "" for key in ("rotation", "location"))
    if not rotation.strip() or not location.strip():
        raise CaptureError(
            f"{path}: {label} is a slave of {master.get('label', '?')} in a rig, but its {where} has no rotation and "
            "location in the rig; export the cameras as COLMAP, or split the camera system"
        )
    slave = np.eye(4)
    slave[:3, :3] = _numbers(path, f"rotation of {where}", rotation, 9).reshape(3, 3)
    slave[:3, 3] = _numbers(path, f"location of {where}", location, 3)
    return _numbers(path, f"transform of {master.get('label')}", master.findtext("transform"), 16).reshape(4, 4) @ slave


def _in_one_frame(path: Path, cameras: list[_Camera], left_out: list[tuple[str, str]]) -> list[_Camera]:
    """The cameras whose poses share one world: all if every chunk and component has a transform to it, else those
    of the chunk or component that has most. Raises `CaptureError` if two have as many."""
    frames = {camera.frame: camera.transform is not None for camera in cameras}
    if len(frames) == 1 or all(frames.values()):
        return cameras
    counts = Counter(camera.frame for camera in cameras).most_common()
    if counts[0][1] == counts[1][1]:
        raise CaptureError(
            f"{path}: {counts[0][0]} and {counts[1][0]} have {counts[0][1]} cameras each and no common coordinates; "
            "export the one that the mesh was made from"
        )
    largest, most = counts[0]
    for camera in cameras:
        if camera.frame != largest:
            reason = f"{camera.frame} has no coordinates in common with {largest}, which has most cameras, {most}"
            left_out.append((camera.label, reason))
    return [camera for camera in cameras if camera.frame == largest]


def _document(path: Path) -> xml.Element:
    try:
        data = path.read_bytes()
    except OSError as error:
        raise CaptureError(f"{path}: cannot be read: {error.strerror}; name the XML file of the cameras") from error
    # Entities could grow without end; no export has any.
    if len(data) > _LARGEST or b"<!ENTITY" in data:
        raise CaptureError(f"{path}: is not a camera file of Metashape; export cameras as Agisoft XML")
    try:
        return xml.fromstring(data)
    except (xml.ParseError, ValueError, LookupError) as error:
        raise CaptureError(f"{path}: is not XML: {error}; export cameras as Agisoft XML") from error


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
    offset = (term("cx"), term("cy"))
    # PhotoScan up to 1.2 wrote fx and fy, and counted from the corner; no principal point lies that far aside.
    photoscan = calibration.find("fx") is not None
    beyond = offset[0] > width * _FAR or offset[1] > height * _FAR
    from_corner = calibration.find("cx") is not None and (
        photoscan or (beyond and 0 < offset[0] < width and 0 < offset[1] < height)
    )
    terms = {"k1": term("k1"), "k2": term("k2"), "k3": term("k3")}
    # Metashape's first tangential term is OpenCV's second; PhotoScan's up to 1.2 is OpenCV's first, as tie points of
    # its projects show.
    p1, p2 = ("p1", "p2") if photoscan else ("p2", "p1")
    terms |= {"k4": term("k4")} if fisheye else {"p1": term(p1), "p2": term(p2)}
    return _Sensor(
        width,
        height,
        (term("fx", focal + term("b1")), term("fy", focal)),
        offset if from_corner else (width / 2 + offset[0], height / 2 + offset[1]),
        Lens({key: value for key, value in terms.items() if value}, fisheye),
        from_corner,
    )


def _unusable(
    camera: xml.Element, by_id: dict[str | None, xml.Element], sensors: dict[str | None, _Sensor]
) -> str | None:
    """Why a camera is left out, if it is."""
    if camera.get("enabled") in _OFF:
        return "is disabled"
    if not (camera.findtext("transform") or "").strip():
        master = by_id.get(camera.get("master_id"))
        if master is None or master is camera:
            return "was not aligned"
        if not (master.findtext("transform") or "").strip():
            return "the master of its rig was not aligned"
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
        raise CaptureError(f"{path}: {what} is not a list of {count} numbers; export the cameras again")
    return np.array(values)

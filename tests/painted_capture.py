"""Photographs of an ellipsoid, painted by formula in milliseconds: every pixel's colour is known where it lies.

Stands in for a stranger's capture where the light on a face is beside the point.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import tifffile
from foreign_captures import OPENCV_AXES
from PIL import Image
from scipy.spatial.transform import Rotation

RADII = np.array([0.08, 0.11, 0.09])
"""Half the head's extent (m): to the ears, the crown, the nose."""

WIDTH, HEIGHT, FOCAL = 40, 56, 90.0

Paint = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]
"""Radiance (N, 3) of points (N, 3) with unit normals (N, 3) for a camera to world matrix (4, 4)."""


@dataclass(frozen=True)
class View:
    """A picture [H, W, 3] from 0 to 1, its mask [H, W] and the matrix camera to world (4, 4, OpenGL axes)."""

    name: str
    radiance: np.ndarray
    mask: np.ndarray
    matrix: np.ndarray
    paint: Paint

    def rolled(self, quarters: int) -> View:
        """The view of the camera turned by quarters of a turn about its axis, to the left as seen from behind it."""
        x, y = [(1, 0), (0, 1), (-1, 0), (0, -1)][quarters % 4]
        roll = np.eye(4)
        roll[:2, :2] = [[x, -y], [y, x]]
        height, width = self.mask.shape[:: -1 if quarters % 2 else 1]
        return _cast(self.name, self.matrix @ roll, width, height, self.paint)

    def moved(self, similarity: np.ndarray) -> View:
        """The view in a world that a rotation and translation (4, 4) moved."""
        return replace(self, matrix=similarity @ self.matrix)

    def frame(self) -> dict[str, Any]:
        """Size, intrinsics and matrix as ``transforms.json`` has them."""
        height, width = self.mask.shape
        size = {"w": width, "h": height, "cx": width / 2, "cy": height / 2, "fl_x": FOCAL, "fl_y": FOCAL}
        return size | {"transform_matrix": self.matrix.tolist()}


def by_position(points: np.ndarray, normals: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """A colour that tells every place of the head."""
    return 0.1 + 0.7 * (points / RADII + 1) / 2


def views(azimuths: Sequence[float], paint: Paint = by_position, elevation: float = 10.0) -> list[View]:
    """Upright views from ``azimuths`` (degrees, 0 in front of the face, at +Z)."""
    return [_view(f"{number:03}", azimuth, elevation, paint) for number, azimuth in enumerate(azimuths)]


def _view(name: str, azimuth: float, elevation: float, paint: Paint) -> View:
    a, e = np.deg2rad([azimuth, elevation])
    back = np.array([np.sin(a) * np.cos(e), np.sin(e), np.cos(a) * np.cos(e)])
    right = np.array([np.cos(a), 0.0, -np.sin(a)])
    matrix = np.eye(4)
    matrix[:3, :3] = np.stack([right, np.cross(back, right), back], 1)
    matrix[:3, 3] = 0.5 * back
    return _cast(name, matrix, WIDTH, HEIGHT, paint)


def _cast(name: str, matrix: np.ndarray, width: int, height: int, paint: Paint) -> View:
    columns, rows = np.meshgrid(np.arange(width) + 0.5 - width / 2, np.arange(height) + 0.5 - height / 2)
    rays = np.stack([columns / FOCAL, -rows / FOCAL, -np.ones_like(rows)], -1) @ matrix[:3, :3].T
    # The nearer root of |(origin + t ray) / radii| = 1.
    o, d = matrix[:3, 3] / RADII, rays / RADII
    squared, half, rest = (d * d).sum(-1), d @ o, o @ o - 1
    root = half * half - squared * rest
    mask = root > 0
    points = matrix[:3, 3] + ((-half - np.sqrt(root.clip(0))) / squared)[..., None] * rays
    normals = points / RADII**2
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    radiance = np.zeros((height, width, 3))
    radiance[mask] = paint(points[mask], normals[mask], matrix)
    return View(name, radiance, mask, matrix, paint)


def write_mesh(path: Path, similarity: np.ndarray) -> None:
    """The ellipsoid as an OBJ file, 48 x 24 quads with texture coordinates, moved by a matrix (4, 4)."""
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 49), np.linspace(0, np.pi, 25))
    points = RADII * np.stack([np.sin(v) * np.sin(u), np.cos(v), np.sin(v) * np.cos(u)], -1)
    points = points.reshape(-1, 3) @ similarity[:3, :3].T + similarity[:3, 3]
    lines = [f"v {x:.9f} {y:.9f} {z:.9f}" for x, y, z in points]
    lines += [f"vt {x:.6f} {y:.6f}" for x, y in np.stack([u / (2 * np.pi), 1 - v / np.pi], -1).reshape(-1, 2)]
    for row in range(24):
        for column in range(48):
            corner = row * 49 + column + 1
            quad = (corner, corner + 49, corner + 50, corner + 1)
            lines.append("f " + " ".join(f"{c}/{c}" for c in quad))
    path.write_text("\n".join(lines) + "\n")


def write(
    folder: Path, taken: Sequence[View], world: np.ndarray | None = None, *, colmap: bool = False, **files: Any
) -> Path:
    """A folder with ``transforms.json``, or with COLMAP's text files, and with pictures, masks and mesh.

    ``world`` is the matrix (4, 4) that the views were moved by, and the mesh is. ``files`` are those of `save`.
    """
    (folder / "images").mkdir(parents=True)
    (folder / "masks").mkdir()
    frames, cameras, images = [], [], []
    for number, view in enumerate(taken, 1):
        path = save(folder / "images" / view.name, view.radiance, number - 1, **files)
        Image.fromarray(np.where(view.mask, 255, 0).astype(np.uint8)).save(folder / "masks" / f"{view.name}.png")
        frame = view.frame()
        frames.append(frame | {"file_path": f"images/{path.name}", "mask_path": f"masks/{view.name}.png"})
        cameras.append(
            f"{number} PINHOLE " + " ".join(str(frame[key]) for key in ("w", "h", "fl_x", "fl_y", "cx", "cy"))
        )
        pose = np.linalg.inv(view.matrix @ OPENCV_AXES)
        turn = Rotation.from_matrix(pose[:3, :3]).as_quat()
        numbers = [*turn[[3, 0, 1, 2]], *pose[:3, 3]]
        images.append(" ".join([str(number), *(repr(float(n)) for n in numbers), str(number), path.name]) + "\n")
    if colmap:
        (folder / "sparse" / "0").mkdir(parents=True)
        (folder / "sparse" / "0" / "cameras.txt").write_text("\n".join(cameras) + "\n")
        (folder / "sparse" / "0" / "images.txt").write_text("\n".join(images) + "\n")
    else:
        (folder / "transforms.json").write_text(json.dumps({"frames": frames}))
    write_mesh(folder / "head.obj", np.eye(4) if world is None else world)
    return folder


def save(
    stem: Path, radiance: np.ndarray, number: int = 0, ending: str = "png", orientations: Sequence[int] = ()
) -> Path:
    """Writes a picture, linear 16 bits as ``tif``, else 8-bit sRGB, with the EXIF orientation of its number."""
    path = stem.with_name(f"{stem.name}.{ending}")
    orientation = orientations[number % len(orientations)] if orientations else 1
    if ending == "tif":
        values = np.round(65535 * radiance).astype(np.uint16)
        tifffile.imwrite(path, values, photometric="rgb", extratags=[(274, "H", 1, orientation, True)])
    else:
        exif = Image.Exif()
        exif[274] = orientation
        Image.fromarray(srgb_codes(radiance)).save(path, exif=exif, quality=100, subsampling=0, lossless=True)
    return path


def srgb_codes(linear: np.ndarray) -> np.ndarray:
    """8-bit sRGB codes of linear values from 0 to 1."""
    curve = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear.clip(1e-9) ** (1 / 2.4) - 0.055)
    return np.round(255 * curve.clip(0, 1)).astype(np.uint8)

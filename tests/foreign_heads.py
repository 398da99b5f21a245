"""Tiny captures of a head as other programs write them: an egg with a nose, six photographs of one grey each.

The grey says which camera a photograph belongs to, so that a capture shows whether each has its own. Nothing is rendered.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image
from scipy.spatial.transform import Rotation

from unshade import _native
from unshade.importing.chart_mesh import read_mesh
from unshade.importing.pinhole import Pinhole

OPENCV_AXES = np.diag([1.0, -1.0, -1.0, 1.0])
WIDTH, HEIGHT, FOCAL, CENTRE = 56, 56, 110.0, (30.0, 26.5)
INTRINSICS = {"w": WIDTH, "h": HEIGHT, "fl_x": FOCAL, "fl_y": FOCAL, "cx": CENTRE[0], "cy": CENTRE[1]}
NAMES = tuple(f"{number:03}" for number in range(6))
_GREYS = {name: 40 + 30 * number for number, name in enumerate(NAMES)}


def mesh(folder: Path) -> Path:
    """An OBJ in metres, upright, facing +Z."""
    rows, columns = 9, 16
    lines = []
    for row in range(rows):
        for column in range(columns + 1):
            down, round_ = np.pi * row / (rows - 1), 2 * np.pi * column / columns
            nose = 0.04 if (row, column) == (4, 4) else 0.0
            x, z = 0.07 * np.sin(down) * np.cos(round_), (0.09 + nose) * np.sin(down) * np.sin(round_)
            lines.append(f"v {x + 0.015 * np.cos(down)} {0.12 * np.cos(down)} {z}")
            lines.append(f"vt {column / columns} {row / (rows - 1)}")
    for row in range(rows - 1):
        for column in range(columns):
            a, b = row * (columns + 1) + column + 1, (row + 1) * (columns + 1) + column + 1
            lines += [f"f {i}/{i} {j}/{j} {k}/{k}" for i, j, k in ((a, a + 1, b + 1), (a, b + 1, b))]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "head.obj").write_text("\n".join(lines) + "\n")
    return folder / "head.obj"


def pose(name: str) -> np.ndarray:
    """Camera to world (4, 4), OpenGL axes: on an arc before the face, at several heights."""
    number = NAMES.index(name)
    angle, height = np.radians(-50 + 20 * number), 0.1 * (number % 3) - 0.05
    eye = np.array([0.6 * np.sin(angle), height, 0.6 * np.cos(angle)])
    back = eye / np.linalg.norm(eye)
    right = np.cross([0.0, 1, 0], back)
    right /= np.linalg.norm(right)
    matrix = np.eye(4)
    matrix[:3] = np.stack([right, np.cross(back, right), back, eye], 1)
    return matrix


def photograph(path: Path, name: str, *, alpha: np.ndarray | None = None) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    picture = np.full((HEIGHT, WIDTH, 3), _GREYS[name], np.uint8)
    if alpha is not None:
        picture = np.dstack([picture, alpha])
    Image.fromarray(picture).save(path)
    return path


def silhouette(obj: Path, name: str, centre: tuple[float, float] = CENTRE) -> np.ndarray:
    """The mask (height, width), 0 or 255."""
    head = read_mesh(obj)
    camera = Pinhole(WIDTH, HEIGHT, (FOCAL, FOCAL), centre, pose(name))
    return np.where(camera.silhouette(head.vertices, head.triangles), 255, 0).astype(np.uint8)


def mask(folder: Path, path: str, name: str) -> None:
    (folder / path).parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(silhouette(folder / "head.obj", name)).save(folder / path)


def photographs(folder: Path, paths: dict[str, str] | None = None, *, masks: bool = True) -> Path:
    """Mesh, photographs at ``paths`` by name (``images/000.png``), and masks ``masks/000.png``."""
    mesh(folder)
    for name, path in (paths or {name: f"images/{name}.png" for name in NAMES}).items():
        photograph(folder / path, name)
        if masks:
            mask(folder, f"masks/{name}.png", name)
    return folder


def frame(name: str, file_path: str, **more: Any) -> dict[str, Any]:
    return {"file_path": file_path, "transform_matrix": pose(name).tolist(), **more}


def transforms(folder: Path, frames: list[dict[str, Any]] | None = None, file: str = "", **intrinsics: Any) -> None:
    listed = [frame(n, f"images/{n}.png", mask_path=f"masks/{n}.png") for n in NAMES] if frames is None else frames
    document = {**(INTRINSICS | intrinsics), "frames": listed}
    text = json.dumps({key: value for key, value in document.items() if value is not None})
    (folder / (file or "transforms.json")).write_text(text)


def colmap(folder: Path, images: Sequence[tuple[str, str]]) -> None:
    """A model as text; ``images`` are the names of cameras and of their pictures."""
    folder.mkdir(parents=True)
    (folder / "cameras.txt").write_text(f"1 PINHOLE {WIDTH} {HEIGHT} {FOCAL} {FOCAL} {CENTRE[0]} {CENTRE[1]}\n")
    lines = []
    for number, (name, picture) in enumerate(images, 1):
        world = np.linalg.inv(pose(name) @ OPENCV_AXES)
        x, y, z, w = Rotation.from_matrix(world[:3, :3]).as_quat()
        lines.append(f"{number} {numbers([w, x, y, z, *world[:3, 3]])} 1 {picture}\n")
    (folder / "images.txt").write_text("\n".join(lines) + "\n")


def numbers(values: Any) -> str:
    return " ".join(repr(float(value)) for value in np.ravel(values))


OFFSETS = f"<f>{FOCAL}</f><cx>{CENTRE[0] - WIDTH / 2}</cx><cy>{CENTRE[1] - HEIGHT / 2}</cy>"
PHOTOSCAN = f"<fx>{FOCAL}</fx><fy>{FOCAL}</fy><cx>{CENTRE[0]}</cx><cy>{CENTRE[1]}</cy>"


def sensor(calibration: str = OFFSETS, number: int = 0, attributes: str = "", placed: str = "") -> str:
    size = f'<resolution width="{WIDTH}" height="{HEIGHT}"/>'
    return (
        f'<sensor id="{number}" label="sensor {number}" type="frame" {attributes}>{size}'
        f'<calibration type="frame" class="adjusted">{size}{calibration}</calibration>{placed}</sensor>'
    )


def camera(number: int, name: str | None, label: str, attributes: str = "", sensor_id: int = 0) -> str:
    """A camera with the pose of ``name``, or without one."""
    placed = "" if name is None else f"<transform>{numbers(pose(name) @ OPENCV_AXES)}</transform>"
    return f'<camera id="{number}" sensor_id="{sensor_id}" label="{label}" {attributes}>{placed}</camera>'


def chunk(cameras: str, sensors: str = "", label: str = "Chunk 1", more: str = "") -> str:
    sensors = sensors or sensor()
    return (
        f'<chunk label="{label}" enabled="true"><sensors>{sensors}</sensors><cameras>{cameras}</cameras>{more}</chunk>'
    )


def metashape(folder: Path, *chunks: str, bare: bool = False) -> Path:
    text = "".join(chunks)
    (folder / "cameras.xml").write_text(text if bare else f'<document version="2.0.0">{text}</document>')
    return folder / "cameras.xml"


def emily(folder: Path) -> None:
    """The folder of Digital Emily 2; centimetres, no masks."""
    mesh(folder / "Emily_2_1_OBJ")
    head = (folder / "Emily_2_1_OBJ" / "head.obj").read_text()
    (folder / "Emily_2_1_OBJ" / "head.obj").write_text("o Emily_head\n" + head)
    (folder / "DigitalEmily2_Calibration").mkdir()
    (folder / "DigitalEmily2_FlashParallel").mkdir()
    for number, name in enumerate(NAMES):
        text = f"#focal length\n{FOCAL} {FOCAL}\n#resolution\n{WIDTH} {HEIGHT}\n#principal point\n{numbers(CENTRE)}\n"
        text += f"#distortion coeffs\n0 0 0 0\nMATRIX :\n{numbers(pose(name))}\n"
        (folder / "DigitalEmily2_Calibration" / f"camera{number}.txt").write_text(text)
        grey = np.full((HEIGHT, WIDTH, 3), _linear(_GREYS[name]), np.float32)
        _native.write_colour(folder / "DigitalEmily2_FlashParallel" / f"cam{number}_flash.exr", grey)


def _linear(code: int) -> float:
    return ((code / 255 + 0.055) / 1.055) ** 2.4


def wrong_views(capture: Path, centre: tuple[float, float] = CENTRE) -> list[str]:
    """The views whose photograph belongs to another camera, or whose camera is not as it was made."""
    wrong = []
    for view in json.loads((capture / "transforms.json").read_text())["frames"]:
        grey = float(_native.read_colour(capture / view["file_path"])[HEIGHT // 2, WIDTH // 2, 0])
        name = min(NAMES, key=lambda n: abs(_linear(_GREYS[n]) - grey))
        intrinsics = np.array([view[key] for key in ("fl_x", "fl_y", "cx", "cy")])
        if not np.allclose(view["transform_matrix"], pose(name), atol=1e-5) or not np.allclose(
            intrinsics, [FOCAL, FOCAL, *centre], atol=1e-3
        ):
            wrong.append(view["name"])
    return wrong

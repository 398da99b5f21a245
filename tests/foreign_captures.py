"""A capture of ours as other programs would have written it: what `unshade import` is to read back.

COLMAP's files are written by COLMAP itself (pycolmap). Pictures and masks are copied.
"""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import colmap_child
import numpy as np

OPENCV_AXES = np.diag([1.0, -1.0, -1.0, 1.0])


def frames_of(capture: Path) -> list[dict[str, Any]]:
    """The frames of ``transforms.json``."""
    return json.loads((capture / "transforms.json").read_text())["frames"]


def copy_pictures(capture: Path, folder: Path) -> None:
    """Pictures in ``images``, masks in ``masks``, the mesh beside them."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("images", "masks", "labels"):
        shutil.copytree(capture / name, folder / name, dirs_exist_ok=True)
    shutil.copyfile(capture / "mesh.obj", folder / "mesh.obj")


def nerfstudio(capture: Path, folder: Path) -> Path:
    """As ns-process-data writes it: intrinsics beside the frames, whole numbers as floats, the world turned and
    scaled, endings and separators as they come."""
    copy_pictures(capture, folder)
    frames = frames_of(capture)
    applied = np.array([[0.0, 0, 1, 0.1], [1, 0, 0, -0.2], [0, 1, 0, 0.3], [0, 0, 0, 1]])
    scale = 2.5
    listed = []
    for number, frame in enumerate(frames):
        matrix = applied @ frame["transform_matrix"]
        matrix[:3, 3] *= scale
        path = f"images\\{frame['name']}" if number % 2 else f"./images/{frame['name']}.exr"
        listed.append(
            {"file_path": path, "mask_path": f"masks\\{frame['name']}.png", "transform_matrix": matrix.tolist()}
        )
    first = frames[0]
    shared = {key: float(first[key]) for key in ("w", "h", "fl_x", "fl_y", "cx", "cy")}
    document = {"camera_model": "OPENCV", **shared, "k1": 0.0, "k2": 0.0, "p1": 0.0, "p2": 0.0, "frames": listed,
                "applied_transform": applied[:3].tolist(), "applied_scale": scale}  # fmt: skip
    (folder / "transforms.json").write_text(json.dumps(document))
    return folder / "transforms.json"


def instant_ngp(capture: Path, folder: Path) -> Path:
    """As instant-ngp's scripts write it: angles for focal lengths, no ending, no split."""
    copy_pictures(capture, folder)
    frames = frames_of(capture)
    first = frames[0]
    angles = [2 * np.arctan(first[side] / 2 / first[focal]) for side, focal in (("w", "fl_x"), ("h", "fl_y"))]
    listed = [
        {"file_path": f"images/{f['name']}", "sharpness": 30.0, "transform_matrix": f["transform_matrix"]}
        for f in frames
    ]
    document = {"camera_angle_x": angles[0], "camera_angle_y": angles[1], "w": float(first["w"]), "h": float(first["h"]),
                "aabb_scale": 4, "frames": listed}  # fmt: skip
    (folder / "transforms.json").write_text(json.dumps(document))
    return folder


def colmap(capture: Path, folder: Path, *, binary: bool, rig: bool = False) -> Path:
    """A COLMAP project with ``sparse/0``; with ``rig`` all views are sensors of one rig, in one frame."""
    copy_pictures(capture, folder)
    views = [
        {
            "name": f"{frame['name']}.exr",
            "model": "PINHOLE",
            "width": frame["w"],
            "height": frame["h"],
            "parameters": [frame[key] for key in ("fl_x", "fl_y", "cx", "cy")],
            "world_to_camera": np.linalg.inv(np.array(frame["transform_matrix"]) @ OPENCV_AXES)[:3].tolist(),
        }
        for frame in frames_of(capture)
    ]
    colmap_child.ask(do="write", folder=str(folder / "sparse" / "0"), views=views, binary=binary, rig=rig)
    return folder


CHUNK = (3.0, np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]]), np.array([0.4, -0.1, 0.2]))
"""Scale, rotation, translation from the chunk's coordinates to the mesh's."""


def metashape(capture: Path, folder: Path) -> Path:
    """Agisoft's XML: two sensors, one of them never calibrated, a disabled and an unaligned camera, no cx and cy
    where they are 0, a chunk that is turned and scaled."""
    copy_pictures(capture, folder)
    scale, rotation, translation = CHUNK
    frames = frames_of(capture)
    first = frames[0]
    offsets = [first["cx"] - first["w"] / 2, first["cy"] - first["h"] / 2]
    shift = "".join(f"<{key}>{value!r}</{key}>" for key, value in zip(("cx", "cy"), offsets) if value)
    cameras = []
    for number, frame in enumerate(frames):
        world = np.array(frame["transform_matrix"]) @ OPENCV_AXES
        local = np.eye(4)
        local[:3, :3] = rotation.T @ world[:3, :3]
        local[:3, 3] = rotation.T @ (world[:3, 3] - translation) / scale
        words = " ".join(repr(float(v)) for v in local.ravel())
        cameras.append(
            f'<camera id="{number}" sensor_id="0" label="{frame["name"]}"><transform>{words}</transform></camera>'
        )
    placed = "<transform>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</transform>"
    cameras.append(f'<camera id="97" sensor_id="0" label="off" enabled="false">{placed}</camera>')
    cameras.append('<camera id="98" sensor_id="0" label="lost"></camera>')
    cameras.append(f'<camera id="99" sensor_id="1" label="dummy">{placed}</camera>')
    numbers = lambda a: " ".join(repr(float(v)) for v in np.ravel(a))
    size = f'<resolution width="{first["w"]}" height="{first["h"]}"/>'
    text = f"""<?xml version="1.0" encoding="UTF-8"?>
<document version="2.0.0"><chunk label="Chunk 1" enabled="true"><sensors next_id="2">
<sensor id="0" label="lens" type="frame">{size}
<calibration type="frame" class="adjusted">{size}<f>{first["fl_y"]!r}</f>{shift}</calibration></sensor>
<sensor id="1" label="unknown" type="frame"><resolution width="10" height="10"/></sensor></sensors>
<cameras>{"".join(cameras)}</cameras>
<transform><rotation>{numbers(rotation)}</rotation><translation>{numbers(translation)}</translation><scale>{scale}</scale></transform>
</chunk></document>"""
    (folder / "cameras.xml").write_text(text)
    return folder / "cameras.xml"


def emily(capture: Path, folder: Path) -> Path:
    """The folder of Digital Emily 2: centimetres, negative relative indices, cameras as text."""
    frames = frames_of(capture)
    for name in ("DigitalEmily2_Calibration", "DigitalEmily2_FlashParallel", "Emily_2_1_OBJ"):
        (folder / name).mkdir(parents=True)
    for number, frame in enumerate(frames):
        matrix = np.array(frame["transform_matrix"])
        matrix[:3, 3] *= 100
        rows = "\n".join(" ".join(repr(float(v)) for v in row) for row in matrix)
        text = (
            f"#focal length\n{frame['fl_x']!r} {frame['fl_y']!r}\n#resolution\n{frame['w']} {frame['h']}\n"
            f"#principal point\n{frame['cx']!r} {frame['cy']!r}\n#distortion coeffs\n0 0 0 0\nMATRIX :\n{rows}\n"
        )
        (folder / "DigitalEmily2_Calibration" / f"camera{number:02}.txt").write_text(text)
        shutil.copyfile(
            capture / "images" / f"{frame['name']}.exr",
            folder / "DigitalEmily2_FlashParallel" / f"cam{number}_flash.exr",
        )
    (folder / "Emily_2_1_OBJ" / "Emily.obj").write_text(_emily_mesh(capture / "mesh.obj"))
    return folder


def _emily_mesh(path: Path) -> str:
    lines = path.read_text().splitlines()
    values = {key: [line.split()[1:] for line in lines if line.startswith(f"{key} ")] for key in ("v", "vt", "vn", "f")}
    text = ["o Emily_head"]
    for key in ("v", "vt", "vn"):
        factor = 100 if key == "v" else 1
        text += [f"{key} " + " ".join(repr(float(value) * factor) for value in row) for row in values[key]]
    count = len(values["v"])
    for face in values["f"]:
        text.append(
            "f " + " ".join("/".join(str(int(index) - count - 1) for index in corner.split("/")) for corner in face)
        )
    # Eyes without texture coordinates, as the data set has them beside the head.
    text += ["o Eyes", "v 0 0 0", "v 1 0 0", "v 0 1 0", "f -3 -2 -1"]
    return "\n".join(text) + "\n"

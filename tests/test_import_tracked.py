"""`unshade import tracked`: meshes of a video's frames, against a head that turned in a known way."""

from __future__ import annotations

import json
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import painted_capture
import pytest
from scipy.spatial.transform import Rotation

import unshade
from unshade.errors import CaptureError
from unshade.importing.chart_mesh import read_mesh

AZIMUTHS = (-50, -30, -15, 0, 15, 30, 50)


def lamp_of_the_room(points: np.ndarray, normals: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    towards = matrix[:3, :3] @ [0.77, 0.34, 0.54]
    return (0.3 * (0.15 + (normals @ towards).clip(0)))[:, None] * [1.0, 0.8, 0.7]


def tracked(folder: Path, mouth_mm: tuple[float, ...] = (0.0,) * len(AZIMUTHS)) -> list[np.ndarray]:
    """An export of a head that turns before a still camera: files as VHAP writes them, without UV. The chin of each
    frame's mesh is ``mouth_mm`` lower. Returns the true cameras in the head's frame."""
    taken = painted_capture.views(AZIMUTHS, lamp_of_the_room)
    painted_capture.write(folder, taken)
    lines = (folder / "head.obj").read_text().splitlines()
    points = np.array([line.split()[1:] for line in lines if line[:2] == "v "], float)
    quads = [[int(corner.split("/")[0]) for corner in line.split()[1:]] for line in lines if line[:2] == "f "]
    # One vertex in each place, as a tracker's mesh has them.
    places, place = np.unique(points.round(7), axis=0, return_inverse=True)
    triangles = [
        [place.ravel()[quad[k] - 1] + 1 for k in corners] for quad in quads for corners in ((0, 1, 2), (0, 2, 3))
    ]
    triangles = [t for t in triangles if len(set(t)) == 3]
    (folder / "meshes").mkdir()
    still = np.eye(4)
    still[2, 3] = 1.0
    frames = json.loads((folder / "transforms.json").read_text())["frames"]
    for number, (frame, view) in enumerate(zip(frames, taken)):
        shape = places.copy()
        chin = shape[:, 1] < -0.06
        shape[chin, 1] -= mouth_mm[number] / 1000
        pose = still @ np.linalg.inv(view.matrix)
        moved = shape @ pose[:3, :3].T + pose[:3, 3]
        text = [f"v {x} {y} {z}" for x, y, z in moved.tolist()] + [f"f {a} {b} {c}" for a, b, c in triangles]
        (folder / "meshes" / f"{number:05}.obj").write_text("\n".join(text) + "\n")
        frame |= {
            "transform_matrix": still.tolist(),
            "mesh_path": f"meshes/{number:05}.obj",
            "flame_param_path": f"flame_param/{number:05}.npz",
            "fg_mask_path": frame.pop("mask_path"),
            "timestep_index": number,
            "camera_index": 0,
        }
    (folder / "transforms.json").write_text(json.dumps({"frames": frames}))
    return [view.matrix for view in taken]


def imported(folder: Path, out: Path, **options: Any) -> tuple[dict[str, Any], dict[str, Any], list[str]]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        unshade.import_capture("tracked", folder, out, **options)
    read = lambda name: json.loads((out / name).read_text())
    return read("transforms.json"), read("import.json"), [str(warning.message) for warning in caught]


def relative(matrices: list[np.ndarray]) -> np.ndarray:
    """Poses from the first camera's frame: a place of the head does not change them."""
    return np.stack([np.linalg.inv(matrices[0]) @ matrix for matrix in matrices])


def test_the_cameras_move_about_the_still_head(tmp_path: Path) -> None:
    true = tracked(tmp_path / "video")
    document, record, said = imported(tmp_path / "video", tmp_path / "capture")
    assert document["light_frame"] == "camera" and not any("the light" in line for line in said)
    found = [np.array(frame["transform_matrix"]) for frame in document["frames"]]
    np.testing.assert_allclose(relative(found), relative(true), atol=1e-6)
    assert record["light"]["moves"] and record["masks"] == "silhouette"
    mesh = read_mesh(tmp_path / "capture" / "mesh.obj")
    # The neutral mesh is the ellipsoid, moved rigidly.
    size = np.linalg.norm(mesh.vertices - mesh.vertices.mean(0), axis=1)
    assert size.min() == pytest.approx(0.08, abs=2e-3) and size.max() == pytest.approx(0.11, abs=2e-3)


def test_frames_with_an_expression_are_left_out(tmp_path: Path) -> None:
    true = tracked(tmp_path / "video", (0.3, 0, 0, 9, 0, 0.2, 0))
    document, record, said = imported(tmp_path / "video", tmp_path / "capture")
    assert [left["name"] for left in record["left_out"]] == ["003"]
    assert any("left out 1 of 7 views, 003: expression: further than 3 mm" in line for line in said)
    found = [np.array(frame["transform_matrix"]) for frame in document["frames"]]
    error = np.linalg.inv(relative(found)) @ relative(true[:3] + true[4:])
    # The chin weighs little: it would turn the head by a degree.
    assert np.degrees(Rotation.from_matrix(error[:, :3, :3]).magnitude()).max() < 0.1
    tracked(tmp_path / "talk", (0, 9, 18, 27, 36, 45, 54))
    with pytest.raises(CaptureError, match=r"the expression changes: the meshes are .* mm from their mean"):
        imported(tmp_path / "talk", tmp_path / "x")


def test_a_template_gives_its_uv(tmp_path: Path) -> None:
    tracked(tmp_path / "video")
    lines = (tmp_path / "video" / "meshes" / "00002.obj").read_text().splitlines()
    count = sum(line[0] == "v" for line in lines)
    # Another pose of the mesh, with a UV for every corner of every triangle.
    template = [line for line in lines if line[0] == "v"]
    faces = [line.split()[1:] for line in lines if line[0] == "f"]
    side = int(np.ceil(np.sqrt(len(faces))))
    for number, face in enumerate(faces):
        x, y = number % side, number // side
        template += [f"vt {(x + a) / side} {(y + b) / side}" for a, b in ((0.1, 0.1), (0.9, 0.1), (0.1, 0.9))]
        template.append("f " + " ".join(f"{v}/{3 * number + k + 1}" for k, v in enumerate(face)))
    (tmp_path / "template.obj").write_text("\n".join(template) + "\n")
    plain, _, _ = imported(tmp_path / "video", tmp_path / "plain")
    kept, record, _ = imported(tmp_path / "video", tmp_path / "kept", mesh=tmp_path / "template.obj", uv="keep")
    assert not record["uv"]["new"] and kept["frames"][0]["w"] == plain["frames"][0]["w"]
    shapes = [read_mesh(tmp_path / name / "mesh.obj") for name in ("plain", "kept")]
    triangles = [np.sort(shape.vertices[shape.triangles], axis=1) for shape in shapes]
    np.testing.assert_allclose(*triangles, atol=1e-6)
    (tmp_path / "other.obj").write_text(
        "\n".join(line for line in template if not line.startswith(f"v {count}")) + "\nv 0 0 0\n"
    )
    with pytest.raises(CaptureError, match="vertices, but the tracked meshes"):
        imported(tmp_path / "video", tmp_path / "x", mesh=tmp_path / "other.obj")


def test_faulty_exports_are_named(tmp_path: Path) -> None:
    tracked(tmp_path / "video")
    file = tmp_path / "video" / "transforms.json"
    document = json.loads(file.read_text())

    def refused(words: str, change: Any) -> None:
        frames = [dict(frame) for frame in document["frames"]]
        for number, frame in enumerate(frames):
            change(number, frame)
        file.write_text(json.dumps({"frames": frames}))
        with pytest.raises(CaptureError, match=words) as refusal:
            imported(tmp_path / "video", tmp_path / "x")
        assert "\n" not in str(refusal.value)

    refused("only FLAME's parameters .* --flame-mode mesh", lambda _, frame: frame.pop("mesh_path"))
    refused("has no mesh_path; export the meshes of all", lambda n, frame: n or frame.pop("mesh_path"))
    refused("cannot be read as an OBJ", lambda n, frame: n or frame.update(mesh_path="meshes/none.obj"))

    def walk(number: int, frame: dict[str, Any]) -> None:
        frame["transform_matrix"] = np.array(frame["transform_matrix"]).tolist()
        frame["transform_matrix"][0][3] = 0.1 * number

    refused("head and cameras both move", walk)

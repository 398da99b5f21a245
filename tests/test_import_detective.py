"""Each mistake that is often made, planted: the detective finds it, names it, and fixes it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import foreign_captures
import foreign_heads as heads
import numpy as np
import pytest
from foreign_captures import OPENCV_AXES
from PIL import Image
from scipy.spatial import cKDTree

import unshade
from unshade.errors import CaptureError

Document = dict[str, Any]


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A capture as files of a stranger: transforms.json, pictures, masks, mesh."""
    folder = tmp_path_factory.mktemp("source")
    heads.mesh(folder).rename(folder / "mesh.obj")
    for name in ("images", "masks", "labels"):
        (folder / name).mkdir()
    random = np.random.default_rng(0)
    for name in heads.NAMES:
        picture = random.random((heads.HEIGHT, heads.WIDTH, 3), np.float32)
        unshade._native.write_colour(folder / "images" / f"{name}.exr", picture)
        Image.fromarray(heads.silhouette(folder / "mesh.obj", name)).save(folder / "masks" / f"{name}.png")
    frames = [
        {"name": name, **heads.frame(name, f"images/{name}.exr", mask_path=f"masks/{name}.png"), **heads.INTRINSICS}
        for name in heads.NAMES
    ]
    (folder / "transforms.json").write_text(json.dumps({"mesh": "mesh.obj", "frames": frames}))
    return folder


def _planted(source: Path, folder: Path, change: Callable[[Document], None]) -> Path:
    foreign_captures.copy_pictures(source, folder)
    document = json.loads((source / "transforms.json").read_text())
    change(document)
    (folder / "transforms.json").write_text(json.dumps(document))
    return folder


def _matrices(change: Callable[[np.ndarray], np.ndarray]) -> Callable[[Document], None]:
    def plant(document: Document) -> None:
        for frame in document["frames"]:
            frame["transform_matrix"] = change(np.array(frame["transform_matrix"])).tolist()

    return plant


def _numbers(**change: Callable[[Document], float]) -> Callable[[Document], None]:
    def plant(document: Document) -> None:
        for frame in document["frames"]:
            frame.update({key: value(frame) for key, value in change.items()})

    return plant


def _positions(factor: float) -> Callable[[Document], None]:
    def scaled(matrix: np.ndarray) -> np.ndarray:
        matrix[:3, 3] *= factor
        return matrix

    return _matrices(scaled)


def _applied(document: Document) -> None:
    """The cameras were turned and the file says so, but the mesh was turned with them."""
    turn = np.array([[1.0, 0, 0, 0.1], [0, 0, -1, 0.05], [0, 1, 0, -0.1], [0, 0, 0, 1]])
    document["applied_transform"] = turn[:3].tolist()


Z_UP = np.array([[1.0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])

PLANTED: dict[str, Callable[[Document], None]] = {
    "opencv-axes": _matrices(lambda m: m @ OPENCV_AXES),
    "pytorch3d-axes": _matrices(lambda m: m @ np.diag([-1.0, 1, -1, 1])),
    "inverse": _matrices(np.linalg.inv),
    "inverse-opencv-axes": _matrices(lambda m: np.linalg.inv(m @ OPENCV_AXES)),
    "inverse-of-world-to-camera": _matrices(lambda m: OPENCV_AXES @ np.linalg.inv(m) @ OPENCV_AXES),
    "mesh-axes-(x, z, -y)": _matrices(lambda m: np.linalg.inv(Z_UP) @ m),
    "mesh-axes-(x, -z, y)": _matrices(lambda m: Z_UP @ m),
    "applied-transform": _applied,
    "principal-point-from-middle": _numbers(cx=lambda f: f["cx"] - f["w"] / 2, cy=lambda f: f["cy"] - f["h"] / 2),
    "focal-mm-36": _numbers(fl_x=lambda f: f["fl_x"] * 36 / f["w"], fl_y=lambda f: f["fl_y"] * 36 / f["w"]),
    "focal-share": _numbers(fl_x=lambda f: f["fl_x"] / f["w"], fl_y=lambda f: f["fl_y"] / f["w"]),
    "focal-double": _numbers(fl_x=lambda f: f["fl_x"] / 2, fl_y=lambda f: f["fl_y"] / 2),
    "cameras-mm": _positions(1000.0),
    "mesh-cm": _positions(0.01),
    "half-pixel": _numbers(cx=lambda f: f["cx"] - 0.5, cy=lambda f: f["cy"] - 0.5),
    "half-pixel-back": _numbers(cx=lambda f: f["cx"] + 0.5, cy=lambda f: f["cy"] + 0.5),
}


def _refused(folder: Path, out: Path) -> str:
    with pytest.raises(CaptureError) as refusal:
        unshade.import_capture("transforms", folder, out)
    message = str(refusal.value)
    assert "\n" not in message and not out.exists()
    return message


def _projections(capture: Path) -> dict[str, np.ndarray]:
    """Where each view shows the vertices of its own mesh (N, 2), whatever their order and units."""
    lines = (capture / "mesh.obj").read_text().splitlines()
    mesh = np.array([line.split()[1:4] for line in lines if line.startswith("v ")], float)
    shown = {}
    for frame in foreign_captures.frames_of(capture):
        local = np.linalg.inv(frame["transform_matrix"]) @ np.c_[mesh, np.ones(len(mesh))].T
        x, y = local[0] / -local[2], local[1] / local[2]
        shown[frame["name"]] = np.stack([frame["cx"] + frame["fl_x"] * x, frame["cy"] + frame["fl_y"] * y], 1)
    return shown


@pytest.mark.parametrize("mistake", PLANTED)
def test_a_planted_mistake_is_named_and_fixed(mistake: str, source: Path, tmp_path: Path) -> None:
    folder = _planted(source, tmp_path / "planted", PLANTED[mistake])
    fixed = unshade.import_capture("transforms", folder, tmp_path / "capture", apply=True)
    said = json.loads((fixed / "import.json").read_text())
    assert said["fit"]["change"] == mistake
    assert any(f"[{mistake}]" in line for line in said["assumed"])
    after = _projections(fixed)
    for name, pixels in _projections(source).items():
        off, _ = cKDTree(after[name]).query(pixels)
        assert off.max() < 1e-3


@pytest.mark.parametrize(
    ("mistake", "orientation"),
    [
        ("upside-down-rows", np.flipud),
        ("mirrored", np.fliplr),
        ("half-turn", lambda a: a[::-1, ::-1]),
        ("turn-right", np.rot90),
    ],
)
def test_pictures_that_lie_another_way_are_turned(mistake: str, orientation: Any, source: Path, tmp_path: Path) -> None:
    folder = _planted(source, tmp_path / "planted", lambda document: None)
    original = {path.name: unshade.Capture(source).image(path.stem) for path in sorted((source / "images").iterdir())}
    for name, picture in original.items():
        unshade._native.write_colour(folder / "images" / name, np.ascontiguousarray(orientation(picture)))
        mask = folder / "masks" / name.replace(".exr", ".png")
        with Image.open(mask) as image:
            plane = np.asarray(image)
        Image.fromarray(np.ascontiguousarray(orientation(plane))).save(mask)
    fixed = unshade.Capture(unshade.import_capture("transforms", folder, tmp_path / "capture", apply=True))
    for name, picture in original.items():
        np.testing.assert_array_equal(fixed.image(name[:-4]), picture)


def test_without_apply_the_change_is_the_error(source: Path, tmp_path: Path) -> None:
    folder = _planted(source, tmp_path / "planted", PLANTED["opencv-axes"])
    message = _refused(folder, tmp_path / "capture")
    assert "[opencv-axes]" in message and "apply" in message and str(folder / "transforms.json") in message


def test_inverted_masks_are_named(source: Path, tmp_path: Path) -> None:
    folder = _planted(source, tmp_path / "planted", lambda document: None)
    for mask in (folder / "masks").iterdir():
        with Image.open(mask) as image:
            plane = np.asarray(image)
        Image.fromarray(255 - plane).save(mask)
    fixed = unshade.import_capture("transforms", folder, tmp_path / "capture", apply=True)
    name = min((source / "masks").iterdir()).name
    with Image.open(fixed / "masks" / name) as after, Image.open(source / "masks" / name) as before:
        np.testing.assert_array_equal(np.asarray(after), np.asarray(before))


def test_a_factor_without_a_name_is_fitted(source: Path, tmp_path: Path) -> None:
    focal = _numbers(fl_x=lambda f: f["fl_x"] / 1.7, fl_y=lambda f: f["fl_y"] / 1.7)
    message = _refused(_planted(source, tmp_path / "focal", focal), tmp_path / "a")
    assert float(message.split("[focal-times-")[1].split("]")[0]) == pytest.approx(1.7, rel=0.01)
    message = _refused(_planted(source, tmp_path / "world", _positions(37.0)), tmp_path / "b")
    assert float(message.split("[cameras-times-")[1].split("]")[0]) == pytest.approx(1 / 37, rel=0.02)


def test_a_sound_capture_is_left_alone_and_a_hopeless_one_is_refused(source: Path, tmp_path: Path) -> None:
    sound = unshade.import_capture("transforms", source, tmp_path / "sound")
    fit = json.loads((sound / "import.json").read_text())["fit"]
    assert fit["change"] is None and fit["union"] > 0.95
    random = np.random.default_rng(0)

    def scattered(matrix: np.ndarray) -> np.ndarray:
        rotation, _ = np.linalg.qr(random.normal(size=(3, 3)))
        matrix[:3, :3] = rotation * np.sign(np.linalg.det(rotation))
        return matrix

    folder = _planted(source, tmp_path / "hopeless", _matrices(scattered))
    assert "no single change makes them fit" in _refused(folder, tmp_path / "scattered")

"""Lenses: what COLMAP's own code says of a camera is what an imported picture shows."""

from __future__ import annotations

import json
from pathlib import Path

import colmap_child
import numpy as np
import pytest
from PIL import Image

import unshade
from unshade import _native
from unshade.errors import CaptureError

SIZE = (80, 60)

LENSES = {
    "SIMPLE_RADIAL": [70.0, 41.0, 29.0, -0.12],
    "RADIAL": [70.0, 41.0, 29.0, -0.15, 0.03],
    "OPENCV": [72.0, 69.0, 38.5, 31.0, -0.1, 0.02, 0.003, -0.004],
    "OPENCV_FISHEYE": [60.0, 61.0, 40.5, 30.0, 0.02, -0.01, 0.003, -0.001],
    "SIMPLE_RADIAL_FISHEYE": [60.0, 40.5, 30.0, 0.03],
    "FULL_OPENCV": [72.0, 71.0, 40.0, 30.0, -0.1, 0.02, 0.002, -0.003, 0.01, 0.02, 0.01, 0.005],
    "PINHOLE": [70.0, 65.0, 44.0, 27.0],
}


def _capture(folder: Path, model: str, parameters: list[float]) -> Path:
    """Two photographs whose colour at a pixel is the direction that the lens shows there."""
    columns, rows = np.meshgrid(np.arange(SIZE[0]) + 0.5, np.arange(SIZE[1]) + 0.5)
    pixels = np.stack([columns.ravel(), rows.ravel()], 1).tolist()
    directions = colmap_child.ask(do="directions", model=model, parameters=parameters, size=SIZE, pixels=pixels)
    picture = np.zeros((SIZE[1], SIZE[0], 3), np.float32)
    picture[..., :2] = np.reshape(directions, (SIZE[1], SIZE[0], 2)) + 2
    (folder / "images").mkdir(parents=True)
    lens = {"model": model, "width": SIZE[0], "height": SIZE[1], "parameters": parameters}
    pose = np.c_[np.eye(3), [0.0, 0, 1]].tolist()
    for name in ("a.exr", "b.exr"):
        picture[..., 2] += 1  # Photographs are told apart by their bytes.
        _native.write_colour(folder / "images" / name, picture)
    views = [{"name": name, **lens, "world_to_camera": pose} for name in ("a.exr", "b.exr")]
    colmap_child.ask(do="write", folder=str(folder / "sparse"), views=views, binary=True)
    # A wall before the camera, larger than its view.
    (folder / "wall.obj").write_text(
        "v -3 -3 0\nv 3 -3 0\nv 3 3 0\nv -3 3 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n"
    )
    return folder


@pytest.mark.parametrize("model", LENSES)
def test_a_pinhole_sees_what_the_lens_saw_elsewhere(model: str, tmp_path: Path) -> None:
    folder = _capture(tmp_path / "source", model, LENSES[model])
    mesh = folder / "wall.obj"
    capture = unshade.import_capture(
        "colmap", folder, tmp_path / "capture", mesh=mesh, holdout=["b"], unit="m", place="keep"
    )
    frames = json.loads((capture / "transforms.json").read_text())["frames"]
    for frame in frames:
        assert frame["camera_model"] == "PINHOLE"
        picture = _native.read_colour(capture / frame["file_path"])
        x = (np.arange(SIZE[0]) + 0.5 - frame["cx"]) / frame["fl_x"] + 2
        y = (np.arange(SIZE[1]) + 0.5 - frame["cy"]) / frame["fl_y"] + 2
        seen = picture[..., 0] > 0
        assert seen.mean() > 0.8
        # Bilinear between pixels of a smooth ramp, and the last half pixel that goes on beside it.
        error = np.abs(picture[..., :2] - np.stack(np.meshgrid(x, y), -1))[2:-2, 2:-2][seen[2:-2, 2:-2]]
        assert np.median(error) < 2e-4 and error.max() < 0.02, (np.median(error), error.max())


def test_a_lens_that_a_capture_can_say_is_handed_on(tmp_path: Path) -> None:
    """With masks of their own, training pictures keep their pixels; the solver takes the lens out."""
    folder = _capture(tmp_path / "source", "OPENCV", LENSES["OPENCV"])
    masks = folder / "masks"
    masks.mkdir()
    whole = np.full(SIZE[::-1], 255, np.uint8)
    for name in ("a", "b"):
        Image.fromarray(whole).save(masks / f"{name}.png")
    unshade.import_capture(
        "colmap",
        folder,
        tmp_path / "capture",
        mesh=folder / "wall.obj",
        masks=masks,
        holdout=["b"],
        unit="m",
        place="keep",
    )
    frames = {f["name"]: f for f in json.loads((tmp_path / "capture" / "transforms.json").read_text())["frames"]}
    assert frames["a"]["camera_model"] == "OPENCV" and frames["a"]["k1"] == -0.1 and frames["a"]["p2"] == -0.004
    assert frames["b"]["camera_model"] == "PINHOLE" and "k1" not in frames["b"]
    kept, original = (_native.read_colour(path / "images" / "a.exr") for path in (tmp_path / "capture", folder))
    np.testing.assert_array_equal(kept, original)


def test_lenses_that_are_not_read_are_named(tmp_path: Path) -> None:
    folder = _capture(tmp_path / "source", "FOV", [70.0, 70.0, 40.0, 30.0, 0.1])
    with pytest.raises(CaptureError, match="camera model FOV is not read; undistort with `colmap image_undistorter`"):
        unshade.import_capture("colmap", folder, tmp_path / "capture", mesh=folder / "wall.obj")

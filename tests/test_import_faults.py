"""Cameras' files that are wrong, cut, or changed somewhere: one line with the file, or a capture; never another end."""

from __future__ import annotations

import json
from pathlib import Path

import colmap_child
import numpy as np
import pytest

from unshade.errors import CaptureError, UnshadeError
from unshade.importing.programs import read_source

POSE = np.c_[np.eye(3), [0.0, 0.1, 1.0]].tolist()
FRAME = {
    "file_path": "a.png",
    "w": 8,
    "h": 6,
    "fl_x": 9.0,
    "transform_matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 2], [0, 0, 0, 1]],
}
XML = """<document><chunk enabled="true"><sensors><sensor id="0" type="{kind}">
<resolution width="{width}" height="6"/><calibration class="adjusted"><f>9</f>{terms}</calibration></sensor></sensors>
<cameras><camera id="0" sensor_id="0" label="a"><transform>{matrix}</transform></camera></cameras>{more}</chunk></document>"""
EYE = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"


def _xml(kind: str = "frame", width: str = "8", terms: str = "", matrix: str = EYE, more: str = "") -> str:
    return XML.format(kind=kind, width=width, terms=terms, matrix=matrix, more=more)


def _refused(format: str, path: Path, words: str) -> None:
    with pytest.raises(CaptureError, match=words) as refusal:
        read_source(format, path)
    message = str(refusal.value)
    assert "\n" not in message and str(path.parent) in message


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"w": 8.5}, "w is 8.5; it must be a whole number"),
        ({"w": "8"}, "w is '8'; it must be a number"),
        ({"fl_x": None}, "has no fl_x"),
        ({"fl_x": -1}, "focal length is -1"),
        ({"fl_x": None, "camera_angle_x": 4.0}, "is an angle in radians"),
        ({"file_path": None}, "a frame has no file_path"),
        ({"transform_matrix": [[1, 0], [0, 1]]}, "not a matrix of four rows"),
        (
            {"transform_matrix": [[1, 0, 0, 0], [0, 2, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]},
            "not a rotation and translation",
        ),
        (
            {"transform_matrix": [[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]},
            "not a rotation and translation",
        ),
        ({"camera_model": "EQUIRECTANGULAR"}, "camera_model 'EQUIRECTANGULAR' is unknown"),
        ({"camera_model": "PINHOLE", "k1": 0.1}, "camera_model PINHOLE has no k1"),
        ({"w": None, "cx": 4.0}, "cx or cy without w and h"),
    ],
)
def test_frames_that_cannot_be(change: dict, words: str, tmp_path: Path) -> None:
    path = tmp_path / "transforms.json"
    path.write_text(json.dumps({"frames": [FRAME | change]}))
    _refused("transforms", path, words)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[]", "is a JSON list"),
        ("{", "is not JSON"),
        ("{}", "has no list of frames"),
        ('{"frames": []}', "holds no camera with a pose"),
        (json.dumps({"frames": [FRAME], "applied_transform": [[0] * 4] * 3}), "applied_transform cannot be undone"),
        (json.dumps({"frames": [FRAME], "applied_scale": 0}), "applied_scale is 0"),
        (json.dumps({"frames": [FRAME], "test_filenames": ["b.png"]}), "test_filenames names b.png"),
    ],
)
def test_transforms_that_cannot_be(text: str, words: str, tmp_path: Path) -> None:
    path = tmp_path / "transforms.json"
    path.write_text(text)
    _refused("transforms", path, words)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("<document/>", "has no chunk with cameras"),
        ("no xml", "is not XML"),
        ('<!DOCTYPE a [<!ENTITY b "c">]><a>&b;</a>', "is not a camera file of Metashape"),
        (_xml(width="many"), "has no resolution"),
        (_xml(kind="spherical"), "is of type 'spherical'"),
        (_xml(terms="<k4>0.1</k4>"), "has k4, which OpenCV's lens has not"),
        (_xml(terms="<cx>a</cx>"), "cx of a sensor is not a list of 1 numbers"),
        (_xml(matrix="1 2 3"), "transform of a is not a list of 16 numbers"),
        (_xml(matrix=""), "a: was not aligned"),
        (_xml(more="<transform><scale>0</scale></transform>"), "transform has no size"),
    ],
)
def test_metashape_that_cannot_be(text: str, words: str, tmp_path: Path) -> None:
    path = tmp_path / "cameras.xml"
    path.write_text(text)
    _refused("metashape", path, words)


@pytest.mark.parametrize(
    ("file", "text", "words"),
    [
        ("cameras.txt", "1 PINHOLE 8 6 9 9 4\n", "PINHOLE has 4 parameters, not 3"),
        ("cameras.txt", "1 PINHOLE eight 6 9 9 4 3\n", "is not an id, model, width"),
        ("cameras.txt", "1 DIVISION 8 6 9 4 3 0.1\n", "camera model DIVISION is not read"),
        ("cameras.txt", "2 PINHOLE 8 6 9 9 4 3\n", "its camera 1 is not in cameras"),
        ("images.txt", "1 1 0 0 0 0 0 1 one a.png\n\n", "is not an id, quaternion"),
        ("images.txt", "1 0 0 0 0 0 0 1 1 a.png\n\n", "is not finite"),
        ("images.txt", "# none\n", "holds no camera with a pose"),
    ],
)
def test_colmap_that_cannot_be(file: str, text: str, words: str, tmp_path: Path) -> None:
    (tmp_path / "cameras.txt").write_text("1 PINHOLE 8 6 9 9 4 3\n")
    (tmp_path / "images.txt").write_text("1 1 0 0 0 0 0 1 1 a.png\n\n")
    assert len(read_source("colmap", tmp_path).views) == 1
    (tmp_path / file).write_text(text)
    _refused("colmap", tmp_path / file if file == "x" else tmp_path, words)


def test_names_with_spaces_and_one_stem_in_two_folders(tmp_path: Path) -> None:
    (tmp_path / "cameras.txt").write_text("1 PINHOLE 8 6 9 9 4 3\n")
    lines = [f"{n} 1 0 0 0 0 0 1 1 {name}\n1.0 2.0 -1\n" for n, name in enumerate(("left/a b.png", "right/a b.png"), 1)]
    (tmp_path / "images.txt").write_text("# list\n" + "".join(lines))
    assert [view.name for view in read_source("colmap", tmp_path).views] == ["left_a_b", "right_a_b"]


def test_files_changed_anywhere_end_in_one_line_or_a_capture(tmp_path: Path) -> None:
    """Some bytes of each kind of file are cut, doubled or replaced; nothing else may happen."""
    lens = {"model": "OPENCV", "width": 8, "height": 6, "parameters": [9.0, 9, 4, 3, 0.1, 0, 0, 0]}
    views = [{"name": f"{name}.png", **lens, "world_to_camera": POSE} for name in "ab"]
    for binary in (True, False):
        colmap_child.ask(do="write", folder=str(tmp_path / f"{binary}"), views=views, binary=binary)
    (tmp_path / "transforms.json").write_text(json.dumps({"frames": [FRAME], "camera_model": "OPENCV"}))
    (tmp_path / "cameras.xml").write_text(_xml(terms="<k1>0.1</k1>", more="<transform><scale>2</scale></transform>"))
    files = [("colmap", tmp_path / "True", "images.bin"), ("colmap", tmp_path / "True", "cameras.bin")]
    files += [("colmap", tmp_path / "False", "images.txt"), ("colmap", tmp_path / "False", "cameras.txt")]
    files += [("transforms", tmp_path, "transforms.json"), ("metashape", tmp_path, "cameras.xml")]
    random = np.random.default_rng(5)
    refused = 0
    for format, folder, name in files:
        sound = (folder / name).read_bytes()
        for _ in range(150):
            data = bytearray(sound)
            start = int(random.integers(len(data)))
            stop = min(len(data), start + int(random.integers(1, 9)))
            data[start:stop] = [b"", bytes(data[start:stop]) * 2, random.bytes(stop - start)][int(random.integers(3))]
            (folder / name).write_bytes(data)
            try:
                read_source(format, folder / name if format == "metashape" else folder)
            except UnshadeError as error:
                refused += 1
                assert "\n" not in str(error) and str(folder) in str(error)
        (folder / name).write_bytes(sound)
    assert refused > 200

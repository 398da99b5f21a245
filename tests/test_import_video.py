"""`unshade import` of a video's frames: which are chosen, and exposures that no file states."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import painted_capture
import pytest
from PIL import Image

import unshade
from conftest import CASE
from conftest import unshade as command
from unshade.errors import CaptureError, SolveError
from unshade.files.pictures import read_rgb, write_exr
from unshade.importing.frame_choice import chosen_frames
from unshade.methods import require_still_light

AZIMUTHS = tuple(np.linspace(-60, 60, 25))


def textured(points: np.ndarray, normals: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    return (0.3 + 0.2 * np.sin(400 * points[:, 0]) * np.cos(300 * points[:, 1]))[:, None] * [1.0, 0.8, 0.7]


@pytest.fixture
def video(tmp_path: Path) -> Path:
    """25 frames of a sweep; every second one is blurred, and every third one half as bright."""
    taken = painted_capture.views(AZIMUTHS, textured)
    for number, view in enumerate(taken):
        radiance = view.radiance * (0.5 if number % 3 else 1.0)
        if number % 2:
            radiance = cv2.GaussianBlur(radiance, (0, 0), 1.5)
        taken[number] = painted_capture.replace(view, radiance=radiance)
    return painted_capture.write(tmp_path / "video", taken)


def imported(folder: Path, out: Path, **options: Any) -> tuple[dict[str, Any], dict[str, Any]]:
    """``transforms.json`` and ``import.json`` of the capture."""
    files = {"mesh": folder / "head.obj", "masks": folder / "masks"}
    unshade.import_capture("transforms", folder, out, place="keep", **files, **options)
    read = lambda name: json.loads((out / name).read_text())
    return read("transforms.json"), read("import.json")


def test_sharp_frames_from_all_sides_are_chosen(video: Path, tmp_path: Path) -> None:
    document, record = imported(video, tmp_path / "capture", frames=7)
    names = [int(frame["name"]) for frame in document["frames"]]
    assert len(names) == 7 and all(number % 2 == 0 for number in names)
    # The whole sweep, in steps of a sixth of it at most.
    assert min(names) <= 2 and max(names) >= 22 and max(np.diff(names)) <= 6
    sharp = record["frames"]["sharpness"]
    assert record["frames"]["chosen"] == 7 and len(sharp) == 25
    blurred, clear = ([sharp[f"{n:03}"] for n in range(first, 25, 2)] for first in (1, 0))
    assert max(blurred) < min(clear)
    assert any("7 of 25 frames are chosen" in note for note in record["assumed"])
    again, _ = imported(video, tmp_path / "again", frames=7)
    assert again == document


def test_named_frames_stay(video: Path, tmp_path: Path) -> None:
    document, record = imported(video, tmp_path / "capture", frames=5, holdout=["001", "013"])
    assert record["withheld"] == ["001", "013"] and len(document["frames"]) == 7
    with pytest.raises(CaptureError, match="frames is 2; a capture needs at least three"):
        imported(video, tmp_path / "few", frames=2)


def test_frames_of_one_place_come_last() -> None:
    seen_from = np.array([[0.0, 0, 1]] * 5 + [[1.0, 0, 0], [0, 1, 0]])
    assert chosen_frames(seen_from, [1, 5, 3, 2, 4, 1, 1], 3) == [1, 5, 6]
    assert chosen_frames(seen_from, [1, 5, 3, 2, 4, 1, 1], 9) == list(range(7))


def test_unknown_exposures_are_stated_for_the_solver(video: Path, tmp_path: Path) -> None:
    document, record = imported(video, tmp_path / "capture", unknown_exposure=True)
    assert document["exposure"] == "unknown" == record["exposure"]
    assert "exposure" not in imported(video, tmp_path / "known")[0]
    # What a file states of itself is kept.
    assert imported_again(tmp_path / "capture", tmp_path / "second")["exposure"] == "unknown"
    with pytest.raises(SolveError, match="exposures of frames are unknown .* but sh-lambert assumes"):
        require_still_light("sh-lambert", tmp_path / "capture")
    with pytest.raises(CaptureError, match="exposures are unknown and the light moves"):
        imported(video, tmp_path / "x", unknown_exposure=True, light_frame="camera")
    with pytest.raises(CaptureError, match="unknown_exposure is for exposures that no file states"):
        imported(video, tmp_path / "x", unknown_exposure=True, even_exposure=True)


def test_brackets_of_unknown_white_balance(tmp_path: Path) -> None:
    """The times in EXIF merge each bracket; the white balance, which no file states, is left to the solver."""
    taken = painted_capture.views((-30, -10, 10, 30), textured)
    folder = painted_capture.write(tmp_path / "brackets", taken)
    document = json.loads((folder / "transforms.json").read_text())
    balances = [(1.0, 1.0, 1.0), (1.3, 1.0, 0.8), (0.8, 1.0, 1.3), (1.1, 1.0, 1.2)]
    for number, (view, balance, frame) in enumerate(zip(taken, balances, document["frames"])):
        for place, seconds in enumerate((0.1, 0.4, 1.6)):
            exif = Image.Exif()
            exif[0x8769] = {0x829A: seconds * 1.5**number, 0x829D: 1.0, 0x8827: 100}
            codes = painted_capture.srgb_codes(view.radiance * balance * seconds * 1.5**number)
            Image.fromarray(codes).save(folder / "images" / f"{view.name}-{place}.png", exif=exif)
        (folder / "images" / f"{view.name}.png").unlink()
        (folder / "masks" / f"{view.name}.png").rename(folder / "masks" / f"{view.name}-0.png")
        frame["file_path"] = f"images/{view.name}-0.png"
    (folder / "transforms.json").write_text(json.dumps(document))
    out = tmp_path / "capture"
    document, record = imported(folder, out, brackets=3, unknown_exposure=True)
    assert document["exposure"] == "unknown" and record["brackets"] == 3
    factors = []
    for view, balance, frame in zip(taken, balances, document["frames"], strict=True):
        picture = read_rgb(out / frame["file_path"])
        factors.append(np.median(picture[view.mask] / (view.radiance * balance)[view.mask], axis=0))
    np.testing.assert_allclose(factors, np.broadcast_to(np.mean(factors), (4, 3)), rtol=0.05)
    for picture in folder.glob("images/*.png"):
        Image.open(picture).save(picture)
    with pytest.raises(CaptureError, match="has no exposure time in its EXIF"):
        imported(folder, tmp_path / "x", brackets=3, unknown_exposure=True)


def imported_again(capture: Path, out: Path) -> dict[str, Any]:
    unshade.import_capture("transforms", capture, out, place="keep")
    return json.loads((out / "transforms.json").read_text())


def test_gains_of_a_rendered_capture_are_found(tiny_run: Path, tmp_path: Path) -> None:
    """Skin in studio light with highlights, four views: each channel's gain to 3 %, with a rest of 1 % on average."""
    capture = tmp_path / "capture"
    shutil.copytree(tiny_run / "captures" / CASE, capture)
    document = json.loads((capture / "transforms.json").read_text()) | {"exposure": "unknown"}
    (capture / "transforms.json").write_text(json.dumps(document))
    names = [Path(name).stem for name in document["train_filenames"]]
    gains = 2 ** np.random.default_rng(7).normal(0, [0.5, 0.4, 0.6], (len(names), 3))
    for name, gain in zip(names, gains):
        path = capture / "images" / f"{name}.exr"
        write_exr(path, {"": (read_rgb(path) * gain).astype(np.float32)})
    (tmp_path / "quick.toml").write_text('base = "paper"\nwarm_up.iterations = 1\nfine_tuning.iterations = 1\n')
    command("solve", capture, "-o", tmp_path / "maps", "--config", tmp_path / "quick.toml")
    found = json.loads((tmp_path / "maps" / "solve.json").read_text())["gains"]
    assert [name for name, _ in found] == names
    error = np.log(np.array([gain for _, gain in found])) - np.log(gains / np.exp(np.log(gains).mean(0)))
    assert np.abs(error).max() < 0.03 and np.abs(error).mean() < 0.01, error


def test_a_withheld_photograph_counts_after_its_own_gain(photographs: Path, tmp_path: Path) -> None:
    capture, views = tmp_path / "capture", tmp_path / "maps" / "views"
    shutil.copytree(photographs, capture)
    unshade.Maps(diffuse_albedo=np.full((64, 64, 3), 0.5, np.float32)).write(tmp_path / "maps")
    views.mkdir()
    (name,) = (Path(file).stem for file in json.loads((capture / "transforms.json").read_text())["test_filenames"])
    seen = read_rgb(capture / "images" / f"{name}.exr")
    # Another exposure and white balance, and an error of a tenth on every other row.
    wrong = seen * (1 + 0.1 * (np.arange(len(seen)) % 2)[:, None, None])
    write_exr(views / f"{name}.exr", {"": (wrong * [0.3, 0.5, 0.8]).astype(np.float32)})

    def score() -> tuple[str, float]:
        scores = unshade.score(capture, tmp_path / "maps")
        value = scores.value(subject="view", metric="psnr_srgb", scale="none")
        assert value is not None
        return scores["protocol"]["id"], value

    known, low = score()
    document = json.loads((capture / "transforms.json").read_text()) | {"exposure": "unknown"}
    (capture / "transforms.json").write_text(json.dumps(document))
    unknown, high = score()
    assert known == "unshade-photographs-1" and unknown == "unshade-photographs-1 own-gains"
    assert low < 20 and 30 < high < 60

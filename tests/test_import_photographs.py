"""`unshade import` of photographs that lie, stand or turn another way than their files suggest, from the command line."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import colour
import numpy as np
import painted_capture
import pytest
from painted_capture import View
from PIL import Image

import unshade
from conftest import unshade as command
from unshade.errors import CaptureError
from unshade.importing.moving_light import LightMotion

ARC = (-60, -30, 0, 30, 60)


def _imported(folder: Path, *options: object) -> tuple[Path, dict[str, Any], str]:
    """The capture, its ``import.json`` and what the terminal shows."""
    format = "transforms" if (folder / "transforms.json").is_file() else "colmap"
    files = ("--mesh", folder / "head.obj", "--masks", folder / "masks")
    out = folder.with_name("capture")
    done = command("import", format, folder, "-o", out, *files, *options)
    return out, json.loads((out / "import.json").read_text()), done.stderr


def _agree(capture: Path, taken: Sequence[View], tolerance: float = 0.004) -> None:
    """Pictures and masks are those of the views."""
    read = unshade.Capture(capture)
    for view in taken:
        np.testing.assert_allclose(read.image(view.name), view.radiance, atol=tolerance)
        np.testing.assert_array_equal(read.mask(view.name) > 0, view.mask)


@pytest.mark.parametrize(("ending", "colmap"), [("tif", False), ("tif", True), ("jpg", False)])
def test_exif_orientation_is_applied_as_the_cameras_ask(ending: str, colmap: bool, tmp_path: Path) -> None:
    """Photographs of a camera that lay on its side: COLMAP counts pixels as stored, nerfstudio as shown."""
    upright = painted_capture.views(ARC)
    lying = [view.rolled(-1) for view in upright]
    np.testing.assert_allclose(np.rot90(lying[0].radiance, -1), upright[0].radiance, atol=1e-9)
    counted = lying if colmap else upright
    folder = painted_capture.write(tmp_path / "head", counted, colmap=colmap, ending=ending)
    for view in lying:
        painted_capture.save(folder / "images" / view.name, view.radiance, ending=ending, orientations=[6])
    capture, record, said = _imported(folder, "--curve", "linear" if ending == "tif" else "auto")
    _agree(capture, counted, 0.06 if ending == "jpg" else 0.004)
    np.testing.assert_allclose(record["source_to_capture"], np.eye(4), atol=1e-9)
    told = "by EXIF orientation of 5 photographs" if colmap else "by the cameras' mean up"
    assert f"head upright {told}" in said


TURN = np.eye(4)
TURN[:3, :3] = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
TURN[:3, :3] *= np.linalg.det(TURN[:3, :3])
"""From the head's axes to those of a world as structure from motion leaves it."""


@pytest.mark.parametrize(
    ("rolls", "orientations", "world", "told"),
    [
        ([-1], [6], TURN, "by EXIF orientation of 5 photographs"),
        ([-1, 1, 0, 2, -1], [6, 8, 1, 3, 6], TURN, "by EXIF orientation of 4 photographs"),
        ([0], [1, 6, 8, 1, 3], TURN, "by the cameras' mean up, with which EXIF orientation of 3 photographs"),
        ([0], [1], TURN, "by the cameras' mean up"),
        ([1], [1], np.eye(4), "as in the source, where photographs lie on their sides"),
        ([2], [1], np.eye(4), "as in the source, where photographs lie upside down"),
    ],
)
def test_up_is_that_of_the_photographs_as_shown(
    rolls: list[int], orientations: list[int], world: np.ndarray, told: str, tmp_path: Path
) -> None:
    upright = painted_capture.views(ARC, elevation=0)
    taken = [view.rolled(rolls[number % len(rolls)]).moved(world) for number, view in enumerate(upright)]
    folder = painted_capture.write(tmp_path / "head", taken, world, colmap=True, orientations=orientations)
    record = _record(folder, tmp_path)
    assert told in record["summary"]
    np.testing.assert_allclose(_head_axes(record, world), np.eye(3)[:, 1:], atol=0.05)


def test_photographs_that_lie_in_a_world_that_lies_are_pointed_out(tmp_path: Path) -> None:
    taken = [view.rolled(1).moved(TURN) for view in painted_capture.views(ARC)]
    folder = painted_capture.write(tmp_path / "head", taken, TURN, colmap=True)
    with pytest.warns(UserWarning, match="seem to be rotated by 90 degrees, and EXIF does not state the direction"):
        _record(folder, tmp_path)
    scattered = [view.rolled(number) for number, view in enumerate(painted_capture.views((-40, -20, 0, 20)))]
    folder = painted_capture.write(tmp_path / "scattered", [view.moved(TURN) for view in scattered], TURN, colmap=True)
    with pytest.raises(CaptureError, match="do not agree which way is up"):
        _record(folder, tmp_path)


def test_a_head_captured_all_round_keeps_its_azimuth_or_a_view_states_it(tmp_path: Path) -> None:
    """Twelve views in a circle and two more from behind, whose mean direction is noise."""
    taken = painted_capture.views([*range(0, 360, 30), 165, 195], elevation=0)
    folder = painted_capture.write(tmp_path / "head", taken)
    _, record, said = _imported(folder)
    np.testing.assert_allclose(record["source_to_capture"], np.eye(4), atol=1e-9)
    assert "cameras surround the head" in said and "cameras surround the head" in " ".join(record["assumed"])
    assert "the azimuth is the source's" in record["front"]
    _, record, said = _imported(folder, "--front", "003.png")
    assert "surround the head" not in said and record["front"] == "where 003.png looks from"
    np.testing.assert_allclose(np.array(record["source_to_capture"])[:3, :3] @ [1, 0, 0], [0, 0, 1], atol=1e-6)
    lying = painted_capture.write(tmp_path / "lying", [view.moved(TURN) for view in taken], TURN)
    record = _record(lying, tmp_path)
    np.testing.assert_allclose(_head_axes(record, TURN)[:, 0], [0, 1, 0], atol=1e-3)
    for options, words in (({"front": "x"}, "no view 'x'"), ({"front": "003", "place": "keep"}, "state one of them")):
        with pytest.raises(CaptureError, match=words):
            _record(folder, tmp_path, **options)


def _record(folder: Path, out: Path, **options: Any) -> dict[str, Any]:
    """``import.json`` of a capture that Python imports."""
    format = "transforms" if (folder / "transforms.json").is_file() else "colmap"
    files = {"mesh": folder / "head.obj", "masks": folder / "masks"}
    return json.loads(
        (unshade.import_capture(format, folder, out / "capture", **files, **options) / "import.json").read_text()
    )


def _head_axes(record: dict[str, Any], world: np.ndarray) -> np.ndarray:
    """The crown's and the nose's directions (3, 2) in the capture."""
    turn = np.array(record["source_to_capture"])[:3, :3]
    return (turn / np.cbrt(np.linalg.det(turn)) @ world[:3, :3])[:, 1:]


def test_adobe_rgb_that_only_exif_states_is_read_as_such(tmp_path: Path) -> None:
    adobe = colour.RGB_COLOURSPACES["Adobe RGB (1998)"]
    taken = painted_capture.views(ARC)
    folder = painted_capture.write(tmp_path / "head", taken)
    for view in taken:
        linear = colour.RGB_to_RGB(view.radiance, "ITU-R BT.709", "Adobe RGB (1998)", apply_cctf_decoding=False)
        codes = np.round(255 * adobe.cctf_encoding(linear.clip(0, 1))).astype(np.uint8)
        exif = Image.Exif()
        exif[0x8769] = {0xA001: 65535, 0xA005: {1: "R03"}}
        Image.fromarray(codes).save(folder / "images" / f"{view.name}.png", exif=exif)
    capture, record, _ = _imported(folder)
    _agree(capture, taken, 0.01)
    assert record["profiles"] == ["Adobe RGB (1998), by EXIF (ColorSpace 65535, InteropIndex R03)"]


def _lit(lamp: np.ndarray, *, turns: bool, gloss: float = 0.05) -> painted_capture.Paint:
    """Skin of spots under a lamp's direction (3,) and a dim sky, in the head's axes or in each camera's; with a
    highlight, noise of 2 %, and exposures that differ."""
    random = np.random.default_rng(1)

    def paint(points: np.ndarray, normals: np.ndarray, matrix: np.ndarray) -> np.ndarray:
        towards = matrix[:3, :3] @ lamp if turns else lamp
        away = matrix[:3, 3] - points
        half = towards + away / np.linalg.norm(away, axis=1, keepdims=True)
        half /= np.linalg.norm(half, axis=1, keepdims=True)
        albedo = 0.3 + 0.1 * np.sin(90 * points[:, 0]) * np.cos(70 * points[:, 1])
        light = 0.15 + (normals @ towards).clip(0)
        radiance = albedo * light + gloss * np.einsum("ij,ij->i", normals, half).clip(0) ** 30
        noise = 1 + 0.02 * random.standard_normal(len(points))
        return (random.uniform(0.5, 1.0) * radiance * noise)[:, None] * [1.0, 0.8, 0.7]

    return paint


KEY, FLASH = np.array([0.77, 0.34, 0.54]), np.array([0.0, 0.1, 0.995])


@pytest.mark.parametrize(("lamp", "turns"), [(KEY, False), (FLASH, False), (KEY, True), (FLASH, True)])
def test_light_that_moves_with_respect_to_the_head_is_named(lamp: np.ndarray, turns: bool, tmp_path: Path) -> None:
    taken = painted_capture.views((-60, -40, -20, 0, 20, 40, 60), _lit(lamp, turns=turns))
    folder = painted_capture.write(tmp_path / "head", taken)
    if turns:
        with pytest.warns(UserWarning, match="the light moves with respect to the head"):
            record = _record(folder, tmp_path)
    else:
        record = _record(folder, tmp_path)
    light = record["light"]
    assert light["moves"] == turns
    assert any(f"{light['one_light']:.0%} between views" in line for line in record["assumed"]) == turns
    assert light["own_lights"] < 0.12 and (light["one_light"] > 0.12) == turns


def test_views_that_differ_whatever_their_light_are_no_moving_light() -> None:
    """The numbers of a rendered face whose photographs stand on their heads, in softboxes."""
    turned = LightMotion(8, one_light=0.52, own_lights=0.42)
    assert not turned.moves and "photographs do not belong to their cameras" in (turned.warning("head") or "")
    assert LightMotion(8, one_light=0.07, own_lights=0.06).warning("head") is None

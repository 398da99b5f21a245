"""`unshade import` of captures whose light moves with the camera, or that have several lights."""

from __future__ import annotations

import json
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import painted_capture
import pytest

import unshade
from unshade.errors import CaptureError, SolveError
from unshade.importing.moving_light import LightMotion
from unshade.methods import PASSIVE, require_still_light
from unshade.stated_light import StatedLight, stated_light

AZIMUTHS = (-60, -40, -20, 0, 20, 40, 60)


def lamp_of_the_room(points: np.ndarray, normals: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    towards = matrix[:3, :3] @ [0.77, 0.34, 0.54]
    albedo = 0.3 + 0.1 * np.sin(90 * points[:, 0]) * np.cos(70 * points[:, 1])
    return (albedo * (0.15 + (normals @ towards).clip(0)))[:, None] * [1.0, 0.8, 0.7]


def imported(folder: Path, out: Path, **options: Any) -> tuple[dict[str, Any], list[str]]:
    """The ``transforms.json`` of an imported folder, and what was warned of."""
    format = "transforms" if (folder / "transforms.json").is_file() else "colmap"
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        unshade.import_capture(format, folder, out, mesh=folder / "head.obj", masks=folder / "masks", **options)
    return json.loads((out / "transforms.json").read_text()), [str(warning.message) for warning in caught]


@pytest.mark.parametrize("colmap", [False, True])
def test_a_light_that_moves_with_the_camera_is_stated(colmap: bool, tmp_path: Path) -> None:
    taken = painted_capture.views(AZIMUTHS, lamp_of_the_room)
    folder = painted_capture.write(tmp_path / "head", taken, colmap=colmap)
    silent, said = imported(folder, tmp_path / "still")
    assert "light_frame" not in silent
    assert any("the light moves" in line and "--light-frame camera" in line for line in said)
    stated, said = imported(folder, tmp_path / "turns", light_frame="camera")
    assert stated["light_frame"] == "camera" and not any("light" in line for line in said)
    assert stated_light(tmp_path / "turns") == StatedLight("camera", {})


def test_a_still_light_that_is_said_to_move_is_doubted() -> None:
    still = LightMotion(8, one_light=0.07, own_lights=0.06)
    assert "seems to stand still" in (still.warning("camera") or "") and still.warning("head") is None


def test_views_that_disagree_although_outlines_fit_may_be_glossy() -> None:
    glossy = LightMotion(8, one_light=0.5, own_lights=0.4)
    assert "glossier than skin" in (glossy.warning("head", fits=True) or "")
    assert "do not belong to their cameras" in (glossy.warning("head", fits=False) or "")


def test_what_a_transforms_file_states_of_its_light_is_kept(tmp_path: Path) -> None:
    folder = painted_capture.write(tmp_path / "head", painted_capture.views(AZIMUTHS, lamp_of_the_room))
    file = folder / "transforms.json"
    document = json.loads(file.read_text()) | {"light_frame": "camera"}
    for number, frame in enumerate(document["frames"]):
        frame["light"] = ("morning", "evening")[number % 2]
    file.write_text(json.dumps(document))
    stated, _ = imported(folder, tmp_path / "capture")
    assert stated["light_frame"] == "camera"
    assert [frame["light"] for frame in stated["frames"]][:3] == ["morning", "evening", "morning"]
    assert "light_frame" not in imported(folder, tmp_path / "head-frame", light_frame="head")[0]
    file.write_text(json.dumps(document | {"light_frame": "lamp"}))
    with pytest.raises(CaptureError, match="light_frame is 'lamp'; write one of head, camera"):
        imported(folder, tmp_path / "wrong")


def test_methods_of_one_still_light_refuse_by_name(tmp_path: Path) -> None:
    frames = [{"file_path": f"images/{name}.exr"} for name in ("a", "b")]
    file = tmp_path / "transforms.json"

    def state(**keys: Any) -> None:
        file.write_text(json.dumps({"frames": frames} | keys))

    state()
    for name in PASSIVE:
        require_still_light(name, tmp_path)
    state(light_frame="camera")
    for name in PASSIVE:
        with pytest.raises(SolveError, match=f"the light moves with the camera .* but {name} assumes one light that"):
            require_still_light(name, tmp_path)
    require_still_light("flash-only", tmp_path)  # photographs the face in its own light
    state(frames=[frame | {"light": "flash"} for frame in frames])
    require_still_light("sh-lambert", tmp_path)
    state(frames=[frame | {"light": frame["file_path"]} for frame in frames])
    with pytest.raises(SolveError, match="frames have different lights .* but sh-lambert assumes one light"):
        require_still_light("sh-lambert", tmp_path)


@pytest.mark.parametrize(
    "content", ["{}", "[]", '{"frames": 3}', '{"frames": [{}]}', '{"frames": [], "light_frame": 1}']
)
def test_a_faulty_file_is_named(content: str, tmp_path: Path) -> None:
    (tmp_path / "transforms.json").write_text(content)
    with pytest.raises(CaptureError, match=r"transforms\.json: "):
        stated_light(tmp_path)

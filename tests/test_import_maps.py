"""`unshade import maps`: maps of ours, as other methods would have written them, score the same again."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import foreign_maps
import numpy as np
import pytest
from foreign_maps import Layout

import unshade
from conftest import CASE
from conftest import unshade as command
from unshade import _native
from unshade.errors import MapsError, StorageError
from unshade.importing.maps.statement import known_adapters

LOSS_DB = 0.05
"""What a format and another layout may cost the diffuse albedo."""


@pytest.fixture(scope="session")
def capture(tiny_run: Path) -> unshade.Capture:
    return unshade.Capture(tiny_run / "captures" / CASE)


@pytest.fixture(scope="session")
def native(tiny_run: Path) -> Path:
    """Maps with errors of their own, so that scores are finite."""
    return tiny_run / "maps" / CASE / "quick"


def albedo_db(capture: unshade.Capture, maps: Path, scale: str = "global") -> float:
    scores = unshade.score(capture, maps)
    value = scores.value(
        subject="diffuse_albedo", metric="psnr_srgb", scale=scale, region="coverage-e5", label=None, light=None
    )
    assert value is not None
    return value


@pytest.fixture(scope="session")
def native_db(capture: unshade.Capture, native: Path) -> float:
    return albedo_db(capture, native)


def record(maps: Path) -> dict[str, Any]:
    return json.loads((maps / "import.json").read_text())


def bring(capture: unshade.Capture, folder: Path, out: Path, **choices: Any) -> Path:
    return unshade.import_maps(folder, out, capture=capture, size=choices.pop("size", 256), **choices)


@pytest.fixture(scope="session")
def layout(capture: unshade.Capture) -> Layout:
    return Layout(capture, 512)


@pytest.mark.parametrize("adapter", foreign_maps.WRITERS)
def test_foreign_files_of_another_layout_score_as_the_native_maps(
    adapter: str, capture: unshade.Capture, native: Path, native_db: float, layout: Layout, tmp_path: Path
) -> None:
    maps = unshade.Maps.read(native)
    foreign_maps.WRITERS[adapter](maps, layout, tmp_path / "theirs")
    # Ours are recognised.
    out = bring(capture, tmp_path / "theirs", tmp_path / "maps", adapter=None if adapter == "unshade" else adapter)
    assert abs(albedo_db(capture, out) - native_db) < LOSS_DB
    said, back = record(out), unshade.Maps.read(out)
    assert said["covered"] > 0.999 and said["distance_mm"]["largest"] < 1e-3 and said["findings"] == []
    inside = maps.coverage > 0
    # Half a code of 8 bits, and what interpolation across an edge of the relief takes.
    assert np.abs(back.specular_albedo - maps.specular_albedo)[inside].mean() < 0.0015
    if adapter != "nextface":
        cosine = (back.specular_normal * maps.specular_normal).sum(-1)[inside]
        assert np.degrees(np.arccos(cosine.clip(-1, 1))).mean() < 0.8
    if adapter == "unshade":
        np.testing.assert_allclose(
            back.roughness[inside], np.broadcast_to(foreign_maps.LOBES, (inside.sum(), 3)), atol=1e-6
        )
        names, std = _native.read_exr(out / "diffuse_albedo_std.exr")
        assert names == ["Y"] and np.allclose(std[inside], 0.25, atol=1e-6)
        assert json.loads((out / "solve.json").read_text())["seed"] == 7
        with pytest.raises(MapsError, match="holds alpha1, alpha2, share1, but settings says roughness.as = gloss"):
            bring(capture, tmp_path / "theirs", tmp_path / "x", adapter="any", settings={"roughness": {"as": "gloss"}})
    elif back.roughness is not None:
        alpha = 0.45**2 if adapter == "opendelight" else 0.3
        assert np.abs(back.roughness[..., :2] - alpha).max() < 0.01


def test_every_adapter_has_files_written_for_it() -> None:
    assert {*known_adapters()} == {*foreign_maps.WRITERS, "any"}


def test_the_same_layout_loses_nothing_but_the_codes(capture: unshade.Capture, native: Path, tmp_path: Path) -> None:
    maps = unshade.Maps.read(native)
    layout = Layout(capture, 256, own=True)
    layout.write_mesh(tmp_path / "theirs" / "face.obj")
    foreign_maps.write_png(tmp_path / "theirs" / "albedo.png", foreign_maps.srgb(maps.diffuse_albedo), 16)
    back = unshade.Maps.read(bring(capture, tmp_path / "theirs", tmp_path / "maps", size=None))
    inside = back.coverage > 0
    assert inside.sum() > 0.999 * (capture.truth().coverage > 0).sum()
    # A code of 16 bits is 1.5e-5 wide, and no more than 1 / 12.92 of it in the dark.
    np.testing.assert_allclose(back.diffuse_albedo[inside], maps.diffuse_albedo[inside], atol=4e-5)


WRONG: dict[str, tuple[dict[str, Any], str]] = {
    "v": ({"v": "up"}, "says v = up, but down fits"),
    "curve": ({"diffuse_albedo": {"curve": "linear"}}, "says diffuse_albedo.curve = linear, but srgb fits"),
    "space": ({"normal": {"as": "object"}}, "says normal.as = object, but tangent fits"),
    "green": ({"normal": {"green": "down"}}, "says normal.green = down, but up fits"),
    "specular": ({"specular_albedo": {"as": "reflectance"}}, "says specular_albedo.as = reflectance, but level fits"),
    "roughness": ({"roughness": {"as": "gloss"}}, "says roughness.as = gloss, but perceptual fits"),
}


@pytest.fixture(scope="session")
def doubted(capture: unshade.Capture, native: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A set that is stored upside down, with every encoding that is wrong in `WRONG` the other way around."""
    folder = tmp_path_factory.mktemp("doubted")
    layout = Layout(capture, 256, down=True)
    foreign_maps.opendelight(unshade.Maps.read(native), layout, folder)
    foreign_maps.write_png(folder / "roughness.png", np.full((64, 64), 0.75))
    return folder


@pytest.mark.parametrize("fault", WRONG)
def test_a_wrong_statement_is_found_and_named(
    fault: str, capture: unshade.Capture, doubted: Path, tmp_path: Path
) -> None:
    settings, words = WRONG[fault]
    with pytest.raises(MapsError) as refusal:
        bring(capture, doubted, tmp_path / "maps", settings=settings)
    message = str(refusal.value)
    assert f"settings {words}" in message and "\n" not in message and not (tmp_path / "maps").exists(), message


def test_what_fits_better_is_taken_if_asked_and_said(
    capture: unshade.Capture, native_db: float, doubted: Path, tmp_path: Path
) -> None:
    settings: dict[str, Any] = {}
    for wrong, _ in WRONG.values():
        for key, value in wrong.items():
            settings[key] = {**settings[key], **value} if key in settings and key != "v" else value
    out = bring(capture, doubted, tmp_path / "maps", settings=settings, apply=True)
    taken = {trial["key"]: (trial["taken"], trial["how"]) for trial in record(out)["trials"]}
    expected = {"v": "down", "diffuse_albedo.curve": "srgb", "normal.as": "tangent", "normal.green": "up"}
    expected |= {"specular_albedo.as": "level", "roughness.as": "perceptual"}
    assert taken == {key: (value, "applied") for key, value in expected.items()}
    assert abs(albedo_db(capture, out) - native_db) < 4 * LOSS_DB  # of half the texels
    # Nothing stated at all: the same is found.
    found = record(bring(capture, doubted, tmp_path / "maps"))
    assert {trial["key"]: trial["taken"] for trial in found["trials"]} == expected


def test_a_mesh_of_another_unit_and_axes_is_placed(capture: unshade.Capture, native: Path, tmp_path: Path) -> None:
    maps, layout = unshade.Maps.read(native), Layout(capture, 256)
    z_up = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
    foreign_maps.write_png(tmp_path / "theirs" / "albedo.png", foreign_maps.srgb(layout.texture(maps.diffuse_albedo)))
    objects = layout.texture(maps.specular_normal) @ z_up.T
    foreign_maps.write_png(tmp_path / "theirs" / "normal.png", objects / 2 + 0.5, 16)
    layout.write_mesh(tmp_path / "theirs" / "head.obj", 1000, z_up)
    out = bring(capture, tmp_path / "theirs", tmp_path / "maps")
    assert record(out)["placed"] == "as it is in mm with axes x, z, -y as x, y, z"
    cosine = (unshade.Maps.read(out).specular_normal * maps.specular_normal).sum(-1)[maps.coverage > 0]
    assert np.degrees(np.arccos(cosine.clip(-1, 1))).mean() < 1.2  # half the texels
    with pytest.raises(MapsError, match=r"lies .* from the capture's mesh as it is"):
        bring(capture, tmp_path / "theirs", tmp_path / "other", place="keep", size=64)
    # Neither a unit nor a quarter turn: a similarity is fitted.
    turn = np.eye(3)
    turn[:2, :2] = foreign_maps.rotation(8)
    layout.write_mesh(tmp_path / "theirs" / "head.obj", 1.04, turn)
    fitted = record(bring(capture, tmp_path / "theirs", tmp_path / "other", place="fit", size=64))
    assert fitted["distance_mm"]["median"] < 0.4, fitted


def test_texels_without_a_counterpart_stay_uncovered(capture: unshade.Capture, native: Path, tmp_path: Path) -> None:
    maps, layout = unshade.Maps.read(native), Layout(capture, 256, own=True)
    kept = layout.vertices[layout.triangles].mean(1)[:, 0] < 0
    layout.triangles = layout.triangles[kept]
    foreign_maps.write_png(tmp_path / "theirs" / "albedo.png", foreign_maps.srgb(maps.diffuse_albedo), 16)
    layout.write_mesh(tmp_path / "theirs" / "half.obj")
    back = unshade.Maps.read(bring(capture, tmp_path / "theirs", tmp_path / "maps", limit_mm=1))
    fraction = (back.coverage > 0).sum() / (maps.coverage > 0).sum()
    assert 0.35 < fraction < 0.75
    assert np.isfinite(back.diffuse_albedo).all() and back.diffuse_albedo[maps.coverage > 0].min() > 0.001


def test_the_command_line_and_an_adapter_of_ones_own(capture: unshade.Capture, native: Path, tmp_path: Path) -> None:
    maps, layout = unshade.Maps.read(native), Layout(capture, 256)
    layout.write_mesh(tmp_path / "theirs" / "x.obj")
    foreign_maps.write_png(
        tmp_path / "theirs" / "skin" / "Color.PNG", foreign_maps.srgb(layout.texture(maps.diffuse_albedo))
    )
    (tmp_path / "mine.toml").write_text('format = 1\nmesh = "x.obj"\n[diffuse_albedo]\nfile = "skin/color.png"\n')
    words = ["import", "maps", tmp_path / "theirs", "--capture", capture.path, "-o", tmp_path / "maps"]
    done = command(*words, "--adapter", tmp_path / "mine.toml", "--set", "diffuse_albedo.curve=srgb", "--size", 64)
    assert "import.json" in done.stderr and record(tmp_path / "maps")["size"] == 64
    refused = command(*words, "--adapter", tmp_path / "mine.toml", "--set", "diffuse_albedo.curv=srgb", check=False)
    assert refused.returncode == 2 and refused.stderr.count("\n") == 1 and "diffuse_albedo.curv" in refused.stderr


def test_invalid_imports_are_one_line_errors(capture: unshade.Capture, doubted: Path, tmp_path: Path) -> None:
    def refused(words: str, error: type[Exception] = MapsError, folder: Path = doubted, **choices: Any) -> None:
        with pytest.raises(error, match=words) as refusal:
            bring(capture, folder, choices.pop("out", tmp_path / "out"), **choices)
        assert "\n" not in str(refusal.value)

    (tmp_path / "empty").mkdir()
    refused("is not a folder", folder=tmp_path / "nothing")
    refused("holds none of diffuseMap", adapter="nextface")
    refused("holds none of", folder=tmp_path / "empty")
    refused("there are any, avatarme", adapter="nextfase")
    refused("'albedo' is unknown", settings={"albedo": {}})
    refused("diffuse_albedo.as is 'srgb'", settings={"diffuse_albedo": {"as": "srgb"}})
    refused("unit 'ell'", unit="ell")
    refused("place 'there'", place="there")
    refused("size is 4", size=4)
    refused("limit_mm is 0", limit_mm=0)
    refused("was not imported", place="source")
    refused("which is read; choose another folder", StorageError, out=doubted)
    # Two materials whose halves of the face lie over each other: each has a texture, and one is read.
    pages = Layout(capture, 64, own=True)
    right = pages.vertices[pages.triangles].mean(1)[:, 0] > 0
    pages.uv, pages.triangles = (
        np.tile(pages.uv, (2, 1)),
        np.where(right[:, None], pages.triangles + len(pages.uv), pages.triangles),
    )
    pages.uv[len(pages.uv) // 2 :] *= [-1, 1]
    pages.uv[len(pages.uv) // 2 :] += [1, 0]
    pages.vertices = np.tile(pages.vertices, (2, 1))
    pages.write_mesh(tmp_path / "pages.obj")
    lines = (tmp_path / "pages.obj").read_text().splitlines()
    faces = [line for line in lines if line.startswith("f ")]
    halves = [f for f, r in zip(faces, right) if not r], [f for f, r in zip(faces, right) if r]
    lines = [*lines[: -len(faces)], "usemtl left", *halves[0], "usemtl right", *halves[1]]
    (tmp_path / "pages.obj").write_text("\n".join(lines))
    refused('material "left" and material "right" lie over each other in UV', mesh=tmp_path / "pages.obj", size=64)
    assert not (tmp_path / "out").exists() and (doubted / "head.obj").is_file()

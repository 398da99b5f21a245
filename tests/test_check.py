"""Faults that maps most often have, planted one by one: each is found and named, and sound maps pass."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import mitsuba as mi
import numpy as np
import pytest

import unshade
from conftest import CASE
from conftest import unshade as command

RGB, GREY, LOBES = ["R", "G", "B"], ["Y"], ["alpha1", "alpha2", "share1"]
ALBEDO, NORMAL, SPECULAR = "diffuse_albedo.exr", "specular_normal.exr", "specular_albedo.exr"
ROUGHNESS, COVERAGE = "roughness.exr", "coverage.png"
Array = np.ndarray


def read(path: Path) -> Array:
    bitmap = mi.Bitmap(str(path))
    channels = [field.name.rsplit(".")[-1] for field in bitmap.struct_()]
    array = np.array(bitmap).reshape(bitmap.height(), bitmap.width(), -1)
    names = [names for names in (RGB, GREY, LOBES) if set(names) == set(channels)]
    return array[..., [channels.index(name) for name in names[0]]] if names else array


def write(path: Path, array: Array) -> None:
    path.unlink(missing_ok=True)
    if path.suffix == ".png":
        mi.Bitmap(np.ascontiguousarray(array.reshape(array.shape[:2]), np.uint8)).write(str(path))
        return
    names = {1: GREY, 2: ["Y", "A"], 3: LOBES if path.name == ROUGHNESS else RGB}[array.shape[-1]]
    pixels = np.ascontiguousarray(array, np.float32)
    mi.Bitmap(pixels, pixel_format=mi.Bitmap.PixelFormat.MultiChannel, channel_names=names).write(str(path))


def srgb(x: Array) -> Array:
    x = np.clip(x, 0, None)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.maximum(x, 1e-9) ** (1 / 2.4) - 0.055)


def rotated(n: Array, degrees: float) -> Array:
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return n @ np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]])


def tangent(n: Array) -> Array:
    wave = np.random.default_rng(0).normal(0, 0.1, n.shape)
    return (wave + [0, 0, 1]) / np.linalg.norm(wave + [0, 0, 1], axis=-1, keepdims=True)


VIEW = rotated(np.eye(3), 0)
"""World to camera (transposed) of the first view; the fixture sets it."""


def hole(value: float) -> Callable[[Array], Array]:
    """Twelve texels in the middle of the face."""

    def with_hole(x: Array) -> Array:
        x = x.copy()
        x[x.shape[0] // 2, x.shape[1] // 2 - 6 : x.shape[1] // 2 + 6] = value
        return x

    return with_hole


FAULTS: dict[str, tuple[str, Callable[[Array], Array], str]] = {
    "albedo flipped in v": (ALBEDO, lambda x: x[::-1], "flipped-v"),
    "albedo mirrored in u": (ALBEDO, lambda x: x[:, ::-1], "mirrored-u"),
    "albedo turned by 180": (ALBEDO, lambda x: x[::-1, ::-1], "turned-180"),
    "albedo transposed": (ALBEDO, lambda x: x.swapaxes(0, 1), "transposed"),
    "albedo turned clockwise": (ALBEDO, lambda x: np.rot90(x, -1), "turned-90"),
    "albedo sRGB-encoded": (ALBEDO, srgb, "srgb-encoded"),
    "albedo 0 to 255": (ALBEDO, lambda x: 255 * x, "coded-0-255"),
    "albedo of one colour, 0 to 255": (ALBEDO, lambda x: 0 * x + 180, "coded-0-255"),
    "albedo bright and pale": (ALBEDO, lambda x: 1.5 * srgb(x), "exposure"),
    "albedo 0 to 255 and sRGB": (ALBEDO, lambda x: 255 * srgb(x), "coded-0-255"),
    "albedo four times as bright": (ALBEDO, lambda x: 4 * x, "exposure"),
    "albedo a tenth as bright": (ALBEDO, lambda x: 0.1 * x, "exposure"),
    "albedo from -1 to 1": (ALBEDO, lambda x: 2 * x - 1, "negative"),
    "albedo B, G, R": (ALBEDO, lambda x: x[..., ::-1], "bgr"),
    "albedo grey": (ALBEDO, lambda x: 0 * x + 0.5, "constant"),
    "albedo black": (ALBEDO, lambda x: 0 * x, "black"),
    "albedo with NaN": (ALBEDO, hole(np.nan), "not-finite"),
    "albedo infinite": (ALBEDO, hole(np.inf), "not-finite"),
    "albedo not square": (ALBEDO, lambda x: x[: x.shape[0] // 2], "not-square"),
    "albedo of another size": (ALBEDO, lambda x: x[::2, ::2], "sizes-differ"),
    "albedo of one channel": (ALBEDO, lambda x: x[..., :1], "channels"),
    "normal flipped in v": (NORMAL, lambda n: n[::-1], "flipped-v"),
    "normal mirrored in u": (NORMAL, lambda n: n[:, ::-1], "mirrored-u"),
    "normal transposed": (NORMAL, lambda n: n.swapaxes(0, 1), "transposed"),
    "normal negated": (NORMAL, lambda n: -n, "negated"),
    "normal with y flipped": (NORMAL, lambda n: n * [1, -1, 1], "y-flipped"),
    "normal with x flipped": (NORMAL, lambda n: n * [-1, 1, 1], "x-flipped"),
    "normal with z up": (NORMAL, lambda n: n[..., [0, 2, 1]] * [1, -1, 1], "axes"),
    "normal B, G, R": (NORMAL, lambda n: n[..., ::-1], "axes"),
    "normal coded 0 to 1": (NORMAL, lambda n: n / 2 + 0.5, "coded-0-1"),
    "normal coded 0 to 255": (NORMAL, lambda n: 127.5 * (n + 1), "coded-0-255"),
    "normal in tangent space": (NORMAL, tangent, "tangent-space"),
    "normal in tangent space, coded": (NORMAL, lambda n: tangent(n) / 2 + 0.5, "tangent-space"),
    "normal turned by 70 degrees": (NORMAL, lambda n: rotated(n, 70), "turned-normals"),
    "normal in the first camera's space": (NORMAL, lambda n: n @ VIEW, "camera-space"),
    "normal of length 2": (NORMAL, lambda n: 2 * n, "not-unit"),
    "normal of length 0 here and there": (NORMAL, hole(0), "zero-length"),
    "normal of length 0": (NORMAL, lambda n: 0 * n, "zero-length"),
    "normal with NaN": (NORMAL, hole(np.nan), "not-finite"),
    "specular 0 to 1": (SPECULAR, lambda x: x / x.max(), "range-0-1"),
    "specular as level": (SPECULAR, lambda x: x / 0.08, "specular-level"),
    "specular 0 to 255": (SPECULAR, lambda x: 255 * x / 0.05, "coded-0-255"),
    "specular as index of refraction": (SPECULAR, lambda x: (1 + x**0.5) / (1 - x**0.5), "index-of-refraction"),
    "specular sRGB-encoded": (SPECULAR, srgb, "srgb-encoded"),
    "specular beyond skin's": (SPECULAR, lambda x: 0 * x + 0.06, "beyond-range"),
    "specular black": (SPECULAR, lambda x: 0 * x, "black"),
    "roughness for alpha": (ROUGHNESS, lambda x: np.dstack([np.sqrt(x[..., :2]), x[..., 2:]]), "perceptual-roughness"),
    "gloss for alpha": (ROUGHNESS, lambda x: np.dstack([1 - x[..., :2], x[..., 2:]]), "gloss"),
    "gloss for roughness": (ROUGHNESS, lambda x: np.dstack([1 - np.sqrt(x[..., :2]), x[..., 2:]]), "gloss"),
    "roughness 0 to 255": (ROUGHNESS, lambda x: 255 * x, "range"),
    "coverage inverted": (COVERAGE, lambda x: 255 - x, "coverage-inverted"),
    "coverage 0 and 1": (COVERAGE, lambda x: x // 255, "coverage-values"),
    "coverage as a ramp": (COVERAGE, lambda x: x // 255 * np.arange(x.shape[1])[None, :, None], "coverage-values"),
    "coverage empty": (COVERAGE, lambda x: 0 * x, "coverage-empty"),
    "coverage of a quarter": (
        COVERAGE,
        lambda x: x * (np.arange(x.shape[1]) % 4 == 0)[None, :, None],
        "coverage-small",
    ),
    "coverage transposed": (COVERAGE, lambda x: x.swapaxes(0, 1), "transposed"),
}


def plant(maps: Path, fault: str, out: Path) -> tuple[str, str]:
    """Copy ``maps`` with one fault; returns the file and the id of the fault."""
    file, alter, expected = FAULTS[fault]
    shutil.copytree(maps, out)
    write(out / file, alter(read(maps / file)))
    return file, expected


@pytest.fixture(scope="session")
def capture(photographs: Path) -> Path:
    """A capture without its truth."""
    opened = unshade.Capture(photographs)
    VIEW[:] = opened.camera(opened.train[0])["camera_to_world"][:3, :3]
    return photographs


@pytest.mark.parametrize("fault", FAULTS)
def test_a_planted_fault_is_found_and_named(fault: str, tiny_run: Path, capture: Path, tmp_path: Path) -> None:
    file, expected = plant(tiny_run / "maps" / CASE / "oracle", fault, tmp_path / "maps")
    findings = unshade.check(tmp_path / "maps", capture=capture)
    found = [(finding["map"], finding["id"]) for finding in findings]
    assert (file, expected) in found, findings
    # What is planted in one map is not blamed on another; a size may be.
    assert {name for name, _ in found} == {file} or expected in ("sizes-differ", "not-square"), findings


@pytest.mark.parametrize("method", ["oracle", "quick", "mean_texture", "semantic_initialisation"])
def test_sound_maps_pass(method: str, tiny_run: Path, capture: Path, tmp_path: Path) -> None:
    maps = tiny_run / "maps" / CASE / method
    if not maps.exists():
        command("solve", capture, "--solver", method.replace("_", "-"), "-o", tmp_path / "maps")
        maps = tmp_path / "maps"
    assert unshade.check(maps, capture=capture) == []
    assert unshade.check(maps) == []


@pytest.mark.parametrize(
    "fault", ["coverage inverted", "normal negated", "normal in tangent space", "normal coded 0 to 1",
              "albedo 0 to 255", "specular 0 to 1", "roughness for alpha", "albedo with NaN"],
)  # fmt: skip
def test_some_faults_are_named_without_a_capture(fault: str, tiny_run: Path, tmp_path: Path) -> None:
    file, expected = plant(tiny_run / "maps" / CASE / "oracle", fault, tmp_path / "maps")
    assert (file, expected) in [(found["map"], found["id"]) for found in unshade.check(tmp_path / "maps")]


def test_maps_of_our_solver_are_not_reported_as_encoded(tiny_run: Path, capture: Path, tmp_path: Path) -> None:
    file, _ = plant(tiny_run / "maps" / CASE / "oracle", "specular sRGB-encoded", tmp_path / "maps")
    write(tmp_path / "maps" / ALBEDO, srgb(read(tmp_path / "maps" / ALBEDO)))
    (tmp_path / "maps" / "solve.json").write_text('{"solver": "unshade", "config": {}}')
    said = {found["map"]: found for found in unshade.check(tmp_path / "maps", capture=capture)}
    assert said[file]["id"] == "beyond-range" and "beyond 0.05" in said[file]["message"]
    assert "sRGB" not in str(said)


def test_empty_texels_tell_of_a_flip_without_a_capture(tiny_run: Path, tmp_path: Path) -> None:
    maps = tmp_path / "maps"
    shutil.copytree(tiny_run / "maps" / CASE / "oracle", maps)
    covered = np.zeros((128, 128, 1))
    covered[20:60, 30:100] = 255
    write(maps / COVERAGE, covered)
    write(maps / ALBEDO, (read(maps / ALBEDO) * (covered > 0))[::-1])
    assert (ALBEDO, "flipped-v") in [(found["map"], found["id"]) for found in unshade.check(maps)]


def test_uncovered_texels_may_hold_anything(tiny_run: Path, capture: Path, tmp_path: Path) -> None:
    maps = tmp_path / "maps"
    shutil.copytree(tiny_run / "maps" / CASE / "oracle", maps)
    outside = read(maps / COVERAGE)[..., 0] == 0
    for file, value in ((ALBEDO, np.nan), (NORMAL, 0), (SPECULAR, 1e9), (ROUGHNESS, -np.inf)):
        array = read(maps / file)
        array[outside] = value
        write(maps / file, array)
    assert unshade.check(maps, capture=capture) == []


def test_stray_files_are_named_with_what_they_should_be_called(tiny_run: Path, tmp_path: Path) -> None:
    maps = tmp_path / "maps"
    shutil.copytree(tiny_run / "maps" / CASE / "oracle", maps)
    (maps / ALBEDO).rename(maps / "Diffuse_Albedo.exr")
    (maps / NORMAL).rename(maps / "normals.png")
    shutil.copy(maps / SPECULAR, maps / "specular.exr")  # beside its map it harms nobody
    found = {(found["map"], found["id"]): found["fix"] for found in unshade.check(maps)}
    assert found == {
        ("Diffuse_Albedo.exr", "stray-file"): "rename it to diffuse_albedo.exr",
        ("normals.png", "stray-file"): "write it as linear float EXR named specular_normal.exr",
    }


def test_maps_far_smaller_than_the_pictures_are_named(tiny_run: Path, capture: Path, tmp_path: Path) -> None:
    maps = tmp_path / "maps"
    shutil.copytree(tiny_run / "maps" / CASE / "oracle", maps)
    for file in (ALBEDO, NORMAL, SPECULAR, ROUGHNESS, COVERAGE, "diffuse_normal.exr"):
        write(maps / file, read(maps / file)[4::8, 4::8])
    assert "small" in [found["id"] for found in unshade.check(maps, capture=capture)]


def test_check_prints_its_findings(tiny_run: Path, capture: Path, tmp_path: Path) -> None:
    sound = tiny_run / "maps" / CASE / "oracle"
    done = command("check", sound, "--capture", capture)
    assert done.stdout.strip() == f"{sound}: no faults found"
    assert "--capture also compares" in command("check", sound).stdout
    plant(sound, "albedo flipped in v", tmp_path / "maps")
    done = command("check", tmp_path / "maps", "--capture", capture, check=False)
    assert done.returncode == 1
    (line,) = done.stdout.splitlines()
    assert line.startswith("warning: diffuse_albedo.exr: is flipped in v: ") and line.endswith("[flipped-v]")
    (tmp_path / "empty").mkdir()
    done = command("check", tmp_path / "empty", check=False)
    assert done.returncode == 1 and "holds no map" in done.stdout
    (tmp_path / "broken").mkdir()
    (tmp_path / "broken" / ALBEDO).write_bytes(b"v/1\x01 and no more")
    done = command("check", tmp_path / "broken", check=False)
    assert done.returncode == 1 and "cannot be read" in done.stdout
    for arguments in ([tmp_path / "absent"], [sound, "--capture", tmp_path / "absent"]):
        done = command("check", *arguments, check=False)
        assert done.returncode == 2 and len(done.stderr.splitlines()) == 1, done.stderr
    with pytest.raises(unshade.errors.MapsError, match="is not a folder"):
        unshade.check(tmp_path / "absent")
    with pytest.raises(unshade.errors.CaptureError):
        unshade.check(sound, capture=tmp_path / "absent")


def test_scores_carry_the_findings_and_those_of_sound_maps_none(tiny_run: Path, tmp_path: Path) -> None:
    full, scores = tiny_run / "captures" / CASE, tmp_path / "scores.json"
    for path in (tiny_run / "scores" / CASE).glob("*.json"):
        assert "findings" not in json.loads(path.read_text()), path
    plant(tiny_run / "maps" / CASE / "oracle", "normal negated", tmp_path / "maps")
    done = command("score", full, tmp_path / "maps", "-o", scores)
    assert "warning: specular_normal.exr: is negated" in done.stderr
    (finding,) = json.loads(scores.read_text())["findings"]
    assert (finding["id"], finding["level"]) == ("negated", "warning")
    assert finding["evidence"]["cosine_as_it_is"] < -0.9 < 0.9 < finding["evidence"]["cosine_undone"]

"""Faults that maps most often have, planted one by one: each is found and named, and sound maps pass."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import mitsuba as mi
import numpy as np
import pytest
import unshade

from conftest import unshade as command

mi.set_variant("scalar_rgb")
CASE = "tiny-studio"
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


def turned(n: Array, degrees: float) -> Array:
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return n @ np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]])


def tangent(n: Array) -> Array:
    wave = np.random.default_rng(0).normal(0, 0.1, n.shape)
    return (wave + [0, 0, 1]) / np.linalg.norm(wave + [0, 0, 1], axis=-1, keepdims=True)


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
    "normal turned by 50 degrees": (NORMAL, lambda n: turned(n, 70), "turned-normals"),
    "normal of length 2": (NORMAL, lambda n: 2 * n, "not-unit"),
    "normal of length 0 here and there": (NORMAL, hole(0), "zero-length"),
    "normal of length 0": (NORMAL, lambda n: 0 * n, "zero-length"),
    "normal with NaN": (NORMAL, hole(np.nan), "not-finite"),
    "specular 0 to 1": (SPECULAR, lambda x: x / x.max(), "range-0-1"),
    "specular as level": (SPECULAR, lambda x: x / 0.08, "specular-level"),
    "specular 0 to 255": (SPECULAR, lambda x: 255 * x / 0.05, "coded-0-255"),
    "specular as index of refraction": (SPECULAR, lambda x: (1 + x**0.5) / (1 - x**0.5), "index-of-refraction"),
    "specular sRGB-encoded": (SPECULAR, srgb, "srgb-encoded"),
    "specular black": (SPECULAR, lambda x: 0 * x, "black"),
    "roughness for alpha": (ROUGHNESS, lambda x: np.dstack([np.sqrt(x[..., :2]), x[..., 2:]]), "perceptual-roughness"),
    "gloss for alpha": (ROUGHNESS, lambda x: np.dstack([1 - x[..., :2], x[..., 2:]]), "gloss"),
    "gloss for roughness": (ROUGHNESS, lambda x: np.dstack([1 - np.sqrt(x[..., :2]), x[..., 2:]]), "gloss"),
    "roughness 0 to 255": (ROUGHNESS, lambda x: 255 * x, "range"),
    "coverage inverted": (COVERAGE, lambda x: 255 - x, "coverage-inverted"),
    "coverage 0 and 1": (COVERAGE, lambda x: x // 255, "coverage-values"),
    "coverage as a ramp": (COVERAGE, lambda x: x // 255 * np.arange(x.shape[1])[None, :, None], "coverage-values"),
    "coverage empty": (COVERAGE, lambda x: 0 * x, "coverage-empty"),
    "coverage of a quarter": (COVERAGE, lambda x: x * (np.arange(x.shape[1]) % 4 == 0)[None, :, None], "coverage-small"),
    "coverage transposed": (COVERAGE, lambda x: x.swapaxes(0, 1), "transposed"),
}


def plant(maps: Path, fault: str, out: Path) -> tuple[str, str]:
    """Copy ``maps`` with one fault; returns the file and the id of the fault."""
    file, alter, expected = FAULTS[fault]
    shutil.copytree(maps, out)
    write(out / file, alter(read(maps / file)))
    return file, expected


@pytest.fixture(scope="session")
def capture(tiny_run: Path) -> Path:
    """A capture without its truth."""
    blind = tiny_run.parent / "blind"
    shutil.copytree(tiny_run / "captures" / CASE, blind, ignore=shutil.ignore_patterns("truth"))
    return blind


@pytest.mark.parametrize("fault", FAULTS)
def test_a_planted_fault_is_found_and_named(fault: str, tiny_run: Path, capture: Path, tmp_path: Path) -> None:
    file, expected = plant(tiny_run / "maps" / CASE / "oracle", fault, tmp_path / "maps")
    findings = unshade.check(tmp_path / "maps", capture=capture)
    found = [(finding["map"], finding["id"]) for finding in findings]
    assert (file, expected) in found, findings
    # What is planted in one map is not blamed on another; a size may be.
    assert {map for map, _ in found} == {file} or expected in ("sizes-differ", "not-square"), findings


@pytest.mark.parametrize("method", ["oracle", "fast", "mean_texture", "semantic_initialisation"])
def test_sound_maps_pass(method: str, tiny_run: Path, capture: Path, tmp_path: Path) -> None:
    maps = tiny_run / "maps" / CASE / method
    if not maps.exists():
        command("solve", capture, "--solver", method.replace("_", "-"), "-o", tmp_path / "maps")
        maps = tmp_path / "maps"
    assert unshade.check(maps, capture=capture) == []
    assert unshade.check(maps) == []

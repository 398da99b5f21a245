"""A capture of the procedural head, and its maps, for the tests of exported assets."""

from __future__ import annotations

import functools
import shutil
from pathlib import Path

import numpy as np
import pytest
import render_toy

from unshade.cycles import interpreter
from unshade.errors import RendererError
from unshade.exporting import fidelity
from unshade.exporting.assets import Options, export
from unshade.face.ita import Tone
from unshade.render import capture, llvm
from unshade.scene_file import parse_scene


def no_progress(done, total, what):
    pass


def no_warning(message):
    raise AssertionError(message)


def captured(folder: Path, samples: int = 16) -> Path:
    """A capture of the toy in ``folder/capture``; its truth is a maps folder."""
    out = folder / "capture"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(capture, "build_head", render_toy.toy_face)
        patch.setattr(capture, "face_ita", lambda maps, chart: Tone({}, 20.0, "tan"))
        choice = llvm.choose("llvm_ad_rgb")
        capture.synthesise(parse_scene(render_toy.toy_table(samples=samples), "toy", Path()), out, choice, no_progress)
    return out


def captured_once(factory: pytest.TempPathFactory) -> Path:
    """The capture that all tests of a process share; none changes it."""
    return _captured_in(factory.getbasetemp())


@functools.cache
def _captured_in(base: Path) -> Path:
    folder = base / "toy"
    folder.mkdir()
    return captured(folder)


def exported(capture: Path, out: Path, format: str, maps: Path | None = None, **options) -> list[dict]:
    """The rows of the fidelity of maps, or the truth's, as an asset."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(fidelity, "build_head", render_toy.toy_face)
        return export(
            maps or capture / "truth", out, capture, None, Options(format, **options), no_progress, no_warning
        )[0]


def needs_blender() -> None:
    """Skips, by name, where Blender is missing."""
    try:
        interpreter.command()
    except RendererError as missing:
        pytest.skip(str(missing))


def copied_maps(capture: Path, out: Path) -> Path:
    """The truth's maps without what else a truth has."""
    out.mkdir()
    for name in ("diffuse_albedo", "specular_albedo", "diffuse_normal", "specular_normal", "roughness"):
        shutil.copyfile(capture / "truth" / f"{name}.exr", out / f"{name}.exr")
    return out


def unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)

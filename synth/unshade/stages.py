"""The stages that the command line runs, from Python.

A stage calls ``progress(done, total, what)``, where it takes one, on the caller's thread. An exception that it raises
stops the stage and is raised here, as is Ctrl-C (``KeyboardInterrupt``); returning `unshade.STOP` stops it
too, and raises :class:`unshade.errors.Stopped`. Finished work is kept: the same call resumes there.
"""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Callable, Generator, Iterable, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Literal, TypedDict

import numpy as np
from numpy.typing import ArrayLike

from unshade import _native
from unshade._native import Capture

from .commands import Progress as _Progress
from .commands import command
from .documents import Document, as_file, toml_of
from .errors import ConfigError, ExportError, PictureError, SceneError
from .exr import write_exr
from .maps import Maps
from .own_metrics import OwnMetric, rows
from .scores import Scores

_Path = str | os.PathLike[str]


def synth(scene: Document, out: _Path, *, progress: _Progress | None = None) -> Capture:
    """Render a scene into the capture folder ``out``, truth included.

    ``scene`` is a scene file, the name of a scene that comes with unshade, or a dictionary of what such a file
    holds. Raises ``errors.SceneError``, `VariantError`, `RendererError` and `StorageError`.
    """
    with as_file(scene, "scene", SceneError) as file:
        command("synth", scene=file, out=out, progress=progress)
    return Capture(out)


def solve(
    capture: Capture | _Path,
    *,
    config: Document = "unshade",
    out: _Path | None = None,
    progress: Callable[[str, int, int, float], object] | None = None,
    backend: Literal["auto", "cpu", "gpu"] = "auto",
    given: Iterable[str] = (),
) -> Maps:
    """Recover maps from a capture or its folder.

    ``config`` is a preset's name, a TOML file, a dictionary of what such a file holds, or its text.
    ``progress(stage, iteration, total, loss)`` is called after every step. An exception that it raises stops the solve and is
    raised here, as is Ctrl-C; returning `unshade.STOP` stops it and returns the maps so far, whose ``interrupted``
    says where. With ``out`` the whole maps folder is written there, after `unshade.STOP` as well; the same call
    then resumes there, to the same bytes. ``backend`` is ``auto`` (a real GPU if there is one), ``cpu`` or ``gpu``.
    ``given`` names parts that are held at their truth, such as ``["light=truth"]``: a privileged solve, for studies.
    Raises ``errors.CaptureError``, `ConfigError`, `BackendError`, `SolveError`, `MapsError` and `StorageError`.
    """
    if isinstance(config, (str, os.PathLike)):
        text = os.fspath(config)
        is_text = "\n" in text or ("=" in text and not os.path.exists(text))
    else:
        text, is_text = toml_of(config, "config", ConfigError), True
    if not isinstance(capture, Capture):
        try:
            capture = Capture(os.fspath(capture))
        except TypeError:
            raise TypeError(f"capture: expected a Capture or a path, got {type(capture).__name__}") from None
    try:
        found = _native.solve(capture, text, is_text, out, progress, backend, list(given))
    except ConfigError as error:
        if isinstance(config, (str, os.PathLike)):
            raise
        raise ConfigError(f"the config (a dict): {error}") from None
    return Maps._of(*found)  # pyright: ignore[reportPrivateUsage]


def relight(
    capture: Capture | _Path,
    maps: Maps | _Path,
    out: _Path,
    *,
    light: ArrayLike | _Path | None = None,
    renderer: Literal["mitsuba", "cycles"] = "mitsuba",
    progress: _Progress | None = None,
) -> Path:
    """Render maps in the withheld views into the folder ``out``, as they are and after one factor.

    ``maps`` is a maps folder, or the maps themselves. Without ``light`` they are lit as the capture's lights. A
    ``light`` is a lat-long picture of linear radiance, an EXR or Radiance file or an array (rows, 2 rows, 3), and is
    called by the file's name or ``light``. The first row is up, +Y; the centre is +Z, in front of the face.
    ``cycles`` is Blender's path tracer, a second judge. Raises ``errors.CaptureError``, `MapsError`,
    `PictureError`, `VariantError`, `RendererError` and `StorageError`.
    """
    with _folder_of(maps) as folder, _light_file(light) as file:
        command(
            "relight", capture=_path_of(capture), maps=folder, out=out, renderer=renderer, light=file,
            progress=progress,
        )  # fmt: skip
    return Path(out)


@contextmanager
def _light_file(light: ArrayLike | _Path | None) -> Generator[_Path | None]:
    if light is None or isinstance(light, (str, os.PathLike)):
        yield light
        return
    array = _native.picture_array("light", light)
    rows, columns, *channels = array.shape
    if columns != 2 * rows or channels != [3]:
        raise PictureError(f"light: has shape {array.shape}, expected (rows, 2 rows, 3)")
    if not np.isfinite(array).all() or (array < 0).any():
        raise PictureError("light: holds a number that is not finite, or a negative one; fix the pixel")
    with tempfile.TemporaryDirectory(prefix="unshade-") as folder:
        path = Path(folder) / "light.exr"
        write_exr(path, array)
        yield path


class Fidelity(TypedDict):
    """The loss of an asset in one light: the asset as read from its files, beside the relit maps."""

    material: str
    """Which of the asset's materials, or what rendered it."""
    light: str
    view: str
    psnr_srgb: float | None
    """dB inside the mask; None where nothing differs."""
    psnr_noise: float | None
    """PSNR that noise alone would allow, dB; None where both pictures have the same noise."""
    diffuse_ratio: float | None
    """Mean of the asset's diffuse layer over that of the maps; None without light in it."""
    specular_ratio: float | None


def export(
    maps: Maps | _Path,
    out: _Path,
    *,
    format: Literal["gltf", "mitsuba", "blender", "materialx", "png"],
    capture: Capture | _Path | None = None,
    mesh: _Path | None = None,
    bits: Literal[8, 16] = 16,
    normal_y: Literal["plus", "minus"] = "plus",
    fidelity: bool = True,
    progress: _Progress | None = None,
) -> list[Fidelity]:
    """Write maps as an asset of another program into the folder ``out``; returns what it loses.

    The mesh is that of ``capture``, or the OBJ ``mesh``; with both, ``mesh`` is the same face with other UV, such as
    the one that was imported, and the maps are resampled onto it. ``bits`` are those of the normal maps, and of all
    maps of ``png``, whose green points where ``normal_y`` says. The list is also in ``fidelity.json``; it is
    empty without ``fidelity`` and for ``materialx`` and ``png``, which nothing here renders. Raises
    `ExportError`, `MapsError`, `CaptureError`, and `RendererError` where Blender is missing.
    """
    options = {"format": format, "bits": bits, "normal_y": normal_y, "no_fidelity": not fidelity}
    place = None if capture is None else _path_of(capture)
    with _folder_of(maps) as folder:
        found = command(
            "export", maps=folder, out=out, capture=place, mesh=mesh, **options, progress=progress, wrong=ExportError
        )
    fidelities: list[Fidelity] = found["fidelity"]
    return fidelities


def score(
    capture: Capture | _Path,
    maps: Maps | _Path,
    *,
    relit: _Path | None = None,
    lpips: Literal["alex", "vgg"] | None = None,
    metrics: Sequence[OwnMetric | str] = (),
) -> Scores:
    """Scores of maps (and of what ``relight`` made of them) against the truth.

    ``maps`` is a maps folder, or the maps themselves, which have no synthesis of the withheld views. ``lpips`` adds
    the rows of that network, which needs the extra ``lpips``. ``metrics`` adds yours, made by `unshade.metric`:
    objects, or names as a suite has them (``module:function``, ``file.py``). Raises ``errors.ScoreError``,
    `MapsError`, `CaptureError` and `MetricError`.
    """
    with _folder_of(maps) as folder:
        document: dict[str, Any] = json.loads(_native.score_json(_path_of(capture), folder, relit, lpips))
        if metrics:
            factor: float | None = document["scale"]["global"] if document["scale"] else None
            document["metrics"], own = rows(metrics, _path_of(capture), folder, relit, factor)
            document["rows"] += own
    return Scores(document)


class Budget(TypedDict):
    """A map's part of the error of a relit view."""

    map: str
    """``diffuse albedo``, ``specular albedo``, ``normals``, ``roughness``."""
    squared_error: float
    """Its Shapley value of the mean squared error of linear values, without noise; all sum to the error."""
    share: float | None
    """Share of the whole error; None where there is no error."""
    alone: float
    """The error of the view where this map alone is the method's."""
    gain_db: float
    """Gain in PSNR by the true map in its place, dB."""


def budget(
    capture: Capture | _Path,
    maps: Maps | _Path,
    out: _Path,
    *,
    light: str | None = None,
    view: str | None = None,
    progress: _Progress | None = None,
) -> list[Budget]:
    """Attribute the error of a relit view to each map, and write the result into the folder ``out``.

    The view is rendered with every choice of maps from the truth and from ``maps``, whose diffuse albedo is
    multiplied by its one factor. Without ``light`` it is lit as the capture, without ``view`` it is the first
    withheld one.
    """
    with _folder_of(maps) as folder:
        place = _path_of(capture)
        found = command("budget", capture=place, maps=folder, out=out, light=light, view=view, progress=progress)
    shares: list[Budget] = found["maps"]
    return shares


def run(
    suite: Document, out: _Path, *, redo: Sequence[str] = (), jobs: int = 1, progress: _Progress | None = None
) -> Path:
    """Run a suite in the folder ``out``, resuming it; returns its report's page.

    ``suite`` is a suite file, the name of one that comes with unshade, or a dictionary of what such a file holds.
    ``jobs`` stages run at once, each with its share of the processors. ``redo`` names methods whose maps are made
    anew. Raises ``errors.SceneError`` for a wrong suite, and `SolveError` at the end if a method failed; the others
    are scored all the same.

    ``progress`` counts the suite's stages; ``what`` is the progress of the current one.
    """
    with as_file(suite, "suite", SceneError) as file:
        command("run", suite=file, out=out, redo=list(redo), jobs=jobs, progress=progress)
    return Path(out) / "report" / "index.html"


class Finding(TypedDict):
    """A likely fault of one file of a maps folder, with the numbers behind it and the fix."""

    id: str
    level: str
    """``error`` if the maps cannot be scored, else ``warning``."""
    map: str
    message: str
    fix: str
    evidence: dict[str, float]


def check(maps: Maps | _Path, *, capture: Capture | _Path | None = None) -> list[Finding]:
    """Likely faults of maps (a folder, or `Maps`); empty for sound maps.

    With the capture, maps are also compared with its photographs, cameras and mesh; its ``truth/``
    is never opened.
    """
    with _folder_of(maps) as folder:
        findings: list[Finding] = command("check", maps=folder, capture=None if capture is None else _path_of(capture))
    for finding in findings:
        finding.setdefault("evidence", {})
    return findings


def report(run: _Path, out: _Path, *, progress: _Progress | None = None) -> Path:
    """Write the report of a run folder; returns its page."""
    command("report", run=run, out=out, progress=progress)
    return Path(out) / "index.html"


def compare(run: _Path, baseline: _Path, *, tolerances: _Path | None = None) -> bool:
    """True if no metric of ``run`` is worse than in ``baseline`` beyond its tolerance.


    Each is the folder of a run or its ``run.json``, a ``baseline.json``, or a file of scores; beside the last, only
    that method on that capture is compared. Raises ``errors.CompareError`` for anything else, or if the two share
    nothing.
    """
    passed: bool = command("compare", run=run, baseline=baseline, tolerances=tolerances)
    return passed


def _path_of(capture: Capture | _Path) -> _Path:
    return capture.path if isinstance(capture, Capture) else capture


@contextmanager
def _folder_of(maps: Maps | _Path) -> Generator[_Path]:
    """A folder with the maps; a temporary one goes when the stage is over."""
    if not isinstance(maps, Maps):
        yield maps
        return
    with tempfile.TemporaryDirectory(prefix="unshade-") as folder:
        # The folder's name is the solver's in scores.
        written = Path(folder) / "maps"
        maps.write(written)
        yield written

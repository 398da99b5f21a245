"""The stages that the command line runs, from Python.

``progress(done, total, what)``, where a stage takes it, hears how it goes, on the caller's thread.
What it raises stops the stage and is raised here, as is Ctrl-C (``KeyboardInterrupt``); returning
``False`` stops it too, and raises :class:`unshade.errors.Stopped`. What was finished is kept: the same
call goes on from there.
"""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Literal, TypedDict

from unshade import _native
from unshade._native import Capture, Maps

from .scores import Scores

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def synth(scene: _Path, out: _Path, *, progress: _Progress | None = None) -> Capture:
    """Render the scene file ``scene`` into the capture folder ``out``, truth included."""
    _native.synth(scene, out, progress)
    return Capture(out)


def relight(
    capture: Capture | _Path,
    maps: Maps | _Path,
    out: _Path,
    *,
    renderer: Literal["mitsuba", "cycles"] = "mitsuba",
    progress: _Progress | None = None,
) -> Path:
    """Render maps in the capture's lights into the folder ``out``, as they are and after one factor.

    ``maps`` is a maps folder, or the maps themselves. ``cycles`` is Blender's path tracer, a second judge.
    """
    with _folder_of(maps) as folder:
        return _native.relight(_path_of(capture), folder, out, progress, renderer)


class Fidelity(TypedDict):
    """Loss of an asset in one light: the asset as its files say it beside the relit maps."""

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

    The mesh is that of ``capture``, or the OBJ ``mesh``. ``bits`` are those of the normal maps, and of all
    maps of ``png``, whose green points where ``normal_y`` says. The list is also in ``fidelity.json``; it is
    empty without ``fidelity`` and for ``materialx`` and ``png``, which nothing here renders. Raises
    `ExportError`, `MapsError`, `CaptureError`, and `RendererError` where Blender is missing.
    """
    options = ["--format", format, "--bits", str(bits), "--normal-y", normal_y]
    options += [] if fidelity else ["--no-fidelity"]
    with _folder_of(maps) as folder:
        place = None if capture is None else _path_of(capture)
        said = json.loads(_native.export(folder, out, options, place, mesh, progress))
    rows: list[Fidelity] = said["fidelity"]
    return rows


def score(
    capture: Capture | _Path, maps: Maps | _Path, *, relit: _Path | None = None, lpips: str | None = None
) -> Scores:
    """Scores of maps (and of what ``relight`` made of them) against the truth.

    ``lpips`` (``alex`` or ``vgg``) adds the rows of that network, which needs the extra ``lpips``.

    ``maps`` is a maps folder, or the maps themselves, which have no synthesis of the withheld views.
    """
    with _folder_of(maps) as folder:
        return Scores(json.loads(_native.score_json(_path_of(capture), folder, relit, lpips)))


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
    """Say which map makes how much of the error of a relit view, and write it into the folder ``out``.

    The view is rendered with every choice of maps from the truth and from ``maps``, whose diffuse albedo is
    multiplied by its one factor. Without ``light`` it is lit as the capture, without ``view`` it is the first
    withheld one.
    """
    with _folder_of(maps) as folder:
        said = json.loads(_native.budget(_path_of(capture), folder, out, light, view, progress))
    rows: list[Budget] = said["maps"]
    return rows


def run(
    suite: _Path, out: _Path, *, redo: Sequence[str] = (), jobs: int = 1, progress: _Progress | None = None
) -> Path:
    """Run a suite in the folder ``out``, resuming it; returns its report's page.

    ``jobs`` stages are done at once, each with its share of the processors. ``redo`` names methods whose
    maps are made anew. Raises `SolveError` at the end if a method failed; the others are scored all the same.

    ``progress`` counts the suite's stages; ``what`` says how far the present one is.
    """
    return _native.run(suite, out, list(redo), progress, jobs)


class Finding(TypedDict):
    """A likely fault of one file of a maps folder, with the numbers that speak for it and the mend."""

    id: str
    level: str
    """``error`` if the maps cannot be scored, else ``warning``."""
    map: str
    message: str
    mend: str
    evidence: dict[str, float]


def check(maps: Maps | _Path, *, capture: Capture | _Path | None = None) -> list[Finding]:
    """Likely faults of maps (a folder, or `Maps`); empty for sound maps.

    With the capture, maps are also compared with its photographs, cameras and mesh; its ``truth/``
    is never opened.
    """
    with _folder_of(maps) as folder:
        text = _native.check_json(folder, None if capture is None else _path_of(capture))
    findings: list[Finding] = json.loads(text)
    for finding in findings:
        finding.setdefault("evidence", {})
    return findings


def report(run: _Path, out: _Path, *, progress: _Progress | None = None) -> Path:
    """Write the report of a run folder; returns its page."""
    _native.report(run, out, progress)
    return Path(out) / "index.html"


def compare(run: _Path, baseline: _Path, *, tolerances: _Path | None = None) -> bool:
    """True if no metric of ``run`` is worse than in ``baseline`` beyond its tolerance.

    Each is the folder of a run or its ``run.json``, a ``baseline.json``, or a file of scores; beside the last, only
    that method on that capture is compared. Raises `CompareError` for anything else, or if the two share nothing."""
    return _native.compare(run, baseline, tolerances)


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

"""Outputs of finished runs, and sealed suites: figures, tables, leaderboards, tolerances, rounds."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import Any, Literal

from . import _native
from .documents import Document, as_file
from .errors import SceneError
from .scene_file import read_table

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def figure(
    kind: str,
    *runs: _Path,
    out: _Path,
    methods: Sequence[str] = (),
    cases: Sequence[str] = (),
    progress: _Progress | None = None,
) -> Path:
    """Draw a figure of finished runs into the folder ``out``: PNG, PDF, LaTeX, CSV; returns the PNG.

    ``kind`` is one of ``unshade figure``: ``fig6``, ``fig8``, ``fig9``, ``fig10``, ``ablations``, ``robustness``,
    ``waterfall``, ``detail``, ``observability``. ``methods`` and ``cases`` choose by name; empty is the figure's
    usual choice. Raises ``errors.ReportError``; needs ``unshade[figures]``.
    """
    _native.figure(kind, list(runs), out, list(methods), list(cases), progress)
    return Path(out) / "figure.png"


def table(*runs: _Path, out: _Path) -> Path:
    """Write the results of finished runs as tables to the file ``out``. Raises ``errors.ReportError``."""
    _native.table(list(runs), out)
    return Path(out)


def site(*runs: _Path, out: _Path) -> Path:
    """Write finished runs as one leaderboard into the folder ``out``; returns its page.

    Raises ``errors.ReportError``.
    """
    return _native.site(list(runs), out)


def seal(
    suite: Document,
    out: _Path,
    *,
    seeds_from: _Path,
    round: str = "1",
    jobs: int = 1,
    progress: _Progress | None = None,
) -> str:
    """Render the captures of a suite with faces that a secret makes; returns the public key of the round.

    ``seeds_from`` is a file of 32 random bytes or more. ``out`` gets the folders ``public``, for others, and
    ``private``, with the truth. Another ``round`` has other faces. Raises ``errors.SceneError`` and
    `UnshadeError` for a secret that is too short.
    """
    with as_file(suite, "suite", SceneError) as file:
        return _native.seal(file, seeds_from, out, round, jobs, progress)


def score_submission(
    submission: _Path, private: _Path, out: _Path, *, seeds_from: _Path, progress: _Progress | None = None
) -> dict[str, str]:
    """Score a submission to a sealed suite and sign the scores in the folder ``out``; returns failed cases and why.

    ``private`` is the folder that `seal` wrote. Raises ``errors.UnshadeError`` for another secret than the round's.
    """
    return _native.score_submission(submission, private, seeds_from, out, progress)


def verify(folder: _Path, *, key: str | None = None) -> str:
    """Check the signature of scores that `score_submission` wrote; returns the public key that signed them.

    Raises ``errors.UnshadeError`` if the signature does not match, or is not by ``key``.
    """
    return _native.verify(folder, key)


def calibrate(
    out: _Path,
    *,
    suite: Document | None = None,
    runs: Sequence[_Path] = (),
    seeds: int = 8,
    vary: Literal["both", "method", "rounding"] = "both",
    keep: _Path | None = None,
    baseline: _Path | None = None,
    false_alarms: float = 0.01,
    rules: _Path | None = None,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """Measure how far scores move with the seeds, and write tolerances for `compare` to the file ``out``.

    Give a ``suite``, which is run with ``seeds`` different seeds in the folder ``keep`` (beside ``out`` without it),
    or finished ``runs`` of one suite. ``vary`` says whose seeds: those of the renderer and the methods, of the
    methods alone, or none (``rounding``). ``baseline`` also gets the mean of the runs; ``rules`` is a tolerances
    file. Returns the tolerances as they are written. Raises ``errors.CompareError``, `SceneError` and, if a method
    failed, `SolveError`; ValueError for numbers out of range.
    """
    if (suite is None) == (not runs):
        raise ValueError("give either a suite or runs")
    with nullcontext() if suite is None else as_file(suite, "suite", SceneError) as file:
        _native.calibrate(
            out, file, list(runs), seeds, vary, keep, baseline, false_alarms, rules, progress
        )  # fmt: skip
    return read_table(Path(out))

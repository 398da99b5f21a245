"""Outputs of finished runs, and sealed suites: figures, tables, leaderboards, tolerances, rounds."""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import Any, Literal

from .commands import Progress as _Progress
from .commands import command
from .documents import Document, as_file
from .errors import ReportError, SceneError
from .scene_file import read_table

_Path = str | os.PathLike[str]


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
    chosen = {"method": list(methods), "case": list(cases)}
    command("figure", kind=kind, runs=runs, out=out, **chosen, progress=progress, wrong=ReportError)
    return Path(out) / "figure.png"


def table(*runs: _Path, out: _Path) -> Path:
    """Write the results of finished runs as tables to the file ``out``. Raises ``errors.ReportError``."""
    command("table", runs=runs, out=out)
    return Path(out)


def site(*runs: _Path, out: _Path) -> Path:
    """Write finished runs as one leaderboard into the folder ``out``; returns its page.

    Raises ``errors.ReportError``.
    """
    command("site", runs=runs, out=out)
    return Path(out) / "index.html"


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
        public_key: str = command(
            "seal", suite=file, seeds_from=seeds_from, out=out, round=round, jobs=jobs, progress=progress
        )
    return public_key


def score_submission(
    submission: _Path, private: _Path, out: _Path, *, seeds_from: _Path, progress: _Progress | None = None
) -> dict[str, str]:
    """Score a submission to a sealed suite and sign the scores in the folder ``out``; returns failed cases and why.

    ``private`` is the folder that `seal` wrote. Raises ``errors.UnshadeError`` for another secret than the round's.
    """
    failed: dict[str, str] = command(
        "seal", score=submission, private=private, out=out, seeds_from=seeds_from, round="", jobs=1, progress=progress
    )
    return failed


def verify(folder: _Path, *, key: str | None = None) -> str:
    """Check the signature of scores that `score_submission` wrote; returns the public key that signed them.

    Raises ``errors.UnshadeError`` if the signature does not match, or is not by ``key``.
    """
    public_key: str = command("verify", folder=folder, key=key)
    return public_key


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
        command(
            "calibrate", out=out, suite=file, runs=runs, seeds=seeds, vary=vary, keep=keep, baseline=baseline,
            false_alarms=false_alarms, rules=rules, progress=progress,
        )  # fmt: skip
    return read_table(Path(out))

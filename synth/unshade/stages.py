"""The stages that the command line runs, from Python."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

from unshade import errors
from unshade._native import Capture, score_json, write_report

_Path = str | os.PathLike[str]


def _command(*arguments: object) -> subprocess.CompletedProcess[str]:
    """Run the command line in a process of its own: a renderer that dies takes nobody along."""
    command = [sys.executable, "-m", "unshade", *map(os.fspath, map(str, arguments))]
    done = subprocess.run(command, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    if done.returncode in (0, 1):
        return done
    said = done.stderr.strip().splitlines()
    raise errors.UnshadeError(said[-1].removeprefix("unshade: ") if said else "no message")


def synth(scene: _Path, out: _Path) -> Capture:
    """Render the scene file ``scene`` into the capture folder ``out``, truth included."""
    _command("synth", scene, "-o", out)
    return Capture(out)


def relight(capture: _Path, maps: _Path, out: _Path) -> Path:
    """Render the maps folder in the capture's lights into ``out``."""
    _command("relight", capture, maps, "-o", out)
    return Path(out)


def score(capture: _Path, maps: _Path, *, relit: _Path | None = None) -> dict[str, Any]:
    """Scores of a maps folder (and of what ``relight`` made of it) against the truth."""
    return json.loads(score_json(Path(capture), Path(maps), relit and Path(relit)))


def run(suite: _Path, out: _Path) -> Path:
    """Run a suite in the folder ``out``, resuming it; returns its report."""
    _command("run", suite, "-o", out)
    return Path(out) / "report" / "index.html"


def report(run: _Path, out: _Path) -> Path:
    """Write the report of a run folder; returns its page."""
    write_report(Path(run), Path(out))
    return Path(out) / "index.html"


def compare(run: _Path, baseline: _Path, *, junit: _Path | None = None) -> bool:
    """True if no metric of ``run`` is worse than in ``baseline`` beyond its tolerance."""
    extra = [] if junit is None else ["--junit", junit]
    return _command("compare", run, baseline, *extra).returncode == 0

"""The stages that the command line runs, from Python."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

from unshade import _native
from unshade._native import Capture

_Path = str | os.PathLike[str]


def synth(scene: _Path, out: _Path) -> Capture:
    """Render the scene file ``scene`` into the capture folder ``out``, truth included."""
    _native.synth(scene, out)
    return Capture(out)


def relight(capture: _Path, maps: _Path, out: _Path) -> Path:
    """Render the maps folder in the capture's lights into ``out``, as it is and after one factor."""
    return _native.relight(capture, maps, out)


def score(capture: _Path, maps: _Path, *, relit: _Path | None = None) -> dict[str, Any]:
    """Scores of a maps folder (and of what ``relight`` made of it) against the truth."""
    return json.loads(_native.score_json(capture, maps, relit))


def run(suite: _Path, out: _Path) -> Path:
    """Run a suite in the folder ``out``, resuming it; returns its report's page."""
    return _native.run(suite, out)


def report(run: _Path, out: _Path) -> Path:
    """Write the report of a run folder; returns its page."""
    _native.write_report(run, out)
    return Path(out) / "index.html"


def compare(run: _Path, baseline: _Path, *, tolerances: _Path | None = None) -> bool:
    """True if no metric of ``run`` is worse than in ``baseline`` beyond its tolerance."""
    return _native.compare(run, baseline, tolerances)

"""The stages that the command line runs, from Python."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any, TypedDict

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


class Finding(TypedDict):
    """What is likely wrong with one file of a maps folder."""

    id: str
    level: str
    """``error`` if the maps cannot be scored, else ``warning``."""
    map: str
    message: str
    mend: str
    evidence: dict[str, float]


def check(maps: _Path, *, capture: _Path | None = None) -> list[Finding]:
    """What is likely wrong with a maps folder; empty for sound maps.

    With the capture, maps are also compared with its photographs, cameras and mesh; its ``truth/``
    is never opened.
    """
    return [{**finding, "evidence": finding.get("evidence", {})} for finding in json.loads(_native.check_json(maps, capture))]


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

"""A tiny run of everything, made once for all tests from the outside; what tests start from instead of running anew."""

from __future__ import annotations

import fcntl
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import unshade as package

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

HERE = Path(__file__).parent
CASE = "tiny-studio"
"""The one case of the tiny suite."""
TINY = HERE / "scenes" / "tiny.toml"
QUICK: dict[str, Any] = {"base": "fast", **tomllib.loads(TINY.read_text())["method"][0]["set"]}
"""The configuration of the tiny suite's method `quick`, a solve of a second."""


def unshade(*arguments: object, check: bool = True) -> subprocess.CompletedProcess[str]:
    """Run the installed command as a user would."""
    command = [Path(sys.executable).with_name("unshade"), *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, env=dict(os.environ))
    if check and done.returncode != 0:
        pytest.fail(f"unshade {arguments}: exit code {done.returncode}\n{done.stderr}")
    return done


def made_once(factory: pytest.TempPathFactory, name: str, make: Callable[[Path], object]) -> Path:
    """The folder ``name`` that ``make`` fills once for all processes of a test session; tests only read it."""
    base = factory.getbasetemp()
    shared = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base
    folder, finished = shared / name, shared / f"{name}.finished"
    with (shared / f"{name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not finished.exists():
            make(folder)
            finished.touch()
    return folder


@pytest.fixture(scope="session")
def tiny_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a finished run of ``tests/scenes/tiny.toml``; a test that changes it takes a copy."""
    return made_once(tmp_path_factory, "tiny", lambda folder: unshade("run", TINY, "-o", folder))


@pytest.fixture(scope="session")
def photographs(tiny_run: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The tiny capture without its truth, as photographs are; a test that changes it takes a copy."""
    source, ignored = tiny_run / "captures" / CASE, shutil.ignore_patterns("truth")
    return made_once(tmp_path_factory, "photographs", lambda folder: shutil.copytree(source, folder, ignore=ignored))


def rows(run: Path, method: str) -> dict[str, package.Score]:
    """The rows of a method's scores in a run of the tiny suite, by their ids; those of labels are left out."""
    scores = package.Scores.read(run / "scores" / CASE / f"{method}.json")
    return {row.id: row for row in scores if row.label is None}


def copy_without(run: Path, folder: Path, *lacking: str) -> Path:
    """Copies a run of the tiny suite without its ``capture`` or without all that the named methods left."""
    patterns = [text.format(name) for name in lacking for text in ("{}", "{}.json", "*.{}.json", "{}.*.json")]
    shutil.copytree(run, folder, ignore=shutil.ignore_patterns(*patterns))
    if "capture" in lacking:
        shutil.rmtree(folder / "captures")
    return folder

"""A tiny run of everything, made once for all tests from the outside."""

from __future__ import annotations

import fcntl
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

HERE = Path(__file__).parent
TINY = HERE / "scenes" / "tiny.toml"


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

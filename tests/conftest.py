"""A tiny run of everything, made once for all tests from the outside."""

from __future__ import annotations

import os
import subprocess
import sys
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


@pytest.fixture(scope="session")
def tiny_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a finished run of ``tests/scenes/tiny.toml``."""
    run = tmp_path_factory.mktemp("runs") / "tiny"
    unshade("run", TINY, "-o", run)
    return run

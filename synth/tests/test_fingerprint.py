"""Which changes of the sources make kept renderings stale."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import unshade

SOURCES = Path(unshade.__file__).parent


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A copy of the Python sources; the compiled module is the same."""
    copy = tmp_path / "unshade"
    for path in [*SOURCES.rglob("*.py"), *SOURCES.glob("_native.*.so")]:
        target = copy / path.relative_to(SOURCES)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(path.read_bytes()) if path.suffix == ".py" else target.symlink_to(path)
    return copy


def fingerprint(package: Path) -> str:
    place = os.environ | {"PYTHONPATH": str(package.parent)}
    return subprocess.run(
        [sys.executable, "-m", "unshade.fingerprint"], env=place, text=True, capture_output=True, check=True
    ).stdout


@pytest.mark.parametrize(("changed", "stale"), [("render/capture.py", True), ("figures/plots.py", False)])
def test_a_change_that_makes_other_pictures_is_seen(package: Path, changed: str, stale: bool) -> None:
    before = fingerprint(package)
    with (package / changed).open("a") as file:
        file.write("# changed\n")
    assert (fingerprint(package) != before) is stale


def test_the_stage_that_draws_figures_alone_imports_them() -> None:
    importing = {
        path.relative_to(SOURCES).as_posix()
        for path in SOURCES.rglob("*.py")
        if path.parent.name != "figures" and re.search(r"^\s*(from|import) .*figures", path.read_text(), re.MULTILINE)
    }
    assert importing == {"stage.py"}

"""Solves that hold parts at their truth: privileged, and marked as such."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import unshade as package
from conftest import CASE, QUICK, TINY, unshade
from unshade.errors import CaptureError, SolveError


def test_known_normals_are_in_the_maps_and_the_solve_is_marked(tiny_run: Path, tmp_path: Path):
    capture, out = tiny_run / "captures" / CASE, tmp_path / "maps"
    maps = package.solve(capture, config=QUICK, out=out, given=["normals=truth", "light=truth"])
    assert json.loads((out / "solve.json").read_text())["given"] == ["light", "normals"]
    truth = package.Capture(capture).truth()
    size = maps.specular_normal.shape[0]
    true, mesh = truth.resize(size), package.solve(capture, config=QUICK)
    seen = (maps.coverage > 0) & (true.coverage > 0)

    def error(found: package.Maps) -> float:
        cosine = np.sum(found.specular_normal * true.specular_normal, -1)[seen]
        return float(np.degrees(np.arccos(cosine.clip(-1, 1))).mean())

    assert error(maps) < 0.4 * error(mesh)


def test_an_ordinary_solve_is_given_nothing(tiny_run: Path):
    record = json.loads((tiny_run / "maps" / CASE / "quick" / "solve.json").read_text())
    assert record["given"] == []


def test_what_cannot_be_given_is_refused_in_one_line(tiny_run: Path, photographs: Path, tmp_path: Path):
    capture, out = tiny_run / "captures" / CASE, tmp_path / "maps"
    done = unshade("solve", capture, "-o", out, "--given", "albedo=truth", check=False)
    assert done.returncode == 2 and "light=truth" in done.stderr
    done = unshade("solve", capture, "-o", out, "--given", "light=truth", "--config", "paper", check=False)
    assert done.returncode == 2 and done.stderr.splitlines()[-1].startswith("unshade: only `unshade`")
    with pytest.raises(SolveError, match="cannot give `light`"):
        package.solve(capture, config=QUICK, given=["light"])
    with pytest.raises(CaptureError, match="no truth to give"):
        package.solve(photographs, config=QUICK, given=["light=truth"])
    assert not out.exists()


def test_a_suite_has_no_key_for_it(tmp_path: Path):
    suite = tmp_path / "suite.toml"
    text = TINY.read_text().replace('name = "quick"', 'name = "quick"\ngiven = ["light=truth"]', 1)
    assert "given" in text
    suite.write_text(text.replace('scene = "', f'scene = "{TINY.parent}/'))
    done = unshade("run", suite, "-o", tmp_path / "run", "--dry-run", check=False)
    assert done.returncode == 2 and "given" in done.stderr

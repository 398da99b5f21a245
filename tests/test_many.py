"""Runs of several stages at once, what is said beforehand of a run, and what is removed after it."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from test_run import digest

from conftest import CASE, HERE, TINY, copy_without, unshade
from unshade.files.pictures import write_exr


@pytest.fixture(scope="module")
def wide(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A suite of two lights with a method that fails."""
    suite = tmp_path_factory.mktemp("wide") / "wide.toml"
    scene, lights = HERE / "scenes" / "tiny-scene.toml", HERE.parent / "scenes" / "lights"
    program = suite.with_name("picky.py")
    program.write_text(
        "import pathlib, sys\n"
        "views = list(pathlib.Path(sys.argv[1], 'images').glob('*.exr'))\n"
        "raise SystemExit(f'no light for {len(views)} views')\n"
    )
    suite.write_text(
        f'format = 1\nname = "wide"\nscene = "{scene}"\nscales = ["global"]\n'
        f'lights = ["{lights}/studio.toml", "{lights}/uniform.toml"]\n'
        '[[method]]\nname = "mean_texture"\ntexture_size = 64\n'
        f'[[method]]\nname = "picky"\ncommand = ["{sys.executable}", "picky.py", "{{capture}}", "{{maps}}"]\n'
    )
    return suite


def test_three_jobs_give_identical_bytes(tiny_run: Path, tmp_path: Path) -> None:
    run = copy_without(tiny_run, tmp_path / "run", "quick", "mean_texture")
    said = unshade("run", TINY, "-o", run, "--jobs", 3).stderr
    assert "6 stages run, 4 still valid" in said
    assert digest(run) == digest(tiny_run)
    stages = [line["id"] for line in json.loads((tmp_path / "run" / "timing.json").read_text())["stages"]]
    known = [line["id"] for line in json.loads((tiny_run / "timing.json").read_text())["stages"]]
    assert stages == known, "times stand in the order of the plan"


def test_failing_method_does_not_block_other_jobs(wide: Path, tiny_run: Path, tmp_path: Path) -> None:
    """On a run that is still valid but for the scores."""
    run = shutil.copytree(tiny_run, tmp_path / "run")
    (run / "scores" / CASE / "mean_texture.json").unlink()
    suite = wide.with_name("narrow.toml")
    lines = wide.read_text().splitlines(True)
    suite.write_text("".join(line for line in lines if not line.startswith(("lights", "scales", "texture_size"))))
    done = unshade("run", suite, "-o", run, "--jobs", 2, check=False)
    assert done.returncode == 1, done.stderr
    assert f"relit/{CASE}/mean_texture: still valid" in done.stderr and "1 stages run" in done.stderr
    assert f"maps/{CASE}/picky: failed: " in done.stderr and "no light for 4 views" in done.stderr
    solvers = json.loads((run / "run.json").read_text())["cases"][0]["solvers"]
    assert [("scores" in solver, "failed" in solver) for solver in solvers] == [(True, False), (False, True)]
    assert (run / "scores" / CASE / "mean_texture.json").is_file() and not (
        run / "scores" / CASE / "picky.json"
    ).exists()


def test_interrupt_ends_all_jobs(wide: Path, tmp_path: Path) -> None:
    command = [Path(sys.executable).with_name("unshade"), "run", wide, "-o", tmp_path / "run", "--jobs", 2]
    process = subprocess.Popen([*map(str, command)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    while len(list((tmp_path / "run" / "captures").glob("*.partial"))) < 2 and process.poll() is None:
        time.sleep(0.1)
    os.kill(process.pid, signal.SIGINT)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 3 and "run the same command to resume" in said, said


def _table(said: str) -> dict[str, tuple[int, int]]:
    """Cached and to do, by kind."""
    found = re.findall(r"^(capture|maps|relit|scores) +(\d+) +(\d+)", said, re.MULTILINE)
    return {kind: (int(cached), int(pending)) for kind, cached, pending in found}


def test_dry_run_counts_cached_stages_and_writes_nothing(tiny_run: Path, tmp_path: Path) -> None:
    run = shutil.copytree(tiny_run, tmp_path / "run")
    assert _table(unshade("run", TINY, "-o", run, "--dry-run").stdout)["capture"] == (1, 0)
    shutil.rmtree(run / "maps" / CASE / "quick")
    before = digest(run)
    said = unshade("run", TINY, "-o", run, "--dry-run").stdout
    # What is made from maps that are not there is to be made too.
    assert _table(said) == {"capture": (1, 0), "maps": (2, 1), "relit": (2, 1), "scores": (2, 1)}
    assert digest(run) == before
    said = unshade("run", TINY, "-o", tmp_path / "new", "--dry-run").stdout
    assert "no timings yet" in said and not (tmp_path / "new").exists()
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.tex").write_text("years")
    done = unshade("run", TINY, "-o", tmp_path / "mine", "--dry-run", check=False)
    assert done.returncode == 2 and "mine" in done.stderr


def test_environment_maps_are_found_in_the_users_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "hall.toml").write_text('name = "hall"\nkind = "envmap"\npath = "hall.exr"\n')
    light = f'name = "halls"\nlights = ["{tmp_path}/hall.toml"]\nscene = "{TINY.parent}/tiny-scene.toml"'
    suite = TINY.read_text().replace('name = "tiny"\nscene = "tiny-scene.toml"', light)
    (tmp_path / "suite.toml").write_text(suite)
    missing = unshade("run", tmp_path / "suite.toml", "-o", tmp_path / "run", "--dry-run", check=False)
    assert missing.returncode == 2 and f"{tmp_path}/hall.exr" in missing.stderr
    pictures = tmp_path / "pictures"
    pictures.mkdir()
    write_exr(pictures / "hall.exr", {"": np.ones((8, 16, 3), np.float32)})
    monkeypatch.setenv("UNSHADE_LIGHTS", str(pictures))
    unshade("run", tmp_path / "suite.toml", "-o", tmp_path / "run", "--dry-run")


def test_dry_run_estimates_time_and_disk_from_earlier_runs(tiny_run: Path, wide: Path, tmp_path: Path) -> None:
    """Other lights, the same sizes: each capture takes what one took, and the bytes come out within a fifth."""
    known = tmp_path / "known"
    known.mkdir()
    measured = json.loads((tiny_run / "timing.json").read_text())
    next(stage for stage in measured["stages"] if stage["id"] == f"capture/{CASE}")["seconds"] = 21.0
    (known / "timing.json").write_text(json.dumps(measured))
    said = unshade("run", wide, "-o", tmp_path / "run", "--dry-run", "--costs", known, "--jobs", 2).stdout
    assert re.search(r"^capture +0 +2 +42 s ", said, re.MULTILINE), said
    assert "with --jobs 2" in said
    disc = re.search(r"^capture .* ([\d.]+) MB$", said, re.MULTILINE)
    assert disc is not None
    real = sum(path.stat().st_size for path in (tiny_run / "captures" / CASE).rglob("*") if path.is_file())
    assert float(disc[1]) * 1e6 == pytest.approx(2 * real, rel=0.2)


def test_manifest_holds_the_bytes_of_each_kind(tiny_run: Path) -> None:
    said = json.loads((tiny_run / "run.json").read_text())["bytes"]
    assert list(said) == ["captures", "maps", "relit", "scores"]
    for kind, size in said.items():
        files = [
            path
            for path in (tiny_run / kind).rglob("*")
            if path.is_file() and path.name not in ("timing.json", ".unshade")
        ]
        scenes = [path for path in files if path.parent.name == "captures"]
        assert size == sum(path.stat().st_size for path in files) - sum(path.stat().st_size for path in scenes), kind


def test_clean_removes_reproducible_outputs_only(tiny_run: Path, tmp_path: Path) -> None:
    run = shutil.copytree(tiny_run, tmp_path / "run")
    (run / "maps" / CASE / "oracle" / "notes.txt").write_text("mine")
    (run / "captures" / "thesis").mkdir()
    (run / "captures" / "thesis" / "a.tex").write_text("years")
    (run / "store" / "keys").mkdir(parents=True)
    (run / "store" / "keys" / f"{'a' * 64}.json").write_text("{}")
    before = digest(run)
    assert "kept" in unshade("clean", run).stdout and digest(run) == before
    done = unshade("clean", run, "--keep", "scores,report")
    assert "unshade did not write all files" in done.stderr and "thesis" in done.stderr and "oracle" in done.stderr
    assert (run / "captures" / "thesis" / "a.tex").read_text() == "years"
    assert (run / "maps" / CASE / "oracle" / "notes.txt").read_text() == "mine"
    assert (run / "report" / "index.html").is_file() and not (run / "relit").exists()
    assert not (run / "store").exists()
    left = sorted(path.name for path in (run / "maps" / CASE).iterdir())
    assert left == ["oracle"] and not (run / "captures" / CASE).exists()
    # The scores still serve.
    unshade("compare", run, run / "report" / "baseline.json")
    unshade("site", run, "-o", tmp_path / "site")


def test_clean_refuses_unknown_kinds_and_other_folders(tiny_run: Path, tmp_path: Path) -> None:
    bad = unshade("clean", tiny_run, "--keep", "scores,photos", check=False)
    assert bad.returncode == 2 and '"photos"' in bad.stderr and "captures, lights" in bad.stderr
    bad = unshade("clean", tmp_path, "--keep", "scores", check=False)
    assert bad.returncode == 2 and "is not a run's folder" in bad.stderr

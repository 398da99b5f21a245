"""The whole job from the outside: one face, rendered, solved, relit, scored, shown."""

from __future__ import annotations

import hashlib
import json
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import unshade as package
from conftest import CASE, QUICK, TINY, copy_without, rows, unshade

# Wall times are the one thing in which two runs may differ; the report shows them.
NOT_CONTENT = {"timing.json", ".lock"}


def digest(run: Path) -> dict[str, str]:
    """Path to hash of every file of a run that must not depend on how it was run."""
    files = (path for path in sorted(run.rglob("*")) if path.is_file())
    return {
        str(path.relative_to(run)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in files
        if path.name not in NOT_CONTENT and "report" not in path.relative_to(run).parts
    }


def test_the_oracle_scores_at_the_noise_floor(tiny_run: Path) -> None:
    """True maps in: the relit pictures differ from the truth by rendering noise alone."""
    relit = {
        name: row
        for name, row in rows(tiny_run, "oracle").items()
        if name.startswith("relit/") and "/psnr_lin@" in name and name.endswith(":none")
    }
    assert {name.split("/")[1] for name in relit} == {"studio", "uniform"}
    for name, row in relit.items():
        # The floor is itself estimated from four passes a picture.
        assert abs(row.value - row.floor) < 1.0, (name, row.value, row.floor)


def test_the_oracle_maps_are_exact(tiny_run: Path) -> None:
    oracle = rows(tiny_run, "oracle")
    assert oracle["specular_normal/normal_mean_deg@coverage-e5:none"].value < 0.05
    assert oracle["specular_albedo/rmse@coverage-e5:none"].value < 1e-6


def test_the_solver_beats_the_mean_texture(tiny_run: Path) -> None:
    """Even a few iterations take the baked shading out of the albedo."""
    key = "diffuse_albedo/psnr_srgb@coverage-e5:global"
    assert rows(tiny_run, "quick")[key].value > rows(tiny_run, "mean_texture")[key].value + 2


def test_the_solver_never_opens_the_truth(tiny_run: Path, tmp_path: Path) -> None:
    """Maps from a capture without its truth and without the withheld pictures are the same."""
    blind = tmp_path / "capture"
    shutil.copytree(tiny_run / "captures" / CASE, blind)
    shutil.rmtree(blind / "truth")
    for frame in json.loads((blind / "transforms.json").read_text())["test_filenames"]:
        (blind / frame).unlink()
    package.solve(blind, config=QUICK, out=tmp_path / "maps")
    for name in ("diffuse_albedo.exr", "specular_normal.exr"):
        assert (tmp_path / "maps" / name).read_bytes() == (tiny_run / "maps" / CASE / "quick" / name).read_bytes()


def test_a_wrong_configuration_is_named_by_its_file(tmp_path: Path) -> None:
    config = tmp_path / "mine.toml"
    config.write_text('base = "fast"\n[transport]\nrows = 1')
    failed = unshade("solve", tmp_path, "-o", tmp_path / "maps", "--config", config, check=False)
    assert failed.returncode != 0
    assert f"{config}: configuration: transport.rows is 1, but must be 2 to 64" in failed.stderr, failed.stderr
    assert not (tmp_path / "maps").exists()


def test_a_second_run_does_nothing(tiny_run: Path, tmp_path: Path) -> None:
    run = shutil.copytree(tiny_run, tmp_path / "run")
    said = unshade("run", TINY, "-o", run).stderr
    assert "0 stages run" in said, said
    assert digest(run) == digest(tiny_run)


def started(run: Path) -> subprocess.Popen[str]:
    command = [Path(sys.executable).with_name("unshade"), "run", TINY, "-o", run]
    return subprocess.Popen(list(map(str, command)), stderr=subprocess.PIPE, text=True)


def test_resume_after_kill_gives_identical_bytes(tiny_run: Path, tmp_path: Path) -> None:
    """Killed while it renders, and as soon as its first maps and its first scores are there; the baselines of an
    earlier run stay valid."""
    run = copy_without(tiny_run, tmp_path / "run", "capture", "quick")
    with started(run) as process:
        while not list((run / "captures").rglob("*.partial")) and process.poll() is None:
            time.sleep(0.05)
        process.kill()
    for stage in ("maps/", "scores/"):
        with started(run) as process:
            assert process.stderr is not None
            assert any(line.startswith(stage) for line in process.stderr)
            process.kill()
    unshade("run", TINY, "-o", run)
    assert digest(run) == digest(tiny_run)
    assert not list(run.rglob("*.partial"))


@pytest.mark.heavy
def test_resume_after_random_kills_gives_identical_bytes(tiny_run: Path, tmp_path: Path) -> None:
    """A run that comes to its end first is begun anew."""
    run, random = tmp_path / "run", np.random.default_rng(0)
    seconds = sum(stage["seconds"] for stage in json.loads((tiny_run / "timing.json").read_text())["stages"])
    for _ in range(12):
        with started(run) as process:
            try:
                process.communicate(timeout=random.uniform(0, seconds))
            except subprocess.TimeoutExpired:
                process.kill()
                continue
        assert digest(run) == digest(tiny_run)
        shutil.rmtree(run)
    unshade("run", TINY, "-o", run)
    assert digest(run) == digest(tiny_run) and not list(run.rglob("*.partial"))


def test_the_report_opens_offline(tiny_run: Path) -> None:
    page = (tiny_run / "report" / "index.html").read_text()
    # Links that a reader may follow are fine; nothing is loaded from elsewhere.
    assert not re.findall(r"""(?:src=|<link[^>]*href=|url\()["']?(?:https?:)?//""", page)
    for name in re.findall(r'src="([^"]+)"', page):
        assert (tiny_run / "report" / name).is_file(), name


def test_compare_is_red_on_a_worse_albedo_and_green_on_no_change(tiny_run: Path, tmp_path: Path) -> None:
    baseline = tiny_run / "report" / "baseline.json"
    junit = tmp_path / "junit.xml"
    same = unshade("compare", tiny_run, baseline, "--junit", junit, check=False)
    assert same.returncode == 0, same.stdout + same.stderr
    assert "<failure" not in junit.read_text()

    worse = tmp_path / "worse"
    shutil.copytree(tiny_run, worse)
    capture, maps = worse / "captures" / CASE, worse / "maps" / CASE / "quick"
    _worsen_albedo(capture, maps)
    scores = worse / "scores" / CASE / "quick.json"
    unshade("score", capture, maps, "--relit", worse / "relit" / CASE / "quick", "-o", scores)
    red = unshade("compare", worse, baseline, "--junit", junit, check=False)
    assert red.returncode == 1, red.stdout + red.stderr
    assert "<failure" in junit.read_text()


def _worsen_albedo(capture: Path, maps_folder: Path) -> None:
    """Make the aligned error of the diffuse albedo 2 % larger."""
    truth = package.Capture(capture).truth().diffuse_albedo
    maps = package.Maps.read(maps_folder)
    albedo = maps.diffuse_albedo
    nearest = (np.arange(len(albedo)) * len(truth)) // len(albedo)
    truth = truth[nearest][:, nearest]
    aligned = truth * ((albedo * truth).sum() / (truth * truth).sum())
    maps.diffuse_albedo = albedo + 0.02 * (albedo - aligned)
    maps.write(maps_folder)


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["run", "no-such.toml", "-o", "x"], "no-such.toml: cannot be read"),
        (["solve", "no-such-capture", "-o", "x"], "no-such-capture"),
        (["solve", "x", "-o", "x", "--solver", "oracle", "--rerun"], "a baseline has no steps to show"),
        (["compare", "no-such-run", "no.json"], "no"),
        (["frobnicate"], "unrecognized subcommand"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(arguments: list[str], expected: str) -> None:
    done = unshade(*arguments, check=False)
    assert done.returncode == 2
    assert expected in done.stderr
    assert "panicked" not in done.stderr


def test_without_a_viewer_the_message_says_how_to_get_one(tiny_run: Path, tmp_path: Path) -> None:
    capture = tiny_run / "captures" / CASE
    nobody = "rerun+http://127.0.0.1:1/proxy"
    done = unshade("solve", capture, "-o", tmp_path / "maps", "--rerun", nobody, check=False)
    assert done.returncode == 2
    # By a program without the viewer's feature, and by one with it.
    assert "--features rerun" in done.stderr or "start one with `rerun`" in done.stderr
    assert not (tmp_path / "maps").exists()


def test_competitor_runs_by_name_and_states_its_class(tiny_run: Path, tmp_path: Path) -> None:
    """On the captures of another run, whose stages are still valid."""
    run = shutil.copytree(tiny_run, tmp_path / "tiny")
    suite = tmp_path / "suite.toml"
    text = TINY.read_text().split("[[method]]")[0].replace("tiny-scene.toml", str(TINY.with_name("tiny-scene.toml")))
    passive = '[[method]]\nname = "sh-lambert"\nset = { shadow = false, texture_size = 64 }\n'
    controlled = '[[method]]\nname = "flash-only"\nset = { samples = 16, texture_size = 64 }\n'
    suite.write_text(f'scales = ["global"]\n{text}{passive}{controlled}')
    done = unshade("run", suite, "-o", run, check=False)
    assert f"capture/{CASE}: still valid" in done.stderr
    assert done.returncode == 1 and "unknown setting 'shadow'; there are order, shadows" in done.stderr
    solvers = json.loads((run / "run.json").read_text())["cases"][0]["solvers"]
    assert [solver["class"] for solver in solvers] == ["passive", "controlled"]
    assert ["scores" in solver for solver in solvers] == [False, True]
    page = (run / "report" / "index.html").read_text()
    assert "<small>controlled</small>" in page and "spherical harmonics, Lambert" in page

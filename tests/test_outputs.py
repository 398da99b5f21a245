"""An output never costs anybody anything: not a thesis, not an input, not the current folder."""

from __future__ import annotations

import csv
import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import unshade as package
from conftest import CASE, HERE, TINY, unshade

SCENE = HERE / "scenes" / "tiny-scene.toml"
MOUNTS = (
    shutil.which("unshare") is not None
    and subprocess.run(["unshare", "-m", "true"], capture_output=True).returncode == 0
)


@pytest.fixture(scope="module")
def parts(tiny_run: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """A capture, maps and scores that can be lost."""
    folder = tmp_path_factory.mktemp("parts")
    shutil.copytree(tiny_run / "captures" / CASE, folder / "capture")
    shutil.copytree(tiny_run / "maps" / CASE / "mean_texture", folder / "maps")
    return {"capture": folder / "capture", "maps": folder / "maps", "run": tiny_run}


def commands(parts: dict[str, Path], out: object) -> dict[str, list[object]]:
    capture, maps, run = parts["capture"], parts["maps"], parts["run"]
    return {
        "synth": ["synth", SCENE, "-o", out],
        "solve": ["solve", capture, "-o", out, "--config", "fast"],
        "mean": ["solve", capture, "-o", out, "--solver", "mean-texture"],
        "oracle": ["solve", capture, "-o", out, "--solver", "oracle"],
        "relight": ["relight", capture, maps, "-o", out],
        "report": ["report", run, "-o", out],
        "run": ["run", TINY, "-o", out],
    }


VERBS = ["synth", "solve", "mean", "oracle", "relight", "report", "run"]


@pytest.mark.parametrize("verb", VERBS)
def test_a_folder_that_is_not_ours_is_refused(parts: dict[str, Path], tmp_path: Path, verb: str) -> None:
    thesis = tmp_path / "out" / "thesis.tex"
    thesis.parent.mkdir()
    thesis.write_text("years")
    done = unshade(*commands(parts, thesis.parent)[verb], check=False)
    assert done.returncode == 2
    assert "was not written by unshade" in done.stderr and "choose" in done.stderr, done.stderr
    assert thesis.read_text() == "years"
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


@pytest.mark.parametrize("verb", ["synth", "solve", "mean", "oracle", "relight", "report"])
def test_the_current_folder_is_refused(parts: dict[str, Path], tmp_path: Path, verb: str) -> None:
    (tmp_path / "notes.txt").write_text("mine")
    command = [Path(sys.executable).with_name("unshade"), *map(str, commands(parts, ".")[verb])]
    done = subprocess.run(list(map(str, command)), cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 2, done.stderr
    assert "current folder" in done.stderr
    assert (tmp_path / "notes.txt").read_text() == "mine"


@pytest.mark.parametrize("verb", ["solve", "mean", "oracle", "relight"])
@pytest.mark.parametrize("where", [".", "..", "images"])
def test_an_output_over_an_input_is_refused(parts: dict[str, Path], verb: str, where: str) -> None:
    before = sorted(parts["capture"].rglob("*"))
    done = unshade(*commands(parts, parts["capture"] / where)[verb], check=False)
    assert done.returncode == 2
    assert "the input" in done.stderr or "current folder" in done.stderr, done.stderr
    assert sorted(parts["capture"].rglob("*")) == before


def test_our_own_folder_is_replaced_until_somebody_puts_a_file_into_it(parts: dict[str, Path], tmp_path: Path) -> None:
    out = tmp_path / "maps"
    mean = commands(parts, out)["mean"]
    unshade(*mean)
    (out / "coverage.png").unlink()
    unshade(*mean)
    assert (out / "coverage.png").is_file()
    (out / "notes.txt").write_text("mine")
    done = unshade(*mean, check=False)
    assert done.returncode == 2 and "notes.txt" in done.stderr
    assert (out / "notes.txt").read_text() == "mine"
    assert [path.name for path in tmp_path.iterdir()] == ["maps"]


def test_python_is_as_careful(parts: dict[str, Path], tmp_path: Path) -> None:
    maps = package.Maps(diffuse_albedo=np.full((8, 8, 3), 0.5, np.float32))
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis" / "a.tex").write_text("years")
    for call in (
        lambda: maps.write(tmp_path / "thesis"),
        lambda: package.solve(package.Capture(parts["capture"]), config="fast", out=tmp_path / "thesis"),
        lambda: package.synth(SCENE, tmp_path / "thesis"),
        lambda: package.relight(parts["capture"], parts["maps"], tmp_path / "thesis"),
        lambda: package.report(parts["run"], tmp_path / "thesis"),
        lambda: package.run(TINY, tmp_path / "thesis"),
    ):
        with pytest.raises(package.errors.UnshadeError, match="not written by unshade"):
            call()
    assert (tmp_path / "thesis" / "a.tex").read_text() == "years"


def test_scores_are_not_written_into_what_was_scored(parts: dict[str, Path]) -> None:
    target = parts["maps"] / "scores.json"
    done = unshade("score", parts["capture"], parts["maps"], "-o", target, check=False)
    assert done.returncode == 2 and "inside the input" in done.stderr
    assert not target.exists()


@pytest.mark.skipif(not MOUNTS, reason="mounting a disk for a test needs root and unshare (util-linux)")
def test_a_read_only_folder_is_found_before_the_work(parts: dict[str, Path], tmp_path: Path) -> None:
    (tmp_path / "disk").mkdir()
    inner = f"mount -t tmpfs -o ro none {tmp_path}/disk && exec "
    for verb in ("run", "solve", "synth"):
        done = in_namespace(inner, commands(parts, tmp_path / "disk" / "out")[verb])
        assert done.returncode == 2, done.stderr
        assert "Read-only" in done.stderr, done.stderr
        assert "s\n" not in done.stderr.replace("folders\n", ""), "no stage was done"


@pytest.mark.skipif(not MOUNTS, reason="mounting a disk for a test needs root and unshare (util-linux)")
def test_a_full_disk_is_found_before_the_work(parts: dict[str, Path], tmp_path: Path) -> None:
    (tmp_path / "disk").mkdir()
    inner = f"mount -t tmpfs -o size=256k none {tmp_path}/disk && exec "
    for verb in ("run", "solve"):
        done = in_namespace(inner, commands(parts, tmp_path / "disk" / "out")[verb])
        assert done.returncode == 2, done.stderr
        assert "make room" in done.stderr, done.stderr


def in_namespace(inner: str, command: list[object]) -> subprocess.CompletedProcess[str]:
    """The command where a disk of its own is mounted, which nobody else sees."""
    words = " ".join([str(Path(sys.executable).with_name("unshade")), *map(str, command)])
    return subprocess.run(["unshare", "-m", "sh", "-c", inner + words], capture_output=True, text=True)


def test_a_closed_pipe_ends_quietly(tmp_path: Path) -> None:
    program = Path(sys.executable).with_name("unshade")
    done = subprocess.run(
        ["bash", "-c", f"set -o pipefail; {program} synth --describe {SCENE} | head -c 1 > {tmp_path}/x"],
        capture_output=True,
        text=True,
    )
    assert "panicked" not in done.stderr and "Broken pipe" not in done.stderr, done.stderr
    assert done.returncode == 0
    done = subprocess.run(["bash", "-c", f"{program} doctor | true"], capture_output=True, text=True)
    assert "panicked" not in done.stderr, done.stderr


def test_compare_names_what_is_wrong(parts: dict[str, Path], tmp_path: Path) -> None:
    baseline = parts["run"] / "report" / "baseline.json"
    junit = tmp_path / "no" / "such" / "folder" / "junit.xml"
    done = unshade("compare", parts["run"], baseline, "--junit", junit, check=False)
    assert done.returncode == 2 and str(junit) in done.stderr and "run folder" not in done.stderr
    other = json.loads(baseline.read_text())
    other["suite"] = "another"
    (tmp_path / "other.json").write_text(json.dumps(other))
    done = unshade("compare", parts["run"], tmp_path / "other.json", check=False)
    assert done.returncode == 2 and '"another"' in done.stderr and '"tiny"' in done.stderr


def test_either_side_of_a_comparison_is_a_run_a_baseline_or_scores(parts: dict[str, Path], tmp_path: Path) -> None:
    run = parts["run"]
    scores = {method: next(run.glob(f"scores/*/{method}.json")) for method in ("quick", "oracle")}
    sides = (run, run / "run.json", run / "report", run / "report" / "baseline.json", scores["quick"])
    for current in sides:
        for baseline in (sides[0], sides[-1]):
            assert package.compare(current, baseline), (current, baseline)
    assert unshade("compare", sides[-1], sides[1]).returncode == 0
    other = json.loads(scores["quick"].read_text())
    other["solver"] = "mine"
    (tmp_path / "scores.json").write_text(json.dumps(other))
    for current, baseline, words in (
        (tmp_path, run, f"{tmp_path}: has no scores; name the folder of a finished run"),
        (run, run / "timing.json", "timing.json: has no scores; name"),
        (tmp_path / "scores.json", run, "scores of the method mine on the capture"),
        (run, run / "none.json", "none.json"),
    ):
        done = unshade("compare", current, baseline, check=False)
        assert done.returncode == 2 and words in done.stderr and done.stderr.count("\n") == 1, done.stderr
        with pytest.raises(package.errors.CompareError):
            package.compare(current, baseline)


def test_a_terminal_shows_the_means_of_the_file(tiny_run: Path, tmp_path: Path) -> None:
    done = unshade("table", tiny_run, "-o", tmp_path / "means.csv")
    with (tmp_path / "means.csv").open(newline="") as file:
        means = [row for row in csv.DictReader(file) if row["method"] == "quick"]
    shown = 0
    for block in done.stdout.strip().split("\n\n"):
        title, heading, *lines = block.split("\n")
        for line in lines:
            row = next(
                row for row in means if row["table"] in title and line.startswith(f"{row['figure']} {row['better']}")
            )
            text = line[heading.index("quick") :].split()[0].rstrip("*")
            assert abs(float(text) - float(row["mean"])) <= 0.51 * 10.0 ** -len(text.partition(".")[2]), line
            shown += 1
    assert shown == len(means)

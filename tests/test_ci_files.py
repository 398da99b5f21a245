"""What a comparison writes is read by the tools that it is written for, and the CI files are valid."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import junitparser
import pytest
from doc_examples import ROOT
from markdown_it import MarkdownIt

import unshade as package
from conftest import CASE, TINY, copy_without, unshade


@pytest.mark.parametrize(
    ("file", "arguments"),
    [
        ("docs/ci/github.yml", ["--builtin-schema", "vendor.github-workflows"]),
        ("docs/ci/gitlab-ci.yml", ["--builtin-schema", "vendor.gitlab-ci", "--data-transform", "gitlab-ci"]),
    ],
)
def test_the_ci_files_keep_to_their_schema_and_call_what_there_is(file: str, arguments: list[str]) -> None:
    checker = Path(sys.executable).with_name("check-jsonschema")
    done = subprocess.run([checker, *arguments, ROOT / file], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    text = (ROOT / file).read_text().replace("\\\n", " ")
    calls = re.findall(r"\.venv/bin/unshade (\w+)([^\n]*)", text)
    assert {verb for verb, _ in calls} == {"run", "compare"}
    for verb, rest in calls:
        known = unshade(verb, "--help").stdout
        for flag in re.findall(r"--[a-z-]+", rest):
            assert re.search(rf"{flag}\b", known), f"unshade {verb} {flag}"


@pytest.fixture(scope="module")
def darker(tiny_run: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The tiny run with an albedo and relit pictures that are 3 % darker, scored anew."""
    run = tmp_path_factory.mktemp("darker") / "run"
    shutil.copytree(tiny_run, run)
    capture, maps, relit = run / "captures" / CASE, run / "maps" / CASE / "quick", run / "relit" / CASE / "quick"
    changed = package.Maps.read(maps)
    changed.diffuse_albedo = changed.diffuse_albedo * 0.97
    changed.write(maps)
    # `Maps` reads and writes neither the method's own views nor its light and deviations.
    shutil.copytree(tiny_run / "maps" / CASE / "quick" / "views", maps / "views")
    for file in ("light.exr", "diffuse_albedo_std.exr"):
        shutil.copy(tiny_run / "maps" / CASE / "quick" / file, maps)
    for picture in relit.rglob("*.exr"):
        channels = package.exr_channels(picture)
        package.write_exr(picture, 0.97 * package.read_exr(picture, channels), channels)
    unshade("score", capture, maps, "--relit", relit, "-o", run / "scores" / CASE / "quick.json")
    return run


def test_consumers_read_a_comparison(tiny_run: Path, darker: Path, tmp_path: Path) -> None:
    files = {name: tmp_path / name for name in ("junit", "markdown", "json", "pictures", "history", "chart")}
    options = [item for name, path in files.items() for item in (f"--{name}", path)]
    done = unshade("compare", darker, tiny_run, "--suite", TINY, "--github", *options, check=False)
    assert done.returncode == 1, done.stdout + done.stderr

    report = json.loads(files["json"].read_text())
    first = report["findings"][0]
    assert "diffuse albedo of `quick` is 3.0 % darker" in first["sentence"], first
    assert first["following"] > 0 and "under studio" in first["sentence"]
    assert sum(report["counts"].values()) == len(report["rows"])

    failed = [
        case
        for suite in junitparser.JUnitXml.fromfile(str(files["junit"]))
        for case in suite
        if any(isinstance(result, junitparser.Failure) for result in case.result)
    ]
    assert len(failed) == report["counts"]["worse"]
    scene = TINY.with_name("tiny-scene.toml")
    assert all(case._elem.get("file") == str(scene) and case._elem.get("line") == "3" for case in failed)

    marked = re.findall(r"^::error file=([^,]*),line=(\d+),title=[^:]*::(.*)$", done.stdout, re.MULTILINE)
    assert marked[0] == (str(scene), "3", first["sentence"].replace("%", "%25"))

    page = files["markdown"].read_text()
    assert page.startswith("<!-- unshade compare: tiny -->\n")
    tokens = MarkdownIt("commonmark", {"html": True}).enable("table").parse(page)
    headings = [tokens[i + 1].content for i, token in enumerate(tokens) if token.type == "heading_open"]
    assert headings == ["❌ unshade, tiny: REGRESSION"]
    rows = [token for token in tokens if token.type == "tr_open"]
    moved = [row for row in report["rows"] if row["verdict"] not in ("same", "cannot_tell")]
    assert len(rows) == 1 + min(len(moved), 150)

    names = {path.name for path in files["pictures"].iterdir()} - {".unshade"}
    shown = {f"01-quick-diffuse_albedo-{what}.png" for what in ("old", "new", "truth", "difference", "flip")}
    assert shown <= names
    assert all((files["pictures"] / name).stat().st_size < 300_000 for name in names)

    record = json.loads(files["history"].read_text())
    assert record["suite"] == "tiny" and not record["passed"]
    assert "<svg" in files["chart"].read_text()


def test_an_accepted_change_passes_until_its_day_and_no_further(tiny_run: Path, darker: Path, tmp_path: Path) -> None:
    file = tmp_path / "accepted.toml"
    against = [tiny_run / "report" / "baseline.json", "--acceptances", file]
    accept = ["--accept", f"{CASE}/quick/*", "--reason", 'a "darker" skin', "--until"]
    bad = unshade("compare", darker, *against, *accept, "soon", check=False)
    assert bad.returncode == 2 and "YYYY-MM-DD" in bad.stderr and not file.exists()
    done = unshade("compare", darker, *against, *accept, "2999-12-31")
    assert 'accepted: a "darker" skin' in done.stdout
    assert unshade("compare", darker, *against).returncode == 0
    file.write_text(file.read_text().replace("2999-12-31", "2001-12-31"))
    late = unshade("compare", darker, *against, check=False)
    assert late.returncode == 1 and "was accepted until 2001-12-31" in late.stdout


def test_the_baseline_of_a_branch_is_that_of_the_merge_base(tiny_run: Path, tmp_path: Path) -> None:
    def git(*arguments: str) -> str:
        options = ["-c", "user.name=a", "-c", "user.email=a@b.c", "-c", "commit.gpgsign=false"]
        command = ["git", "-C", str(tmp_path), *options, *arguments]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()

    def compare() -> subprocess.CompletedProcess[str]:
        command = [Path(sys.executable).with_name("unshade"), "compare", tiny_run]
        command += ["--baseline-branch", "main", "--baselines", "kept"]
        return subprocess.run(list(map(str, command)), capture_output=True, text=True, cwd=tmp_path)

    git("init", "-b", "main")
    git("commit", "--allow-empty", "-m", "one")
    one = git("rev-parse", "HEAD")
    git("commit", "--allow-empty", "-m", "two")
    git("checkout", "-b", "change")
    git("commit", "--allow-empty", "-m", "three")
    missing = compare()
    assert missing.returncode == 2 and "has no baseline of" in missing.stderr
    (tmp_path / "kept").mkdir()
    shutil.copy(tiny_run / "report" / "baseline.json", tmp_path / "kept" / f"{one}.json")
    assert compare().returncode == 0


def test_calibrate_resumes_its_runs_and_reads_runs_of_others(tiny_run: Path, tmp_path: Path) -> None:
    """Four runs that are finished already, and four whose scores were moved by hand."""
    suite, out = tmp_path / "suite.toml", tmp_path / "tolerances.toml"
    scene = TINY.with_name("tiny-scene.toml")
    suite.write_text(f'format = 1\nname = "tiny"\nscene = "{scene}"\n[[method]]\nname = "mean_texture"\n')
    finished = [copy_without(tiny_run, tmp_path / "tolerances-runs" / f"seed-{k:02d}") for k in range(1, 5)]
    first = unshade("calibrate", suite, "--seeds", 4, "--vary", "method", "-o", out)
    assert (
        "maps/tiny-studio/mean_texture: still valid" in first.stderr
        and "none of which depends on the seed" in first.stdout
    )
    text = out.read_text()
    assert "runs = 4" in text and "false_alarms = 0.01" in text and "[calibration.captures]" in text
    assert "still valid" in unshade("calibrate", suite, "--seeds", 4, "--vary", "method", "-o", out).stderr
    for k, run in enumerate(finished):
        scores = run / "scores" / CASE / "mean_texture.json"
        moved = json.loads(scores.read_text())
        for row in moved["rows"]:
            row["value"] = row["value"] and row["value"] * (1 + 1e-3 * k)
        scores.write_text(json.dumps(moved))
    found = package.calibrate(tmp_path / "moved.toml", runs=finished)
    assert found["calibration"]["runs"] == 4 and "sd = 0.000e0" not in (tmp_path / "moved.toml").read_text()
    few = unshade("calibrate", "--runs", *finished[:3], "-o", tmp_path / "few.toml", check=False)
    assert few.returncode == 2 and "3 runs are too few" in few.stderr
    assert (
        "1 % false alarms over all rows"
        in unshade("compare", *finished[:2], "--tolerances", tmp_path / "moved.toml").stdout
    )
    scores = finished[0] / "scores" / CASE / "mean_texture.json"
    scores.write_text(re.sub(r'"capture": ?"[0-9a-f]{64}"', f'"capture":"{"0" * 64}"', scores.read_text()))
    other = unshade("compare", *finished[:2], "--tolerances", out, check=False)
    assert other.returncode == 2 and "tiny-studio: the run's capture is not" in other.stderr


@pytest.mark.heavy
def test_calibrate_renders_a_suite_over_seeds(tmp_path: Path) -> None:
    suite = tmp_path / "suite.toml"
    scene = TINY.with_name("tiny-scene.toml")
    suite.write_text(
        f'format = 1\nname = "tiny"\nscene = "{scene}"\nscales = ["none"]\n'
        '[render]\nwidth = 48\nheight = 48\nsamples = 4\n[[method]]\nname = "mean_texture"\ntexture_size = 64\n'
    )
    out = tmp_path / "tolerances.toml"
    first = unshade("calibrate", suite, "--seeds", 4, "-o", out)
    text = out.read_text()
    assert "runs = 4" in text and "false_alarms = 0.01" in text
    runs = [tmp_path / "tolerances-runs" / f"seed-{k:02d}" for k in range(1, 5)]
    assert "1 % false alarms over all of them" in first.stdout
    found = package.calibrate(tmp_path / "again.toml", runs=runs)
    assert (tmp_path / "again.toml").read_text() == text and found["calibration"]["runs"] == 4
    assert "still valid" in unshade("calibrate", suite, "--seeds", 4, "-o", out).stderr
    same = unshade("compare", runs[0], runs[1], "--tolerances", out)
    assert "Not like with like: other captures (tiny-studio)" in same.stdout
    assert "1 % false alarms over all rows" in same.stdout
    kept = tmp_path / "kept.toml"
    unshade("calibrate", suite, "--seeds", 4, "--vary", "method", "-o", kept)
    assert "[calibration.captures]" in kept.read_text() and "[calibration.captures]" not in text
    kept_runs = [tmp_path / "kept-runs" / f"seed-{k:02d}" for k in range(1, 5)]
    stages = json.loads((kept_runs[3] / "timing.json").read_text())["stages"]
    assert [stage["cached"] for stage in stages if stage["id"].startswith("capture/")] == [True]
    assert "Not like" not in unshade("compare", kept_runs[0], kept_runs[1], "--tolerances", kept).stdout
    other = unshade("compare", runs[0], kept_runs[0], "--tolerances", kept, check=False)
    assert other.returncode == 2 and "tiny-studio: the run's capture is not the baseline's" in other.stderr

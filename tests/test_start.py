"""What a user meets who has installed the package: names of suites and scenes, `init`, the wheel, the method's page."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from doc_examples import ROOT, commands, examples

import unshade
from conftest import CASE, HERE
from conftest import unshade as command

START = ROOT / "harness" / "src" / "cli" / "start"


def test_a_name_stands_for_what_comes_with_unshade(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert command("synth", "photographic", "--describe").stdout.startswith("scene photographic\n")
    failed = command("run", "photographic", "-o", "run", check=False)
    assert failed.returncode == 2 and not Path("run").exists()
    assert (
        failed.stderr.count("\n") == 1
        and " ci, competitors, degraded, demo, emily, emily-medium, emily-small, held-out, " in failed.stderr
    )
    with pytest.raises(unshade.errors.SceneError, match="no scene of this name comes with unshade; there are ci, demo"):
        unshade.synth("dmeo", "capture")
    # A file of the same name wins.
    Path("photographic").write_text(
        (HERE / "scenes" / "tiny-scene.toml").read_text().replace("../../scenes/lights/", "")
    )
    Path("studio.toml").write_text('name = "mine"\nkind = "dome"\n')
    Path("uniform.toml").write_text('name = "other"\nkind = "dome"\n')
    said = command("synth", "photographic", "--describe").stdout
    assert said.startswith("scene tiny\n") and "mine" in said


def test_a_suite_names_faces_and_lights_that_come_with_unshade(tmp_path: Path) -> None:
    suite = tmp_path / "suite.toml"
    text = 'format = 1\nname = "s"\nscene = "demo"\nfaces = ["ada"]\nlights = ["moon"]\n[[method]]\nname = "oracle"\n'
    suite.write_text(text)
    failed = command("run", suite, "-o", tmp_path / "run", check=False)
    assert failed.returncode == 2
    assert failed.stderr.startswith(f"unshade: {suite}:5: lights: moon: no such file, and no light of this name")
    assert "there are courtyard, envmap, flash" in failed.stderr


def test_init_writes_a_suite_and_never_over_anything(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "new" / "start"
    said = command("init", folder)
    assert said.stdout == f"unshade run {folder / 'suite.toml'} -o {folder / 'run'}\n"
    assert {path.name for path in folder.iterdir()} == {"suite.toml", "mine.py"}
    # The suite's own first line, and every other way to name the same files.
    (tmp_path / "link").symlink_to(folder)
    for here, suite, run in (
        (folder, "suite.toml", "run"),
        (folder, "./suite.toml", "run/"),
        (folder.parent, "start/../start/suite.toml", "start/run"),
        (folder.parent, tmp_path / "link" / "suite.toml", "../link/run"),
    ):
        monkeypatch.chdir(here)
        said = command("run", suite, "-o", run, "--dry-run").stdout
        assert said.startswith("stage "), (here, suite)
    monkeypatch.chdir(tmp_path)
    (folder / "mine.py").write_text("mine")
    failed = command("init", folder, check=False)
    assert failed.returncode == 2 and "is not empty" in failed.stderr
    assert (folder / "mine.py").read_text() == "mine"
    (tmp_path / "empty").mkdir()
    command("init", tmp_path / "empty")
    assert (tmp_path / "empty" / "mine.py").read_text() == (START / "mine.py").read_text()


def test_the_method_of_the_page_beats_the_mean_texture(tiny_run: Path) -> None:
    """It is the one that `init` writes, and `check` has nothing against its maps."""
    text = (START / "mine.py").read_text()
    assert any(text == code for place, code in examples().items() if "your-method" in place)
    spec = importlib.util.spec_from_file_location("mine", START / "mine.py")
    assert spec is not None and spec.loader is not None
    mine = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(mine)
    capture = unshade.Capture(tiny_run / "captures" / CASE)
    maps = mine.recover(capture)
    assert unshade.check(maps, capture=capture) == []

    def quality(maps: unshade.Maps | Path) -> float:
        value = unshade.score(capture, maps).value(
            subject="diffuse_albedo", metric="psnr_srgb", scale="global", label=None, region="coverage-e5"
        )
        assert value is not None
        return value

    of_runs = [quality(tiny_run / "maps" / CASE / method) for method in ("mean_texture", "quick")]
    assert of_runs[0] < quality(maps) < of_runs[1] - 3


STAND_INS = {
    "runs/ci": "",
    "baseline.json": "report/baseline.json",
    "tolerances.toml": str(ROOT / "scenes" / "tolerances.toml"),
    "BASELINE": "",
    "RUN": "",
    "runs/demo/captures/demo-studio": f"captures/{CASE}",
    "runs/demo/maps/demo-studio/unshade": f"maps/{CASE}/quick",
    "mine/run/captures/demo-studio": f"captures/{CASE}",
    "mine/run/maps/demo-studio/mine": f"maps/{CASE}/quick",
}
"""What the commands of the pages read, and what of the tiny run stands for it."""

AS_THEY_STAND = ("init", "check", "compare")
"""Commands that get their inputs, since they are done in a moment. The others are to name an input that they miss; those
that miss none get:"""

PLANS = {"run": ["--dry-run"], "calibrate": ["--help"]}


@pytest.mark.parametrize("page", sorted({place.partition(":")[0] for place in commands()}))
def test_the_pages_commands_are_understood_in_any_folder(
    page: str, tiny_run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for place, words in commands().items():
        if not place.startswith(f"{page}:"):
            continue
        if words[0] == "make":
            subprocess.run(["make", "-n", *words[1:]], cwd=ROOT, check=True, capture_output=True)
            continue
        verb = words[1]
        for word in words:
            if verb in AS_THEY_STAND and word in STAND_INS and not Path(word).exists():
                Path(word).parent.mkdir(parents=True, exist_ok=True)
                Path(word).symlink_to(tiny_run / STAND_INS[word])
        plan = ["--help"] if "--cluster" in words else PLANS.get(verb, [])
        done = command(*words[1:], *plan, check=False)
        is_line = done.stderr.startswith("unshade: ") and done.stderr.count("\n") == 1
        inputs = [word for word in words[2:] if not word.startswith("-")]
        expected = done.returncode == 2 and is_line and any(word in done.stderr for word in inputs)
        assert done.returncode == 0 or expected, f"{place}: {done.stderr}"


def test_the_wheel_carries_all_that_the_package_reads(tmp_path: Path) -> None:
    """`make wheel` installs it into an empty environment and runs it there."""
    maturin = [Path(sys.executable).with_name("maturin"), "build", "--release", "--quiet", "-o", tmp_path]
    # In the environment of `make build`, whose compiled code this packs; in another, cargo compiles it again.
    path = f"{ROOT / '.tools' / 'bin'}{os.pathsep}{os.environ['PATH']}"
    built_in = {**os.environ, "PATH": path, "VIRTUAL_ENV": sys.prefix}
    subprocess.run(maturin, cwd=ROOT, check=True, capture_output=True, env=built_in)
    (wheel,) = tmp_path.glob("*.whl")
    packed = set(zipfile.ZipFile(wheel).namelist())
    files = [path.relative_to(ROOT / "synth") for path in (ROOT / "synth" / "unshade").rglob("*") if path.is_file()]
    scenes = [Path("unshade") / path.relative_to(ROOT) for path in (ROOT / "scenes").rglob("*") if path.is_file()]
    wanted = {path.as_posix() for path in (*files, *scenes) if "__pycache__" not in path.parts}
    assert "unshade/scenes/suites/demo.toml" in wanted and "unshade/_native.abi3.so" in wanted
    assert wanted <= packed, wanted - packed

"""Methods that are not ours: kept apart from the truth, limited, keyed by content, and never fatal to the rest."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import textwrap
import time
from pathlib import Path
from typing import Any

import pytest

import unshade as package
from conftest import CASE, HERE, copy_without, rows, unshade

SPY_ID = "spy-seed3"

SUITE = f"""
format = 1
name = "programs"
scene = "{HERE / "scenes" / "tiny-scene.toml"}"

[[method]]
name = "mine"
python = "mine:solve"
set = {{ gain = 1.0 }}

[[method]]
name = "spy"
command = ["python", "spy.py", "{{capture}}", "{{maps}}", "{{set}}", "{{lr}}", "{{debug}}"]
set = {{ lr = 0.1 }}
seeds = [3]

[[method]]
name = "broken"
command = ["sh", "broken.sh", "{{capture}}", "{{maps}}"]

[[method]]
name = "slow"
command = "sh slow.sh {{capture}} {{maps}}"
timeout_s = 1.0

[[method]]
name = "greedy"
command = ["python", "greedy.py", "{{capture}}", "{{maps}}"]
memory_gib = 0.25
threads = 1

[[method]]
name = "nan"
python = "nothing:solve"

[[method]]
name = "oracle"
"""

MINE = """
import os
import numpy as np
import unshade
from shade import colour

def solve(capture, gain=2.0):
    print("seen:", capture.train)
    print("of the shell:", os.environ.get("SHELL_ONLY"))
    return unshade.Maps(diffuse_albedo=np.full((16, 16, 3), gain * colour(), np.float32))
"""

# Looks wherever it can for pictures that it must not have, and hands in the best that it finds.
SPY = """
import os, pathlib, shutil, socket, sys
import numpy as np
import unshade

capture, maps = map(pathlib.Path, sys.argv[1:3])
print("given:", *sys.argv[3:5], os.environ["UNSHADE_SET"], os.environ["UNSHADE_SEED"])
pathlib.Path(sys.argv[5], "seen.txt").write_text(os.environ["UNSHADE_DEBUG"])
pathlib.Path.home().joinpath("settings").write_text("x")
server = socket.create_server(("127.0.0.1", 0))
for kind in (socket.SOCK_STREAM, socket.SOCK_DGRAM):
    try:
        # Of a range for documentation, which nobody has.
        socket.socket(socket.AF_INET, kind).connect(("192.0.2.1", 9))
        print("reached:", kind)
    except OSError as error:
        print("unreachable:", error)
try:
    socket.create_connection(server.getsockname()).close()
    print("loopback: open")
except OSError as error:
    print("loopback:", error)
roots = {place.resolve() for start in (capture, maps, pathlib.Path.cwd(), pathlib.Path.home()) for place in (start, *start.parents)}
roots |= {pathlib.Path(os.environ["SPY_RUN"]), pathlib.Path(os.environ["SPY_RUN"]).parent}
found = []
for root in sorted(roots - {pathlib.Path("/")}):
    for folder, _, files in os.walk(root):
        for name in files:
            path = pathlib.Path(folder, name)
            try:
                path.read_bytes()
            except OSError:
                continue
            found.append(path)
for process in pathlib.Path("/proc").glob("[0-9]*"):
    for link in ("cwd", "root"):
        try:
            found += [path for path in (process / link).glob("captures/*/truth/*.exr") if path.read_bytes()]
        except OSError:
            pass
inside = sorted(str(path.relative_to(capture)) for path in found if path.is_relative_to(capture))
print("inside:", *dict.fromkeys(inside))
truth = [path for path in found if path.name == "diffuse_albedo.exr" or "truth" in path.parts]
print("truth:", *truth)
for leak in truth:
    shutil.copy(leak, maps / leak.name)
unshade.Maps(diffuse_albedo=np.full((16, 16, 3), 0.3, np.float32)).write(maps / "flat")
if not (maps / "diffuse_albedo.exr").exists():
    shutil.move(maps / "flat" / "diffuse_albedo.exr", maps)
shutil.rmtree(maps / "flat")
for place in (capture / "written", pathlib.Path.cwd() / "written", pathlib.Path(os.environ["SPY_RUN"]) / "written"):
    try:
        place.write_text("x")
        print("written:", place)
    except OSError:
        pass
"""


@pytest.fixture(scope="session")
def programs(tiny_run: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the suite and a finished run of it, on the capture and the oracle of another run."""
    folder = tmp_path_factory.mktemp("programs")
    run = copy_without(tiny_run, folder / "run", "quick", "mean_texture")
    # Its environment is part of the suite's text.
    (folder / "suite.toml").write_text(
        SUITE.replace('name = "spy"', f'name = "spy"\nenvironment = {{ SPY_RUN = "{run}" }}')
    )
    write(folder, "mine.py", MINE)
    write(folder, "shade.py", "def colour():\n    return 0.25\n")
    write(folder, "spy.py", SPY)
    write(folder, "broken.sh", "echo about to fail\necho 'no such lens' >&2\nexit 7\n")
    write(folder, "slow.sh", "sleep 60 & echo child $!; sleep 60\n")
    write(
        folder,
        "greedy.py",
        "import time\nkept = bytearray(600 << 20)\nkept[::4096] = b'x' * len(kept[::4096])\ntime.sleep(60)\n",
    )
    write(
        folder,
        "nothing.py",
        "import numpy, unshade\ndef solve(capture):\n    return unshade.Maps(specular_albedo=numpy.zeros((4, 4), 'float32'))\n",
    )
    done = go(folder)
    assert done.returncode == 1, done.stderr
    assert done.stderr.count("no such lens") == 1 and "unshade: 4 failed; the reasons are above" in done.stderr
    return folder


def write(folder: Path, name: str, text: str) -> None:
    (folder / name).write_text(textwrap.dedent(text).lstrip())


def go(folder: Path, *more: object) -> subprocess.CompletedProcess[str]:
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    command = [Path(sys.executable).with_name("unshade"), "run", folder / "suite.toml", "-o", folder / "run", *more]
    place = {**os.environ, "PATH": path, "SHELL_ONLY": "1"}
    return subprocess.run(list(map(str, command)), capture_output=True, text=True, env=place)


def value(folder: Path, method: str, metric: str = "psnr_srgb", scale: str = "none") -> float:
    scores = json.loads((folder / "run" / "scores" / CASE / f"{method}.json").read_text())
    return next(
        row["value"]
        for row in scores["rows"]
        if (row["subject"], row["metric"], row["scale"], row["label"]) == ("diffuse_albedo", metric, scale, None)
    )


def log(folder: Path, method: str) -> str:
    return (folder / "run" / "logs" / CASE / f"{method}.txt").read_text()


def methods(folder: Path) -> list[dict[str, Any]]:
    solvers: list[dict[str, Any]] = json.loads((folder / "run" / "run.json").read_text())["cases"][0]["solvers"]
    return solvers


def failures(folder: Path) -> dict[str, str]:
    return {s["id"]: s["failed"] for s in methods(folder) if "failed" in s}


def test_one_failing_method_leaves_the_others_alone(programs: Path) -> None:
    failed = failures(programs)
    assert set(failed) == {"broken", "slow", "greedy", "nan"}
    assert "exit status: 7" in failed["broken"] and "no such lens" in failed["broken"]
    assert "timeout_s = 1" in failed["slow"]
    assert "memory_gib = 0.25" in failed["greedy"]
    assert "no diffuse_albedo.exr" in failed["nan"]
    assert "about to fail" in log(programs, "broken")
    assert value(programs, "oracle") > 90
    # What a method did not recover is absent, never scored as zero.
    assert "specular_albedo" not in {row.subject for row in rows(programs / "run", "mine").values()}
    page = (programs / "run" / "report" / "index.html").read_text()
    assert "no such lens" in page and page.count("<td>failed</td>") >= 4
    assert (programs / "run" / "report" / "data" / CASE / "broken.log.txt").is_file()


def test_stopped_program_leaves_no_process(programs: Path) -> None:
    child = int(log(programs, "slow").split()[1])
    for _ in range(50):
        if not Path(f"/proc/{child}").exists() or ") Z " in Path(f"/proc/{child}/stat").read_text():
            return
        time.sleep(0.1)
    pytest.fail(f"process {child} still runs")


def test_a_spy_finds_nothing_of_the_truth(programs: Path) -> None:
    said = dict(line.partition(":")[::2] for line in log(programs, SPY_ID).splitlines() if ":" in line)
    transforms = json.loads((programs / "run" / "captures" / CASE / "transforms.json").read_text())
    train = [f for f in transforms["frames"] if f["file_path"] in transforms["train_filenames"]]
    given = {f[key] for f in train for key in ("file_path", "mask_path", "label_path")}
    assert set(said["inside"].split()) == given | {"mesh.obj", "transforms.json"}
    if confined():
        assert said["truth"].split() == []
        assert "written" not in said
        assert value(programs, SPY_ID) < 40


def test_a_program_is_given_settings_a_debug_folder_and_no_network(programs: Path) -> None:
    text = log(programs, SPY_ID)
    given = '{"lr":0.1,"seed":3}'
    assert f"given: {given} 0.1 {given} 3\n" in text
    debug = programs / "run" / "debug" / CASE / SPY_ID
    assert (debug / "seen.txt").read_text() == str(debug) and (debug / "home" / "settings").is_file()
    assert not (debug.parent / "mine").exists()
    (made,) = (s for s in methods(programs) if s["id"] == SPY_ID)
    assert (made["of"], made["seed"], made["set"]) == ("spy", 3, {"lr": 0.1, "seed": 3})
    timing = json.loads((programs / "run" / "timing.json").read_text())["stages"]
    (network,) = {stage["made"]["network"] for stage in timing if stage["made"].get("network")}
    assert ("reached" not in text) == (network == "closed")
    assert ("loopback: open" in text) == (network != "tcp")


def confined() -> bool:
    """Whether this system can keep a program to its files; the report has to say which."""
    import ctypes

    return sys.platform == "linux" and ctypes.CDLL(None).syscall(444, 0, 0, 1) > 0


def test_no_variable_of_the_shell_reaches_a_program(programs: Path) -> None:
    assert "of the shell: None" in log(programs, "mine")


def test_the_report_says_what_a_program_could_read(programs: Path) -> None:
    page = (programs / "run" / "report" / "index.html").read_text()
    assert ("its own files and the training views" if confined() else "not confined") in page
    assert "mine.py and 1 more files" in page
    assert "; no network" in page or "; no TCP, but UDP" in page or "; the network" in page


def test_an_edited_module_is_run_again_and_nothing_else(programs: Path, tmp_path: Path) -> None:
    folder = tmp_path / "programs"
    shutil.copytree(programs, folder, symlinks=True)
    suite = (folder / "suite.toml").read_text()
    # The run alone moved, so what names it by path is left out.
    head, *tables = suite.split("[[method]]")
    keep = [table for table in tables if '"mine"' in table or '"oracle"' in table]
    (folder / "suite.toml").write_text("[[method]]".join([head, *keep]))
    shutil.rmtree(folder / "run" / "maps" / CASE / "mine")
    assert go(folder).returncode == 0
    before = value(folder, "mine")
    write(folder, "shade.py", "def colour():\n    return 0.5\n")  # imported, not named
    done = go(folder, "--method", "oracle")
    assert "0 stages run" in done.stderr and [method["id"] for method in methods(folder)] == ["oracle"]
    done = go(folder)
    assert "3 stages run" in done.stderr, done.stderr
    assert value(folder, "mine") != before
    assert "kept from an earlier run" in (folder / "run" / "report" / "index.html").read_text()
    wrong = go(folder, "--redo", "yours")
    assert wrong.returncode == 2 and "there are mine, oracle" in wrong.stderr
    (folder / "suite.toml").write_text((folder / "suite.toml").read_text().replace("gain = 1.0", "gain = 0.5"))
    assert re.search(r"^maps +1 +1 ", go(folder, "--dry-run").stdout, re.MULTILINE)
    (folder / "suite.toml").write_text((folder / "suite.toml").read_text().replace("gain = 0.5", "gain = 1.0"))
    # What is broken now does not pass for what was.
    write(folder, "shade.py", "def colour():\n    raise SystemExit('no colour')\n")
    assert go(folder).returncode == 1
    assert "no colour" in failures(folder)["mine"]
    assert not (folder / "run" / "scores" / CASE / "mine.json").exists()
    write(folder, "shade.py", "def colour():\n    return 0.25\n")
    done = go(folder)
    assert "0 stages run" in done.stderr, done.stderr
    assert value(folder, "mine") == before and "seen:" in log(folder, "mine")
    write(folder, "shade.py", "def colour():\n    return 0.75\n")
    printed = f"maps/{CASE}/mine: of the shell: None"
    with pytest.raises(package.errors.Stopped):
        package.run(
            folder / "suite.toml", folder / "run", progress=lambda *step: package.STOP if step[2] == printed else None
        )


@pytest.mark.parametrize(
    ("table", "expected"),
    [
        (
            'name = "a"\ncommand = ["no-such-program", "{capture}", "{maps}"]',
            "suite.toml:6: command: there is no program",
        ),
        ('name = "a"\ncommand = ["python", "gone.py", "{capture}", "{maps}"]', "gone.py"),
        ('name = "a"\ncommand = ["python", "bad.py", "{capture}", "{maps}"]', "bad.py:2"),
        ('name = "a"\ncommand = ["sh", "x.sh", "{capture}"]', "does not contain {maps}"),
        ('name = "a"\npython = "gone:solve"', "suite.toml:6: python: there is no module gone"),
        ('name = "a"\npython = "ok:resolve"', "has no function resolve"),
        ('name = "a"\npython = "ok:solve"\ninputs = ["weights.bin"]', "suite.toml:7: inputs: there is no"),
        (
            'name = "a"\npython = "ok:solve"\nset = { gian = 2 }',
            'suite.toml:6: python: ok:solve has no argument "gian"; did you mean "gain"?',
        ),
        ('name = "fast"\n[method.set.joint]\nstep = 3', "suite.toml:5: name: configuration: "),
    ],
)
def test_suite_errors_are_found_before_rendering(tmp_path: Path, table: str, expected: str) -> None:
    head = SUITE.strip().split("[[method]]")[0].rstrip() + "\n"
    (tmp_path / "suite.toml").write_text(head + "[[method]]\n" + table + "\n")
    (tmp_path / "bad.py").write_text("x = 1\ndef (:\n")
    (tmp_path / "ok.py").write_text("def solve(capture, gain=1):\n    return None\n")
    done = go(tmp_path)
    assert done.returncode == 2
    assert expected in done.stderr, done.stderr
    assert not (tmp_path / "run").exists()


def test_scene_errors_name_the_users_file_before_rendering(tmp_path: Path) -> None:
    scenes = HERE.parent / "scenes"
    scene = (HERE / "scenes" / "tiny-scene.toml").read_text().replace("../../scenes", str(scenes))
    (tmp_path / "scene.toml").write_text(scene.replace("samples = 32", "sample = 32"))
    (tmp_path / "suite.toml").write_text('format = 1\nname = "m"\nscene = "scene.toml"\n[[method]]\nname = "oracle"\n')
    line = 1 + (tmp_path / "scene.toml").read_text().splitlines().index("sample = 32")
    for done in (go(tmp_path), unshade("synth", tmp_path / "scene.toml", "-o", tmp_path / "c", check=False)):
        assert done.returncode == 2
        assert f"scene.toml:{line}: unknown key 'sample'" in done.stderr, done.stderr
    assert not (tmp_path / "run" / "captures" / CASE).exists()
    (tmp_path / "light.toml").write_text('name = "hall"\nkind = "envmap"\npath = "hall.exr"\n')
    (tmp_path / "suite.toml").write_text(
        'format = 1\nname = "m"\nscene = "scene.toml"\nlights = ["light.toml"]\n[[method]]\nname = "oracle"\n'
    )
    done = go(tmp_path)
    assert done.returncode == 2 and "light.toml:3" in done.stderr, done.stderr

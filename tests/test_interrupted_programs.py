"""A program of others ends with the suite that started it, however that ends."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from conftest import HERE


@pytest.fixture(scope="module")
def waiting(tiny_run: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A suite with a program that waits, and a run that has its capture."""
    folder = tmp_path_factory.mktemp("waiting")
    shutil.copytree(tiny_run, folder / "run")
    text = f'format = 1\nname = "waiting"\nscene = "{HERE / "scenes" / "tiny-scene.toml"}"\n'
    method = '[[method]]\nname = "waiting"\ncommand = ["sh", "wait.sh", "{capture}", "{maps}"]\n'
    (folder / "suite.toml").write_text(text + method)
    # One in the group, one that has left it.
    (folder / "wait.sh").write_text("setsid sleep 120 & echo child $!\nsleep 120 & echo child $!\nwait\n")
    return folder


@pytest.mark.parametrize("ending", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL])
def test_a_program_ends_with_its_suite(waiting: Path, ending: signal.Signals) -> None:
    log = waiting / "run" / "logs" / "tiny-studio" / "waiting.txt"
    log.unlink(missing_ok=True)
    command = [Path(sys.executable).with_name("unshade"), "run", waiting / "suite.toml", "-o", waiting / "run"]
    # What a killed run leaves, the next one of its folder clears; there is none here.
    temporary = {**os.environ, "TMPDIR": str(waiting)}
    process = subprocess.Popen(
        list(map(str, command)), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=temporary
    )
    children: list[int] = []
    for _ in range(300):
        if log.exists():
            children = [int(line.split()[1]) for line in log.read_text().splitlines() if line.startswith("child")]
        if len(children) == 2:
            break
        time.sleep(0.1)
    assert len(children) == 2 and shells(waiting)
    time.sleep(0.3)
    process.send_signal(ending)
    process.wait(timeout=30)
    if ending == signal.SIGKILL:
        # Nobody is left to end what the program started; the program itself goes with its parent.
        for child in children:
            os.kill(child, signal.SIGKILL)
        assert gone_from(waiting)
        return
    assert process.returncode == 3
    for child in children:
        assert gone(child), ending


def gone(process: int) -> bool:
    for _ in range(50):
        stat = Path(f"/proc/{process}/stat")
        if not stat.exists() or ") Z " in stat.read_text():
            return True
        time.sleep(0.1)
    return False


def shells(folder: Path) -> list[str]:
    """Programs that run on a capture in the folder: other processes of the tests may run theirs."""
    found = subprocess.run(["pgrep", "-f", f"wait.sh {folder}/unshade-"], capture_output=True, text=True)
    return found.stdout.split()


def gone_from(folder: Path) -> bool:
    for _ in range(50):
        if not shells(folder):
            return True
        time.sleep(0.1)
    return False

"""Kills a run at random moments, again and again, and compares its end with that of an undisturbed one.

``python tests/kill_run.py KILLS [SEED]``: minutes, so it is no test. A run that comes to its end is begun anew.
"""

from __future__ import annotations

import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from test_run import digest

from conftest import TINY

PROGRAM = """
import time
import numpy as np
import unshade

def solve(capture):
    time.sleep(1)
    return unshade.Maps(diffuse_albedo=np.full((16, 16, 3), 0.25, np.float32))
"""


def main(kills: int, seed: int) -> int:
    random.seed(seed)
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        suite = TINY.read_text().replace('scene = "', f'scene = "{TINY.parent}/')
        (folder / "suite.toml").write_text(suite + '\n[[method]]\nname = "mine"\npython = "mine:solve"\n')
        (folder / "mine.py").write_text(PROGRAM)
        start = time.monotonic()
        run(folder, "whole").wait()
        seconds = time.monotonic() - start
        whole = digest(folder / "whole")
        ends = 0
        for _ in range(kills):
            process = run(folder, "killed")
            try:
                process.wait(random.uniform(0, seconds))
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGKILL)
                process.wait()
                continue
            ends += 1
            compare(folder, whole)
            shutil.rmtree(folder / "killed")
        run(folder, "killed").wait()
        compare(folder, whole)
        left = [str(path) for path in Path(tempfile.gettempdir()).glob("unshade-*")]
        print(f"{kills - ends} kills, {ends + 1} whole runs, all equal; left in the temporary folder: {len(left)}")
    return 0


def run(folder: Path, name: str) -> subprocess.Popen[bytes]:
    command = [Path(sys.executable).with_name("unshade"), "run", folder / "suite.toml", "-o", folder / name]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    return subprocess.Popen(list(map(str, command)), env={**os.environ, "UNSHADE_RENDER_CACHE": "off"}, **quiet)


def compare(folder: Path, whole: dict[str, str]) -> None:
    killed = digest(folder / "killed")
    differ = sorted(name for name in whole.keys() | killed.keys() if whole.get(name) != killed.get(name))
    partial = list((folder / "killed").rglob("*.partial"))
    assert not differ and not partial, (differ, partial)


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 0))

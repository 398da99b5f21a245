"""A study on three local workers, one killed in the middle, beside one process: the same bytes, and how fast.

``make heavy-cluster``, minutes. Not a test that is collected: it measures time, and wants a quiet machine. With
``--method`` a program of one's own is in the study (`tests/plain_loops.py`), which keeps one processor busy alone.
"""

from __future__ import annotations

import argparse
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

from test_run import digest

ROOT = Path(__file__).parent.parent
PROGRAM = Path(sys.executable).with_name("unshade")


def suite(folder: Path, cases: int, own: bool) -> Path:
    """Faces in two lights, of the size of the tests, with two baselines, and a program of one's own if it is wanted."""
    scene, lights = ROOT / "tests" / "scenes" / "tiny-scene.toml", ROOT / "scenes" / "lights"
    faces = ", ".join(f'{{ name = "f{n}", seed = {n}, texture_size = 128 }}' for n in range(cases // 2))
    file = folder / "study.toml"
    file.write_text(
        f'format = 1\nname = "study"\nscene = "{scene}"\nscales = ["global"]\nfaces = [{faces}]\n'
        f'lights = ["{lights}/studio.toml", "{lights}/uniform.toml"]\n'
        '[[method]]\nname = "mean_texture"\ntexture_size = 64\n[[method]]\nname = "oracle"\n'
        + ('[[method]]\nname = "loops"\npython = "plain_loops:recover"\nthreads = 1\n' if own else "")
    )
    shutil.copy(ROOT / "tests" / "plain_loops.py", folder)
    return file


def run(words: list[object], kill: bool = False) -> float:
    """Seconds of a run; with ``kill``, a worker dies once the first scores are there."""
    start = time.monotonic()
    with subprocess.Popen([str(PROGRAM), "run", *map(str, words)], stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        for line in process.stderr:
            if kill and line.startswith("scores/"):
                kill = False
                victim = _workers(process.pid)[0]
                os.kill(victim, signal.SIGKILL)
                print(f"killed a worker, process {victim}", flush=True)
    assert process.returncode == 0, process.returncode
    return time.monotonic() - start


def _workers(ancestor: int) -> list[int]:
    """Processes of Dask's workers below one: those whose parent is a nanny's, by their thread."""
    below, found = {ancestor}, []
    for status in sorted(Path("/proc").glob("[0-9]*/stat"), key=lambda path: int(path.parent.name)):
        try:
            fields = status.read_text().rsplit(")", 1)[1].split()
            command = (status.parent / "cmdline").read_bytes()
        except (OSError, IndexError):
            continue
        if int(fields[1]) in below:
            below.add(int(status.parent.name))
            if b"spawn_main" in command:
                found.append(int(status.parent.name))
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--cases", type=int, default=24)
    parser.add_argument("--workers", type=int, default=3)
    parser.add_argument("--method", action="store_true")
    options = parser.parse_args()
    options.folder.mkdir(parents=True)
    os.environ["UNSHADE_RENDER_CACHE"] = "off"
    study = suite(options.folder, options.cases, options.method)
    cluster = run([study, "-o", options.folder / "many", "--cluster", "local", "--jobs", options.workers], kill=True)
    jobs = run([study, "-o", options.folder / "jobs", "--jobs", len(os.sched_getaffinity(0))])
    alone = run([study, "-o", options.folder / "one"])
    assert digest(options.folder / "many") == digest(options.folder / "one") == digest(options.folder / "jobs")
    print(
        f"{options.cases} cases: one process {alone:.0f} s, --jobs {jobs:.0f} s, {options.workers} workers {cluster:.0f} s"
    )


if __name__ == "__main__":
    main()

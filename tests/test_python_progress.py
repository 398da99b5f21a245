"""`progress=` of the stages: what it hears, and how it stops them."""

from __future__ import annotations

import os
import shutil
import signal
import threading
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import unshade
from conftest import CASE, QUICK
from unshade.errors import Stopped, UnshadeError

SUITE = Path(__file__).parent / "scenes" / "tiny.toml"


@pytest.fixture(autouse=True)
def ctrl_c_is_heard() -> Iterator[None]:
    """A shell's background jobs, as `make test &`, ignore Ctrl-C, and Python then leaves it ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_a_finished_run_tells_every_stage(tiny_run: Path, tmp_path: Path) -> None:
    run = tmp_path / "run"
    shutil.copytree(tiny_run, run)
    heard: list[tuple[int, int, str]] = []
    threads = set()

    def progress(*step) -> None:
        heard.append(step)
        threads.add(threading.current_thread())

    page = unshade.run(SUITE, run, progress=progress)
    assert threads == {threading.current_thread()}
    assert page == run / "report" / "index.html"
    stages = {what.split(":")[0] for _, _, what in heard}
    assert f"capture/{CASE}" in stages and f"scores/{CASE}/oracle" in stages and "report" in stages
    counts = [done for done, _, _ in heard]
    assert counts == sorted(counts) and heard[-1] == (11, 11, "report")


@pytest.mark.parametrize("stage", ["synth", "relight", "run", "report"])
@pytest.mark.parametrize("how", ["STOP", "exception", "Ctrl-C"])
def test_a_stage_stops_when_it_is_asked_to(stage: str, how: str, tiny_run: Path, tmp_path: Path) -> None:
    heard = []

    def progress(*step: object) -> object:
        heard.append(step)
        if how == "exception":
            raise LookupError("enough")
        if how == "Ctrl-C":
            os.kill(os.getpid(), signal.SIGINT)
        return unshade.STOP if how == "STOP" else None

    out = tmp_path / "out"
    calls = {
        "synth": lambda: unshade.synth(SUITE.with_name("tiny-scene.toml"), out, progress=progress),
        "relight": lambda: unshade.relight(
            tiny_run / "captures" / CASE, tiny_run / "maps" / CASE / "quick", out, progress=progress
        ),
        "run": lambda: unshade.run(SUITE, out, progress=progress),
        "report": lambda: unshade.report(tiny_run, out, progress=progress),
    }
    raised = {"STOP": Stopped, "exception": LookupError, "Ctrl-C": KeyboardInterrupt}[how]
    with pytest.raises(raised) as caught:
        calls[stage]()
    assert len(heard) == 1 and not (out / "report").exists()
    if how == "STOP":
        assert isinstance(caught.value, UnshadeError) and caught.value.exit_code == 3
        assert "run the same command to resume" in str(caught.value)


def test_no_falsy_answer_stops_a_stage(tiny_run: Path, tmp_path: Path) -> None:
    answers = iter([False, 0, "", [], None, np.False_])
    page = unshade.report(tiny_run, tmp_path / "report", progress=lambda *_: next(answers, False))
    assert page.is_file() and repr(unshade.STOP) == "unshade.STOP"


@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="counts threads as Linux lists them")
def test_ctrl_c_ends_a_call_that_tells_nothing(tiny_run: Path) -> None:
    """It comes once the call has threads of its own: without a callback nothing else would see it before the end."""
    tasks = Path("/proc/self/task")
    done = threading.Event()

    def interrupt() -> None:
        before = len(list(tasks.iterdir()))
        ready.set()
        while len(list(tasks.iterdir())) <= before and not done.is_set():
            pass
        os.kill(os.getpid(), signal.SIGINT)

    case = tiny_run / "captures" / CASE
    for call in (
        lambda: unshade.score(case, tiny_run / "maps" / CASE / "quick", relit=tiny_run / "relit" / CASE / "quick"),
        lambda: unshade.solve(case, config=QUICK),
    ):
        done.clear()
        ready = threading.Event()
        thread = threading.Thread(target=interrupt)
        with pytest.raises(KeyboardInterrupt):
            try:
                thread.start()
                ready.wait()
                call()
                pytest.fail("came to its end")
            finally:
                done.set()
        thread.join()


def test_ctrl_c_stops_a_solve(tiny_run: Path) -> None:
    heard = []

    def progress(*step: object) -> None:
        heard.append(step)
        os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        unshade.solve(tiny_run / "captures" / CASE, config=QUICK, progress=progress)
    assert len(heard) == 1

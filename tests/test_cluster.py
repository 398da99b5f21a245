"""A suite on a real scheduler and real workers, which die, come late and start again."""

from __future__ import annotations

import os
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest
from test_run import digest

from conftest import TINY

pytest.importorskip("distributed", reason="needs unshade[cluster]")

BIN = Path(sys.executable).parent


@contextmanager
def process(*words: object, log: Path) -> Iterator[subprocess.Popen[bytes]]:
    with log.open("ab") as said, subprocess.Popen([*map(str, words)], stdout=said, stderr=said) as started:
        try:
            yield started
        finally:
            started.kill()


def free_port() -> int:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        return taken.getsockname()[1]


@pytest.mark.heavy
def test_lost_worker_and_restarted_scheduler_give_identical_bytes(tiny_run: Path, tmp_path: Path) -> None:
    """Killed: the worker that rendered, as soon as it is done, and later the scheduler with all that is left."""
    address = f"tcp://127.0.0.1:{(port := free_port())}"
    run, log = tmp_path / "run", tmp_path / "log.txt"
    with ExitStack() as running:

        def scheduler() -> subprocess.Popen[bytes]:
            words = ["scheduler", "--host", "127.0.0.1", "--port", port, "--no-dashboard", "--no-jupyter"]
            return running.enter_context(process(BIN / "dask", *words, log=log))

        def worker(name: str) -> subprocess.Popen[bytes]:
            place = tmp_path / name
            words = ["worker", address, "--nthreads", 1, "--no-nanny", "--no-dashboard", "--name", name]
            return running.enter_context(process(BIN / "dask", *words, "--local-directory", place, log=log))

        first, workers = scheduler(), {name: worker(name) for name in ("one",)}
        command = [BIN / "unshade", "run", TINY, "-o", run, "--cluster", address, "--store", tmp_path / "store"]
        unshade = running.enter_context(
            subprocess.Popen([*map(str, command)], stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        )
        assert unshade.stderr is not None
        said: list[str] = []
        for line in unshade.stderr:
            said.append(line)
            if line.startswith("capture/"):
                # What it knows of the capture is gone with it; what it left is in the store.
                workers["one"].send_signal(signal.SIGKILL)
                workers |= {name: worker(name) for name in ("two", "three")}
            elif line.startswith("scores/") and first.poll() is None:
                first.send_signal(signal.SIGKILL)
                for name in ("two", "three"):
                    workers[name].send_signal(signal.SIGKILL)
                scheduler()
                worker("late")
        assert unshade.wait(timeout=60) == 0, "".join(said) + log.read_text()[-2000:]
    assert "10 stages run, 0 still valid" in "".join(said), said
    assert said.count(next(line for line in said if line.startswith("capture/"))) == 1
    assert digest(run) == digest(tiny_run)


def test_program_output_returns_from_more_workers_than_processors(tiny_run: Path, tmp_path: Path) -> None:
    relit = 'mkdir -p "$2/relit/uniform"; cp "$1/images/000.exr" "$2/relit/uniform/004.exr"'
    (tmp_path / "grey.sh").write_text(f"echo all is grey; {relit}\n")
    (tmp_path / "none.sh").write_text("echo there is no face >&2; exit 1\n")
    method = '[[method]]\nname = "{0}"\ncommand = ["sh", "{0}.sh", "{{capture}}", "{{maps}}"]\ngives = "pictures"\n'
    methods = "".join(method.format(name) for name in ("grey", "none"))
    suite = tmp_path / "suite.toml"
    suite.write_text(f'format = 1\nname = "own"\nscene = "{TINY.parent / "tiny-scene.toml"}"\n{methods}')
    shutil.copytree(tiny_run, tmp_path / "run")
    words = [BIN / "unshade", "run", suite, "-o", tmp_path / "run", "--cluster", "local"]
    workers = len(os.sched_getaffinity(0)) + 1
    done = subprocess.run([*map(str, words), "--jobs", str(workers)], capture_output=True, text=True)
    assert done.returncode == 1 and "there is no face" in done.stderr, done.stderr
    logs = {path.stem: path.read_text() for path in (tmp_path / "run" / "logs").rglob("*.txt")}
    assert "all is grey" in logs["grey"] and "there is no face" in logs["none"]
    assert [path.stem for path in (tmp_path / "run" / "scores").rglob("[gn]*.json")] == ["grey"]


def test_missing_scheduler_is_a_one_line_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from unshade.cluster.client import collect
    from unshade.cluster.order import Order, Task
    from unshade.cluster.store import Store
    from unshade.errors import ClusterError

    task = Task("capture/a", (), "captures/a", "a", None, None)
    order = Order(TINY, tmp_path, "", "", (task,))
    start = time.monotonic()
    with pytest.raises(ClusterError, match="no scheduler answers.*dask scheduler"):
        collect(order, f"tcp://127.0.0.1:{free_port()}", Store(str(tmp_path)), [], lambda *_: None, patience=1.0)
    assert time.monotonic() - start < 30


def test_stages_survive_the_loss_of_scheduler_and_worker(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Lost with the first of two stages done, which is not done again; the stages write their names alone."""
    from distributed import LocalCluster

    from unshade.cluster import client
    from unshade.cluster.order import Order, Task
    from unshade.cluster.store import Store

    port, store, calls = free_port(), Store(str(tmp_path / "store")), tmp_path / "calls"

    def start() -> LocalCluster:
        options = {"n_workers": 1, "threads_per_worker": 1, "processes": False, "dashboard_address": None}
        return LocalCluster(scheduler_port=port, protocol="tcp", **options)

    def stage(job: dict[str, str], *before: object) -> dict[str, object]:
        with calls.open("a") as said:
            said.write(f"{job['id']}\n")
        made = tmp_path / job["path"].replace("/", "-")
        made.write_text(job["id"])
        content = job["path"].encode().hex().ljust(64, "0")
        store.put(content, made)
        record = {"content": content, "seconds": 0.0}
        return {"id": job["id"], "key": "", "record": record, "failed": None, "log": None, "name": None, "worker": ""}

    monkeypatch.setattr(client, "do", stage)
    monkeypatch.setattr(client._native, "adopt", lambda *_: None)
    clusters = [start()]

    def progress(done: int, *_: object) -> None:
        if done == 1:
            clusters.pop().close()
            clusters.append(start())

    tasks = (
        Task("maps/a/b", (), "maps/a/b", "a", "a/b", None),
        Task("scores/a/b", ("maps/a/b",), "scores/a/b.json", "a", "a/b", None),
    )
    try:
        found = client.collect(
            Order(TINY, tmp_path / "run", "", "", tasks), f"tcp://127.0.0.1:{port}", store, [], progress
        )
    finally:
        clusters.pop().close()
    assert found["failed"] == {} and len(found["records"]) == 2
    assert [(tmp_path / "run" / task.path).read_text() for task in tasks] == [task.id for task in tasks]
    assert calls.read_text().split().count("maps/a/b") == 1


def test_the_store_keeps_files_and_folders_by_content(tmp_path: Path) -> None:
    from unshade.cluster.store import Store

    folder = tmp_path / "maps"
    (folder / "views").mkdir(parents=True)
    (folder / "views" / "000.exr").write_bytes(b"picture")
    (tmp_path / "scores.json").write_text("{}")
    for url in (str(tmp_path / "store"), "memory://store"):
        store = Store(url)
        store.put("f" * 64, folder)
        store.put("a" * 64, tmp_path / "scores.json")
        for turn in range(2):
            # A second time it is replaced, not mixed.
            store.get("f" * 64, tmp_path / "back" / "maps")
            assert [path.name for path in (tmp_path / "back" / "maps").rglob("*.exr")] == ["000.exr"], turn
            (tmp_path / "back" / "maps" / "old.exr").touch()
        store.get("a" * 64, tmp_path / "back" / "scores.json")
        assert (tmp_path / "back" / "scores.json").read_text() == "{}"
        done = {"id": "maps/a", "record": {"content": "f" * 64}}
        store.note("k", done)
        assert store.known("k") == done and store.known("other") is None
        # A key whose output somebody removed is no key.
        store.note("k", {"id": "maps/a", "record": {"content": "0" * 64}})
        assert store.known("k") is None
    assert not list(tmp_path.rglob("*.partial")) and sorted(os.listdir(tmp_path / "back")) == ["maps", "scores.json"]


def test_workers_of_one_machine_divide_its_processors() -> None:
    from unshade.cluster.command import divided

    parts = divided(list(range(7)), 3)
    assert [one for part in parts for one in part] == list(range(7)) and {len(part) for part in parts} == {2, 3}
    assert divided([4, 6], 3) == [[4], [6]]

"""The work of a worker: one stage at a time, in a folder of its own."""

from __future__ import annotations

import fcntl
import hashlib
import json
import os
import shutil
import threading
import time
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypedDict

from distributed import get_worker

from .. import _native
from .store import Store


class StageOutcome(TypedDict):
    """Outcome of a stage."""

    id: str
    key: str
    record: dict[str, Any] | None
    """With the hash of its output, unless its method failed."""
    failed: str | None
    log: str | None
    """Hash of the output that its program printed."""
    name: str | None
    worker: str


class Job(TypedDict):
    """A stage, with all that a worker needs for it."""

    id: str
    case: str
    name: str | None
    path: str
    inputs: dict[str, str]
    """Where each input lies below a run, by the stage that made it."""
    suite: str
    suite_content: str
    versions: str
    store: str
    processors: list[list[int]]
    """Shares of this machine's processors, one for each simultaneous stage; none where each worker has its own machine."""


# Dask has its workers give memory back at once, which costs a renderer that one of them starts a third of its time.
os.environ.pop("MALLOC_TRIM_THRESHOLD_", None)

_ALONE = threading.Lock()
_CHECKED: dict[tuple[str, str], dict[str, str]] = {}
"""The renderer's versions and code, by suites and versions that were compared."""


def do(job: Job, *before: StageOutcome) -> StageOutcome:
    """Does a stage, or takes its outcome from the store. A fault of its method is a result, all others are raised."""
    for earlier in before:
        if earlier["failed"] is not None:
            return _done(job, "", failed=earlier["failed"])
    with _ALONE:
        checked = (job["suite_content"], job["versions"])
        if checked not in _CHECKED:
            _CHECKED[checked] = _native.check_worker(job["suite"], *checked)
        store = Store(job["store"])
        records = {earlier["id"]: earlier["record"] or {} for earlier in before}
        place = Path(get_worker().local_directory) / f"unshade-{job['suite_content'][:12]}"
        part = job["suite"], place, job["id"], json.dumps(records), _CHECKED[checked]
        key = json.loads(_native.run_remote_stage(*part, True, None))["key"]
        known = store.known(key)
        if known is not None:
            return _done(job, key, record=known["record"], log=known.get("log"))
        _forget_other_cases(place, job["case"])
        for stage, record in records.items():
            _bring(store, place, job["inputs"][stage], record["content"])
        with _share(job) as processors:
            outcome = json.loads(_native.run_remote_stage(*part, False, processors))
        log = _keep_log(store, place, job)
        if outcome["failed"] is not None:
            return _done(job, key, failed=outcome["failed"], log=log)
        record = outcome["record"]
        store.put(record["content"], place / job["path"])
        store.note(key, {"id": job["id"], "record": record, "log": log})
        _note(place / job["path"], record["content"])
        return _done(job, key, record=record, log=log)


def _done(
    job: Job, key: str, record: dict[str, Any] | None = None, failed: str | None = None, log: str | None = None
) -> StageOutcome:
    worker = str(get_worker().name)
    return {
        "id": job["id"], "key": key, "record": record, "failed": failed, "log": log, "name": job["name"],
        "worker": worker,
    }  # fmt: skip


def _keep_log(store: Store, place: Path, job: Job) -> str | None:
    """Stores the output that the program of a maps stage printed; returns its hash, None without a program."""
    log = place / log_path(job["id"])
    if not job["id"].startswith("maps/") or not log.is_file():
        return None
    content = hashlib.blake2b(log.read_bytes(), digest_size=16).hexdigest()
    store.put(content, log)
    return content


def log_path(stage: str) -> Path:
    """The place below a run for the output that a stage's program prints."""
    return Path("logs") / f"{stage.partition('/')[2]}.txt"


@contextmanager
def _share(job: Job) -> Generator[list[int] | None]:
    """Processors that no other stage of a worker on this machine has until this one ends; None for all."""
    folder = Path(get_worker().local_directory).parent
    while job["processors"]:
        for at, share in enumerate(job["processors"]):
            with (folder / f"processors-{at}.lock").open("w") as file:
                try:
                    # The system unlocks it if this worker dies.
                    fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                except BlockingIOError:
                    continue
                yield share
                return
        time.sleep(0.05)
    yield None


def _bring(store: Store, place: Path, path: str, content: str) -> None:
    output = place / path
    note = _note_of(output)
    if not (output.exists() and note.is_file() and note.read_text() == content):
        note.unlink(missing_ok=True)
        store.get(content, output)
        _note(output, content)


def _note(output: Path, content: str) -> None:
    _note_of(output).write_text(content)


def _note_of(output: Path) -> Path:
    return output.with_name(f".{output.name}.content")


def _forget_other_cases(place: Path, case: str) -> None:
    """Removes the files of other cases: a worker's disc holds one case, and the store has the rest."""
    for folder in place.glob("*/*"):
        if folder.is_dir() and folder.parent.name != "stages" and folder.name != case:
            shutil.rmtree(folder)

"""The work of a worker: one stage at a time, in a folder of its own."""

from __future__ import annotations

import json
import os
import shutil
import threading
from pathlib import Path
from typing import Any, TypedDict

from distributed import get_worker

from .. import _native
from .store import Store


class Done(TypedDict):
    """Outcome of a stage."""

    id: str
    key: str
    record: dict[str, Any] | None
    """With the hash of its output, unless its method failed."""
    failed: str | None
    name: str | None
    worker: str


class Job(TypedDict):
    """A stage with all that a worker has to know of it."""

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
    """Processors of each worker, of workers on this machine alone."""


_ALONE = threading.Lock()
_CHECKED: dict[tuple[str, str], str] = {}
"""The renderer's fingerprint, by suites and versions that were compared."""


def do(job: Job, *before: Done) -> Done:
    """Do a stage, or take what the store knows of it. A fault of its method is a result, all else is raised."""
    for earlier in before:
        if earlier["failed"] is not None:
            return _done(job, "", failed=earlier["failed"])
    with _ALONE:
        _keep_to_processors(job)
        checked = (job["suite_content"], job["versions"])
        if checked not in _CHECKED:
            _CHECKED[checked] = _native.check_worker(job["suite"], *checked)
        store = Store(job["store"])
        contents = {earlier["id"]: (earlier["record"] or {})["content"] for earlier in before}
        place = Path(get_worker().local_directory) / f"unshade-{job['suite_content'][:12]}"
        part = job["suite"], place, job["id"], contents, _CHECKED[checked]
        key = json.loads(_native.run_part(*part, True))["key"]
        known = store.known(key)
        if known is not None:
            return _done(job, key, record=known["record"])
        _forget_other_cases(place, job["case"])
        for stage, content in contents.items():
            _bring(store, place, job["inputs"][stage], content)
        said = json.loads(_native.run_part(*part, False))
        if said["failed"] is not None:
            return _done(job, key, failed=said["failed"])
        store.put(said["record"]["content"], place / job["path"])
        store.note(key, {"id": job["id"], "record": said["record"]})
        _note(place / job["path"], said["record"]["content"])
        return _done(job, key, record=said["record"])


def _done(job: Job, key: str, record: dict[str, Any] | None = None, failed: str | None = None) -> Done:
    worker = str(get_worker().name)
    return {"id": job["id"], "key": key, "record": record, "failed": failed, "name": job["name"], "worker": worker}


def _keep_to_processors(job: Job) -> None:
    """The share of this worker; what it starts inherits it."""
    if job["processors"] and hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, job["processors"][int(get_worker().name) % len(job["processors"])])


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
    """A worker's disc holds one case: what it needs of another is in the store."""
    for folder in place.glob("*/*"):
        if folder.is_dir() and folder.parent.name != "stages" and folder.name != case:
            shutil.rmtree(folder)

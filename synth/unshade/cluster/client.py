"""Hands the stages of an order to Dask and fetches their outputs, even if workers or the scheduler are lost."""

from __future__ import annotations

import hashlib
import json
import queue
import time
from collections.abc import Callable
from typing import Any

from distributed import Client, Future
from distributed.scheduler import KilledWorker

from .. import _native
from ..errors import ClusterError, UnshadeError
from .order import Order, Task
from .store import Store
from .work import Job, StageOutcome, do, log_path

RETRIES = 2
"""Further attempts at a stage after an error outside the method: a full disc, a store out of reach."""
PATIENCE = 300.0
"""Seconds that a scheduler may be away."""
_LOST = (OSError, TimeoutError)

_Progress = Callable[[int, int, str], None]


def collect(
    order: Order,
    address: str,
    store: Store,
    processors: list[list[int]],
    progress: _Progress,
    patience: float = PATIENCE,
) -> dict[str, Any]:
    """Does all stages; returns ``{"failed": ..., "records": ...}``, with all outputs in the run's folder."""
    done: dict[str, StageOutcome] = {}
    for task in order.tasks:
        if task.output is not None:
            store.put(task.output["content"], order.run / task.path)
            done[task.id] = _valid(task, task.output)
    records: list[dict[str, Any]] = []
    failed: dict[str, str] = {}
    while len(done) < len(order.tasks):
        try:
            with _connected(address, patience) as client:
                _round(order, client, store, processors, done, records, failed, progress)
        except _Interrupted:
            progress(len(done), len(order.tasks), "the scheduler is away; waiting for it")
    return {"failed": failed, "records": records}


class _Interrupted(Exception):
    """The scheduler went away; the store keeps its content."""


def _connected(address: str, patience: float) -> Client:
    end = time.monotonic() + patience
    while True:
        try:
            return Client(address, timeout=min(10.0, patience), set_as_default=False)
        except _LOST as error:
            if time.monotonic() > end:
                raise ClusterError(
                    f"{address}: no scheduler answers: {error}; start one with `dask scheduler`"
                ) from error
            time.sleep(0.5)
        except ValueError as error:
            raise ClusterError(f"{address}: is not a scheduler's address: {error}; write tcp://host:8786") from error


def _round(
    order: Order, client: Client, store: Store, processors: list[list[int]], done: dict[str, StageOutcome],
    records: list[dict[str, Any]], failed: dict[str, str], progress: _Progress,
) -> None:  # fmt: skip
    """Does all remaining stages. Raises `_Interrupted` if the scheduler goes away."""
    tasks = {task.id: task for task in order.tasks}
    # Stages of the same name differ between suites and versions.
    suffix = hashlib.blake2b(f"{order.suite_content} {order.versions}".encode(), digest_size=8).hexdigest()
    futures: dict[str, Future] = {}
    for at, task in enumerate(order.tasks):
        if task.id in done:
            continue
        before = [done.get(stage) or futures[stage] for stage in task.after]
        futures[task.id] = client.submit(
            do, _job(order, task, tasks, store, processors), *before,
            key=f"{task.id}-{suffix}",
            retries=RETRIES, priority=-at, pure=False,
        )  # fmt: skip
    finished: queue.Queue[Future] = queue.Queue()
    for future in futures.values():
        future.add_done_callback(finished.put)
    while len(done) < len(order.tasks):
        try:
            future = finished.get(timeout=1.0)
        except queue.Empty:
            if client.status != "running":
                raise _Interrupted from None
            continue
        if future.status in ("cancelled", "lost"):
            raise _Interrupted
        result = _result(future)
        task = tasks[result["id"]]
        if result["log"] is not None:
            store.get(result["log"], order.run / log_path(task.id))
        if result["record"] is not None:
            content = result["record"]["content"]
            store.get(content, order.run / task.path)
            _native.adopt(order.run, result["key"], task.id, json.dumps(result["record"]))
            records.append(result["record"])
            event = {"stage": task.id, "seconds": result["record"]["seconds"], "worker": result["worker"]}
            progress(len(done) + 1, len(order.tasks), json.dumps(event))
        elif result["name"] is not None and result["failed"] is not None:
            failed.setdefault(result["name"], result["failed"])
        done[task.id] = result


def _result(future: Future) -> StageOutcome:
    try:
        result: StageOutcome = future.result()
    except KilledWorker as error:
        raise ClusterError(f"{future.key}: its worker died at each attempt, perhaps out of memory: {error}") from error
    except UnshadeError:
        raise
    except _LOST as error:
        raise ClusterError(f"{future.key}: {error}") from error
    return result


def _job(order: Order, task: Task, tasks: dict[str, Task], store: Store, processors: list[list[int]]) -> Job:
    return {
        "id": task.id, "case": task.case, "name": task.name, "path": task.path,
        "inputs": {stage: tasks[stage].path for stage in task.after},
        "suite": str(order.suite), "suite_content": order.suite_content, "versions": order.versions,
        "store": store.url, "processors": processors,
    }  # fmt: skip


def _valid(task: Task, output: dict[str, str]) -> StageOutcome:
    record = {"id": task.id, **output}
    return {
        "id": task.id, "key": "", "record": record, "failed": None, "log": None, "name": task.name, "worker": "",
    }  # fmt: skip

"""Stages to be done, as ``unshade run --cluster`` requests them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Task:
    """A stage of a suite."""

    id: str
    """``<kind>/<case>[/<method>]``."""
    after: tuple[str, ...]
    """Stages whose outputs it reads."""
    path: str
    """Its output, below the run's folder."""
    case: str
    name: str | None
    """``<case>/<method>`` of a stage that fails with its method."""
    output: dict[str, str] | None
    """Hashes of an output that is valid already."""


@dataclass(frozen=True)
class Order:
    """A suite's stages, in the order in which one process does them."""

    suite: Path
    run: Path
    suite_content: str
    versions: str
    tasks: tuple[Task, ...]


def read_order(request: dict[str, Any]) -> Order:
    """The order of a request."""
    tasks = tuple(
        Task(
            id=task["id"], after=tuple(task["after"]), path=task["path"], case=task["case"],
            name=task["name"], output=task["output"],
        )
        for task in request["tasks"]
    )  # fmt: skip
    return Order(Path(request["suite"]), Path(request["run"]), request["suite_content"], request["versions"], tasks)

"""Stages to be done, as ``unshade run --cluster`` writes it down."""

from __future__ import annotations

import json
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


def read_order(path: Path) -> Order:
    """The order in a file that unshade wrote."""
    order: dict[str, Any] = json.loads(path.read_text())
    tasks = tuple(
        Task(
            id=task["id"], after=tuple(task["after"]), path=task["path"], case=task["case"],
            name=task["name"], output=task["output"],
        )
        for task in order["tasks"]
    )  # fmt: skip
    return Order(Path(order["suite"]), Path(order["run"]), order["suite_content"], order["versions"], tasks)

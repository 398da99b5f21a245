"""Runs the commands of the command line from Python, each as one request."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from typing import Any

from . import _native

Progress = Callable[[int, int, str], object]


def command(
    name: str, *, progress: Progress | None = None, wrong: type[Exception] = ValueError, **arguments: object
) -> Any:
    """Runs a command and returns its result, or None without one; an unsupported argument raises ``wrong``."""
    request = json.dumps({"command": name, **arguments}, default=_plain)
    try:
        text = _native.command(request, progress)
    except ValueError as error:
        raise wrong(f"{name}: {error}") from None
    return json.loads(text) if text else None


def _plain(value: Any) -> object:
    """A path as text, or an integer of numpy as a number of JSON."""
    return value.__index__() if hasattr(value, "__index__") else os.fspath(value)

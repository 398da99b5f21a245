"""Commands of the command line, from Python: one request, as its arguments state it."""

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
    """Run a command and return its result, or None without one; an argument that it cannot take raises ``wrong``."""
    request = json.dumps({"command": name, **arguments}, default=_plain)
    try:
        text = _native.command(request, progress)
    except ValueError as error:
        raise wrong(f"{name}: {error}") from None
    return json.loads(text) if text else None


def _plain(value: Any) -> object:
    """Paths, and the whole numbers of numpy."""
    return value.__index__() if hasattr(value, "__index__") else os.fspath(value)

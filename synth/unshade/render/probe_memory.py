"""What child processes found out about this machine's renderers, kept as it takes them seconds."""

from __future__ import annotations

import json
import os

from ..cache_folder import cache_folder


def recall() -> dict[str, str]:
    """All that is known; nothing if it cannot be read."""
    try:
        known = json.loads((cache_folder() / "llvm-probes.json").read_text())
    except (OSError, ValueError):
        return {}
    return known if isinstance(known, dict) else {}


def remember(key: str, answer: str) -> None:
    """Adds an answer."""
    memory = cache_folder() / "llvm-probes.json"
    partial = memory.with_name(f"{memory.name}.{os.getpid()}.partial")
    try:
        memory.parent.mkdir(parents=True, exist_ok=True)
        partial.write_text(json.dumps(recall() | {key: answer}, indent=1, sort_keys=True))
        partial.replace(memory)
    except OSError:
        # A cache that cannot be written costs two seconds at the next start, nothing else.
        partial.unlink(missing_ok=True)

"""The examples of README.md and docs/, as they stand: Python, and commands."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

ROOT = Path(__file__).parents[1]
_BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def examples(language: str = "python") -> dict[str, str]:
    """Every example of a language by the place where it begins: ``README.md:57``."""
    found = {}
    for page in (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))):
        text = page.read_text()
        for block in _BLOCK.finditer(text):
            if block.group(1) == language:
                line = text.count("\n", 0, block.start(2)) + 1
                found[f"{page.relative_to(ROOT)}:{line}"] = block.group(2)
    return found


def commands() -> dict[str, list[str]]:
    """The words of every command line of ``make`` or ``unshade`` by its place; their blocks name no language."""
    lines = {}
    for place, text in examples("").items():
        page, first = place.split(":")
        for number, line in enumerate(text.splitlines(), int(first)):
            if line.split(" ")[0] in ("make", "unshade"):
                lines[f"{page}:{number}"] = shlex.split(line, comments=True)
    return lines

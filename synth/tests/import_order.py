"""Checks that the modules of `unshade` import in one direction.

    python synth/tests/import_order.py        one line for each fault; exit code 1 if there is any

A room is a module or a package directly below `unshade`. A module imports from rooms that stand before its own and
from its own, where no circle is allowed. Imports inside functions count; those for type checkers alone do not.
"""

from __future__ import annotations

import sys
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import unshade
from unshade.fingerprint import imports_of

ROOMS = [
    "errors", "stopping", "cache_folder", "fingerprint", "srgb", "vectors", "stated_light", "tables", "documents", "commands", "exr", "thumbnails", "maps",
    "perceptual", "metrics", "scores", "own_metrics", "stages", "head_page", "studies",
    "face", "files", "own_head", "scene_file", "bookkeeping", "heads", "camera", "captured_mesh", "formation",
    "importing", "render", "surface", "cycles", "exporting", "methods",
    "figures", "history_chart", "cluster", "plugin", "stage", "__main__",
]  # fmt: skip
"""From the lowest room to the highest."""


def modules(package: Path) -> dict[str, set[str]]:
    """Every module of the package, with the modules that it imports; those above it in its own packages left out."""
    files = (path.relative_to(package).with_suffix("") for path in package.rglob("*.py"))
    names = (".".join(part for part in file.parts if part != "__init__") for file in files)
    return {
        name: {other for other in imports_of(name) if not f"{name}.".startswith(f"{other}.")} for name in names if name
    }


def faults(imports: dict[str, set[str]], rooms: list[str]) -> list[str]:
    """A line for each import of a later room, each room without a place, and a circle."""
    place = {room: number for number, room in enumerate(rooms)}
    room = lambda module: module.partition(".")[0]
    found = [f"{name}: its room has no place in ROOMS" for name in imports if room(name) not in place]
    found += [
        f"{name} imports {other}, whose room stands later"
        for name, others in imports.items()
        for other in sorted(others)
        if place.get(room(other), 0) > place.get(room(name), len(rooms))
    ]
    try:
        TopologicalSorter(imports).prepare()
    except CycleError as error:
        found.append(f"circle: {' imported by '.join(error.args[1])}")
    return found


def main() -> int:
    found = faults(modules(Path(unshade.__file__).parent), ROOMS)
    print("\n".join(found) or "imports of Python modules: in order")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())

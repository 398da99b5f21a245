"""Says which files of the Rust crates import one another in a circle.

    python tests/import_circles.py        one line for each crate; exit code 1 where there is a circle

A file imports what its `use` lines and paths name, in the file that defines it: re-exports are followed. What
stands under `#[cfg(test)]` is left out, and a re-export that its own file does not use is no import.
"""

from __future__ import annotations

import re
import sys
from dataclasses import dataclass, field
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]

# Comments and texts, where a path says nothing.
SILENT = re.compile(r'//[^\n]*|/\*.*?\*/|\bb?r(#*)".*?"\1|"(?:\\.|[^"\\])*"|\'(?:\\.[^\']*|[^\\\'])\'', re.DOTALL)
USE = re.compile(r"(\bpub(?:\([^)]*\))?\s+)?\buse\s+([^;]+);")
MODULE = re.compile(r'(?:#\[path\s*=\s*"([^"]+)"\]\s*)?(?:\bpub(?:\([^)]*\))?\s+)?\bmod\s+(\w+)\s*;')
PATH = re.compile(r"(?<![\w:])[A-Za-z_]\w*(?:\s*::\s*[A-Za-z_]\w*)+")
TEST = re.compile(r"#\[cfg\(test\)\]")


@dataclass(eq=False)
class Module:
    """A module of a crate that has a file of its own."""

    file: Path
    parent: Module | None
    children: dict[str, Module] = field(default_factory=dict)
    # Where each name that a `use` brings in comes from; those that are only handed on; modules taken whole.
    imported: dict[str, list[str]] = field(default_factory=dict)
    handed_on: set[str] = field(default_factory=set)
    whole: list[list[str]] = field(default_factory=list)
    body: str = ""

    def root(self) -> Module:
        return self.parent.root() if self.parent else self

    def walk(self) -> list[Module]:
        return [self, *(module for child in self.children.values() for module in child.walk())]


def without_tests(text: str) -> str:
    """Drop each item under `#[cfg(test)]`: up to its semicolon, or to the end of its braces."""
    while found := TEST.search(text):
        end = found.end()
        depth = 0
        while end < len(text):
            letter = text[end]
            end += 1
            depth += (letter == "{") - (letter == "}")
            if depth == 0 and letter in ";}":
                break
        text = text[: found.start()] + text[end:]
    return text


def branches(tree: str, start: list[str] | None = None) -> list[tuple[str, list[str]]]:
    """Each name that a tree of a `use` brings in, with its path: `a::{b, c as d}` is b and d."""
    head, brace, rest = tree.partition("{")
    steps = [*(start or []), *(part.strip() for part in head.split("::") if part.strip())]
    if not brace:
        last, _, alias = steps.pop().partition(" as ")
        # `a::{self}` names the module before the brace.
        steps += [] if last == "self" and start else [last]
        return [(alias.strip() or steps[-1], steps)]
    parts, depth = [""], 0
    for letter in rest.rpartition("}")[0]:
        depth += (letter == "{") - (letter == "}")
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return [found for part in parts if part.strip() for found in branches(part, steps)]


def read(file: Path, folder: Path, parent: Module | None = None) -> Module:
    """The module of a file and those below it, whose files stand in `folder`."""
    module = Module(file, parent)
    source = file.read_text()
    # Paths of `#[path]` are texts too.
    named = lambda found: source.endswith("path = ", 0, found.start())  # noqa: E731
    text = without_tests(SILENT.sub(lambda found: found[0] if named(found) else " ", source))
    for path, name in MODULE.findall(text):
        places = [folder / path] if path else [folder / f"{name}.rs", folder / name / "mod.rs"]
        for place in places:
            if place.is_file():
                module.children[name] = read(place, folder / name, module)
    for public, tree in USE.findall(text):
        for name, steps in branches(" ".join(tree.split())):
            if name == "*":
                module.whole.append(steps[:-1])
            else:
                module.imported[name] = steps
                if public:
                    module.handed_on.add(name)
    module.body = USE.sub(" ", text)
    return module


def defined_in(module: Module, steps: list[str], depth: int = 0) -> Module | None:
    """The module whose file defines what a path names; None for a module itself and for other crates."""
    if depth > 20:
        return None
    here: Module = module
    moved = False
    for at, step in enumerate(steps):
        if step in ("crate", "self", "super"):
            there = {"crate": here.root(), "self": here, "super": here.parent}[step]
            if there is None:
                return None
            here = there
        elif step in here.children:
            here = here.children[step]
        elif step in here.imported and here.imported[step] != steps[at:]:
            return defined_in(here, [*here.imported[step], *steps[at + 1 :]], depth + 1)
        elif moved:
            for whole in here.whole if step != "*" else []:
                if (found := defined_in(here, [*whole, step], depth + 1)) and re.search(rf"\b{step}\b", found.body):
                    return found
            return here
        else:
            return None
        moved = True
    return None


def imports(crate: Module) -> dict[Module, set[Module]]:
    """Of each file of a crate, the files that it imports."""
    return {module: {there for there in named(module) if there is not module} for module in crate.walk()}


def named(module: Module) -> list[Module]:
    paths = [steps for name, steps in module.imported.items()
             if name not in module.handed_on or re.search(rf"\b{name}\b", module.body)]
    paths += [re.split(r"\s*::\s*", path) for path in PATH.findall(module.body)]
    # A module taken whole counts as imported.
    paths += [[*whole, "*"] for whole in module.whole]
    return [there for steps in paths if (there := defined_in(module, steps))]


def circle(crate: Module) -> list[str]:
    """The files of one circle, the first again at the end; empty if there is none."""
    graph = {id(module): {id(there) for there in found} for module, found in imports(crate).items()}
    files = {id(module): str(module.file) for module in crate.walk()}
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return [files[module] for module in error.args[1]]
    return []


def crates(root: Path) -> list[Module]:
    """The libraries of the workspace."""
    members = re.search(r"^members = \[(.*?)\]", (root / "Cargo.toml").read_text(), re.DOTALL | re.MULTILINE)
    folders = re.findall(r'"([^"]+)"', members[1]) if members else []
    return [read(root / folder / "src" / "lib.rs", root / folder / "src") for folder in folders]


def main() -> int:
    found = 0
    for crate in crates(ROOT):
        files = circle(crate)
        found += bool(files)
        print(f"{crate.file.relative_to(ROOT)}: " + (" imports ".join(files) if files else "no circle"))
    return int(found > 0)


if __name__ == "__main__":
    sys.exit(main())

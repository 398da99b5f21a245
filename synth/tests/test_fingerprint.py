"""Which stages each change of the Python sources makes stale."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import unshade
from unshade import fingerprint, stage

SOURCES = Path(unshade.__file__).parent
METHODS = {"sh-lambert", "path-traced", "binary-patterns", "flash-only", "light-stage"}
CONTROLLED = {"binary-patterns", "flash-only", "light-stage"}
RENDERING = {"capture", "lights", "mitsuba", "cycles", "photographed"}


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the sources, which are hashed in the place of the package's."""
    copy = tmp_path / "unshade"
    for path in SOURCES.rglob("*.py"):
        target = copy / path.relative_to(SOURCES)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(path.read_bytes())
    monkeypatch.setattr(unshade, "__file__", str(copy / "__init__.py"))
    return copy


def fingerprints(changed: str | None = None) -> dict[str, str]:
    """Those of all stages, with one module read again."""
    fingerprint.fingerprint.cache_clear()
    if changed is None:
        fingerprint._Code.shared.cache_clear()
    else:
        fingerprint._Code.shared()._read.pop(changed.removesuffix(".py").replace("/", "."), None)
    return {
        name: fingerprint.fingerprint(*modules, native=native)
        for name, (native, *modules) in fingerprint.STAGES.items()
    }


def test_a_stage_is_stale_after_changes_of_the_code_that_it_reaches(package: Path) -> None:
    before = fingerprints()
    for module, added, stale in (
        ("render/capture.py", "# A comment.", set()),
        ("render/capture.py", "x = 1", {"capture"}),
        ("scores.py", "x = 1", {"python"}),
        ("figures/draw.py", "x = 1", set()),
        ("methods/sh_lambert.py", "x = 1", {"sh-lambert"}),
        ("methods/laboratory.py", "x = 1", CONTROLLED),
        ("cycles/blender_child.py", "x = 1", {"cycles"}),
        ("render/shots.py", "x = 1", {"capture", "mitsuba", "cycles", "photographed", *CONTROLLED}),
        ("render/llvm.py", "x = 1", RENDERING | METHODS),
    ):
        path = package / module
        text = path.read_text()
        path.write_text(f"{text}\n{added}\n")
        now = fingerprints(module)
        assert {name for name in now if now[name] != before[name]} == stale, (module, added)
        path.write_text(text)
        assert fingerprints(module) == before
    path = package / "render" / "shots.py"
    tree = ast.parse(path.read_text())
    for node in ast.walk(tree):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)) and ast.get_docstring(node):
            node.body[0] = ast.Expr(ast.Constant("Other words."))
    # Nor does it matter where the lines are broken.
    path.write_text(ast.unparse(tree))
    assert fingerprints("render/shots.py") == before


def test_stages_begin_where_their_processes_do() -> None:
    """The modules that `stage` imports for each verb are among those that its fingerprint begins with."""
    tree = ast.parse(Path(stage.__file__).read_text())
    functions = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}
    for verb, stages in (
        ("_synth", ("capture",)), ("_lights", ("lights",)), ("_relight", ("mitsuba", "cycles", "photographed")),
        ("_lpips", ("lpips",)), ("_activate", ("capture",)),
    ):  # fmt: skip
        begins = {module for name in stages for module in fingerprint.STAGES[name][1:]}
        for node in ast.walk(functions[verb]):
            if isinstance(node, ast.ImportFrom):
                assert {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)} & begins, verb


def test_every_library_has_a_version() -> None:
    """But for those that are not installed here, which are extras."""
    missing = {word.partition("=")[0] for text in fingerprints().values() for word in text.split() if "=none" in word}
    assert missing <= {"lpips", "torch", "tomli", "mitsuba-oidn", "pyarrow"}

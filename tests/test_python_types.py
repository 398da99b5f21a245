"""The stubs that editors and type checkers read."""

from __future__ import annotations

import ast
import importlib
import inspect
import operator
import pydoc
from collections.abc import Iterator
from pathlib import Path

import pytest
from metric_stub import stub

import unshade

PACKAGE = Path(unshade.__file__).parent


def test_the_package_says_that_it_is_typed() -> None:
    assert (PACKAGE / "py.typed").exists()
    stated = (PACKAGE / "__init__.pyi").read_text()
    for name in unshade.__all__:
        assert f" as {name}\n" in stated, name


def _stated(body: list[ast.stmt], prefix: str = "") -> Iterator[tuple[str, ast.FunctionDef | ast.ClassDef]]:
    """Every function, class and member of a stub that has a docstring, by its dotted name."""
    for node in body:
        if isinstance(node, ast.ClassDef):
            yield prefix + node.name, node
            yield from _stated(node.body, f"{prefix}{node.name}.")
        elif isinstance(node, ast.FunctionDef) and not node.name.startswith("__"):
            yield prefix + node.name, node


@pytest.mark.parametrize("module", ["_native", "metrics"])
def test_help_says_what_the_stub_says(module: str) -> None:
    tree = ast.parse(stub() if module == "metrics" else (PACKAGE / f"{module}.pyi").read_text())
    loaded = importlib.import_module(f"unshade.{module}")
    for name, node in _stated(tree.body):
        if name.startswith("_"):  # types that the stub alone has
            continue
        found = operator.attrgetter(name)(loaded)
        stated = ast.get_docstring(node)
        if stated is not None:
            assert " ".join(stated.split()) == " ".join((inspect.getdoc(found) or "").split()), name
        if isinstance(node, ast.FunctionDef) and callable(found):
            arguments = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
            named = [p.name for p in inspect.signature(found).parameters.values() if p.kind != p.VAR_KEYWORD]
            assert named == [argument.arg for argument in arguments], name


def test_every_public_function_has_a_signature_and_words() -> None:
    for name in unshade.__all__:
        found = getattr(unshade, name)
        if inspect.isfunction(found):
            assert inspect.getdoc(found) and f"{name}(" in pydoc.plain(pydoc.render_doc(found)), name

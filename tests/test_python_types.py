"""The stubs that editors and type checkers read."""

from __future__ import annotations

from pathlib import Path

from metric_stub import STUB, stub

import unshade

PACKAGE = Path(unshade.__file__).parent


def test_the_stub_of_the_metrics_is_that_of_the_registry() -> None:
    assert STUB.read_text() == stub(), "run python tests/metric_stub.py"


def test_the_package_says_that_it_is_typed() -> None:
    assert (PACKAGE / "py.typed").exists()
    stated = (PACKAGE / "__init__.pyi").read_text()
    for name in unshade.__all__:
        assert f" as {name}\n" in stated, name

"""The type stub of `unshade.metrics`, made from the registry of metrics; `make build` writes it into the package.

    python tests/metric_stub.py        writes synth/unshade/metrics.pyi

A stub beside the module would hide its `Definition`, so that is stated here again.
"""

from __future__ import annotations

import inspect
import textwrap
from pathlib import Path

from unshade.metrics import DEFINITIONS, Definition, evaluate

STUB = Path(__file__).parents[1] / "synth" / "unshade" / "metrics.pyi"

_HEAD = '''# Written by tests/metric_stub.py.
from collections.abc import Iterable
from typing import Literal, NamedTuple

from numpy.typing import ArrayLike

_Scale = Literal["none", "global", "channel", "median"]

class Definition(NamedTuple):
    """Id, words, unit and direction of a metric; ``needs`` names an argument beside the mask, or is empty."""

    id: str
    name: str
    unit: str
    direction: str
    definition: str
    link: str
    needs: str

DEFINITIONS: dict[str, Definition]
'''

_EVALUATE = """
def evaluate(
    names: Iterable[str],
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
    **beside: ArrayLike,
) -> dict[str, float | None]:
"""


def stub() -> str:
    """The text of ``metrics.pyi``."""
    names = "\n".join(f'    "{name}",' for name in ("DEFINITIONS", "Definition", "evaluate", *DEFINITIONS))
    functions = "".join(map(_function, DEFINITIONS.values()))
    evaluated = textwrap.indent(f'"""{inspect.getdoc(evaluate)}\n"""\n', "    ")
    return f"{_HEAD}\n__all__ = [\n{names}\n]\n{_EVALUATE}{evaluated}{functions}"


def _function(metric: Definition) -> str:
    needs = f"    {metric.needs}: ArrayLike,\n" if metric.needs else ""
    unit = f" [{metric.unit}]" if metric.unit else ""
    words = textwrap.fill(f"{metric.name}{unit}: {metric.definition}", 96, break_long_words=False)
    doc = textwrap.indent(f'"""{words}"""', "    ")
    return (
        f"\ndef {metric.id}(\n"
        "    prediction: ArrayLike,\n"
        "    truth: ArrayLike,\n"
        "    mask: ArrayLike | None = None,\n"
        "    *,\n"
        f"{needs}"
        "    erode: bool = False,\n"
        '    scale: _Scale = "none",\n'
        f") -> float | None:\n{doc}\n"
    )


if __name__ == "__main__":
    STUB.write_text(stub())

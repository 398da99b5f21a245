"""Draws the ``figure.json`` of a figure's folder as ``figure.png`` and ``figure.pdf``.

What it says is stated in ``harness/report/src/figures/drawing.rs``: blocks of panels (pictures in rows and columns)
and of plots, one below the other. Needs the extra ``figures`` (matplotlib).
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import ReportError
from .panels import FONT, WIDTH

if TYPE_CHECKING:
    from matplotlib.figure import Figure, SubFigure

DPI = 300

Block = dict[str, Any]


def draw(folder: Path) -> list[Path]:
    """Draws the figure in `folder`; equal descriptions give equal bytes.

    Raises :class:`unshade.errors.ReportError` without matplotlib, or if a block is not known.
    """
    try:
        import matplotlib
    except ImportError as error:
        raise ReportError(
            f"matplotlib draws figures and is not installed ({error}); pip install 'unshade[figures]'"
        ) from error
    from matplotlib.figure import Figure

    from . import panels, plots

    kinds: dict[str, tuple[Callable[[Block], float], Callable[[SubFigure, list[Block], Path], None]]] = {
        "panels": (panels.height, panels.draw),
        "heat": (plots.heat_height, plots.heats),
        "lines": (plots.lines_height, plots.lines),
        "bars": (plots.bars_height, plots.bars),
    }
    described = json.loads((folder / "figure.json").read_text(encoding="utf-8"))
    groups = grouped(described["blocks"])
    unknown = {kind for kind, _ in groups} - kinds.keys()
    if unknown:
        raise ReportError(
            f"{folder / 'figure.json'}: blocks {sorted(unknown)} are not known; use one version of unshade"
        )
    plots.scale_heats([block for kind, blocks in groups if kind == "heat" for block in blocks])
    settings = {"font.size": FONT, "axes.titlesize": FONT + 1, "pdf.fonttype": 42, "axes.spines.top": False}
    with matplotlib.rc_context({**settings, "axes.spines.right": False}):
        heights = [height_of(kinds[kind][0], blocks) for kind, blocks in groups]
        figure = Figure(figsize=(WIDTH, sum(heights)), dpi=DPI)
        parts = figure.subfigures(len(groups), 1, height_ratios=heights, squeeze=False)[:, 0]
        for part, (kind, blocks) in zip(parts, groups):
            kinds[kind][1](part, blocks, folder)
        return [save(figure, folder / f"figure.{end}") for end in ("png", "pdf")]


def grouped(blocks: list[Block]) -> list[tuple[str, list[Block]]]:
    """Plots of one kind that follow each other share rows, maps of values with those of their quantity; panels have
    a row each."""
    groups: list[tuple[str, list[Block]]] = []
    for block in blocks:
        kind = block["kind"]
        joins = groups and groups[-1][0] == kind and kind != "panels"
        if joins and (kind != "heat" or groups[-1][1][-1]["label"] == block["label"]):
            groups[-1][1].append(block)
        else:
            groups.append((kind, [block]))
    return groups


def height_of(height: Callable[[Block], float], blocks: list[Block]) -> float:
    """Inches of a group: rows of as many plots as stand beside each other."""
    from .plots import COLUMNS

    rows = -(-len(blocks) // COLUMNS)
    return rows * max(map(height, blocks))


def save(figure: Figure, path: Path) -> Path:
    """Leaves out the date and the program's version, which do not describe the figure."""
    nameless = (
        {"CreationDate": None, "Producer": None, "Creator": None} if path.suffix == ".pdf" else {"Software": None}
    )
    figure.savefig(path, metadata=nameless)
    return path

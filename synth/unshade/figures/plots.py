"""Curves, bars and maps of values."""

from __future__ import annotations

import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import SubFigure

COLUMNS = 3
"""Plots beside each other."""
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000")
"""Okabe and Ito's, which the colour-blind tell apart."""

LINE = 0.12
"""Room for a line of text, inches: the name of a level, or one of a title."""

Block = dict[str, Any]


def _axes(part: SubFigure, count: int, bottom: float = 0.2, between: float = 0.55) -> list[Axes]:
    columns = min(count, COLUMNS)
    rows = -(-count // columns)
    grid = part.subplots(rows, columns, squeeze=False)
    part.subplots_adjust(
        left=0.09 if columns > 1 else 0.12, right=0.97, bottom=bottom / rows, top=1 - 0.18 / rows,
        wspace=0.45, hspace=between,
    )  # fmt: skip
    found = list(grid.flat)
    for axes in found[count:]:
        axes.set_axis_off()
    return found[:count]


def heat_height(block: Block) -> float:
    """Inches of a map of values."""
    return 1.9


def scale_heats(blocks: list[Block]) -> None:
    """Gives every map its ``range``: equal quantities have one colour scale in the whole figure."""
    for block in blocks:
        equal = (other["values"] for other in blocks if other["label"] == block["label"])
        values = [value for map_ in equal for row in map_ for value in row if value is not None]
        block["range"] = (min(values, default=0.0), max(values, default=1.0))


def heats(part: SubFigure, blocks: list[Block], folder: Path) -> None:
    """Maps of values, every cell with its number."""
    from matplotlib.ticker import MaxNLocator

    for axes, block in zip(_axes(part, len(blocks), between=0.75), blocks):
        low, high = block["range"]
        values = np.array([[np.nan if v is None else v for v in row] for row in block["values"]], dtype=float)
        shown = axes.imshow(values, origin="lower", cmap="viridis", vmin=low, vmax=high, aspect="auto")
        for (row, column), value in np.ndenumerate(values):
            light = value > (low + high) / 2
            text = "n/a" if np.isnan(value) else f"{value:.1f}"
            axes.text(column, row, text, ha="center", va="center", color="black" if light else "white")
        axes.set_xticks(range(len(block["x"])), [f"{x:g}" for x in block["x"]])
        axes.set_yticks(range(len(block["y"])), [f"{y:g}" for y in block["y"]])
        axes.set(xlabel=block["x_label"], ylabel=block["y_label"], title=block["title"])
        axes.spines[:].set_visible(False)
        axes.figure.colorbar(shown, ax=axes, fraction=0.05, pad=0.03, ticks=MaxNLocator(5, integer=True))


def lines_height(block: Block) -> float:
    """Inches of a plot of curves."""
    return 2.7


def lines(part: SubFigure, blocks: list[Block], folder: Path) -> None:
    """Curves with the interval of each point as a band; one legend beside the plots, which have the same curves."""
    from matplotlib.ticker import FuncFormatter

    plots = _axes(part, len(blocks), bottom=0.15)
    for axes, block in zip(plots, blocks):
        for at, line in enumerate(block["lines"]):
            colour, style = COLOURS[at % len(COLOURS)], "-" if at < len(COLOURS) else "--"
            axes.plot(
                line["x"], line["y"], style, marker="o", markersize=2.5, linewidth=1.2, color=colour, label=line["name"]
            )
            if any(line["interval"]):
                low, high = np.array([ends or (np.nan, np.nan) for ends in line["interval"]]).T
                axes.fill_between(line["x"], low, high, color=colour, alpha=0.15, linewidth=0)
        if block["logarithmic"]:
            axes.set_xscale("log", base=2)
            axes.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:.2g}"))
        for value in block["across"]:
            axes.axhline(value, color="0.6", linewidth=0.6, zorder=0)
        axes.set(xlabel=block["x_label"], ylabel=block["y_label"], title=block["title"])
    part.subplots_adjust(right=0.77)
    curves, names = plots[0].get_legend_handles_labels()
    names = [textwrap.fill(name, 24) for name in names]
    part.legend(curves, names, frameon=False, loc="center left", bbox_to_anchor=(0.785, 0.5), fontsize=6)


def bars_height(block: Block) -> float:
    """Inches of a plot of bars: one line each."""
    return 0.49 + _title_height(block) + 0.2 * max(len(block["bars"]), 3) + LINE * len(block["levels"])


def _title(block: Block) -> str:
    """What the bars are; of differences, below it, what they are from."""
    if block["steps"]:
        return block["label"]
    quantity, _, reference = block["title"].partition(" (")
    unbroken = reference.replace(" ± ", "\u00a0±\u00a0")
    return "\n".join([quantity, *textwrap.wrap(f"({unbroken}", 32)])


def _title_height(block: Block) -> float:
    return 0.12 + LINE * max(2, 1 + _title(block).count("\n"))


def bars(part: SubFigure, blocks: list[Block], folder: Path) -> None:
    """Bars from zero, or as steps from one to the next, with levels as lines across."""
    height = bars_height(blocks[0])
    for first, (axes, block) in enumerate(zip(_axes_of_bars(part, blocks, height), blocks)):
        names = [bar["name"] for bar in block["bars"]]
        values = [np.nan if bar["value"] is None else bar["value"] for bar in block["bars"]]
        known = [value for value in values if not np.isnan(value)]
        ends = [end for bar in block["bars"] for end in bar["interval"] or []]
        reach = [*known, *ends, *(value for _, value in block["levels"])] or [0.0]
        floor = min(reach) - 0.12 * (max(reach) - min(reach) or 1) if block["steps"] else 0.0
        before = floor
        for at, (bar, value) in enumerate(zip(block["bars"], values)):
            start = before if block["steps"] else 0.0
            worse = block["steps"] and at and value < start
            axes.barh(at, value - start, left=start, height=0.62, color=COLOURS[1] if worse else COLOURS[0], alpha=0.85)
            if bar["interval"]:
                axes.plot(bar["interval"], [at, at], color="black", linewidth=0.8)
            text = "n/a" if np.isnan(value) else f"{value:+.2f}" if not block["steps"] else f"{value:.1f}"
            ends = [start, *([] if np.isnan(value) else [value]), *(bar["interval"] or [])]
            # At the end that points away from where the bar begins.
            left = value < 0 and not block["steps"]
            place = {"xy": (min(ends) if left else max(ends), at), "xytext": (-2 if left else 2, 0)}
            axes.annotate(
                text, **place, textcoords="offset points", va="center", ha="right" if left else "left", size=6
            )
            before = before if np.isnan(value) else value
        for (name, value), style in zip(block["levels"], ("--", ":", "-.") * len(block["levels"])):
            axes.axvline(value, color="0.3", linewidth=0.8, linestyle=style, label=name)
        if block["levels"]:
            below = -0.28 / (height - 0.72 - LINE * len(block["levels"]))
            axes.legend(frameon=False, loc="upper left", bbox_to_anchor=(0, below), fontsize=6, borderaxespad=0)
        axes.set_yticks(range(len(names)), names if first % COLUMNS == 0 else [])
        axes.invert_yaxis()
        if block["steps"]:
            axes.set_xlim(floor, max(reach) + 0.14 * (max(reach) - floor))
        else:
            axes.margins(x=0.25)
            axes.axvline(0, color="black", linewidth=0.6)
        axes.set_title(_title(block))
        if not block["steps"]:
            axes.set(xlabel=block["label"])


def _axes_of_bars(part: SubFigure, blocks: list[Block], height: float) -> list[Axes]:
    """Names at the left of the first alone, so with room for them; levels are named below."""
    found = _axes(part, len(blocks))
    below = 0.36 + LINE * max(len(block["levels"]) for block in blocks)
    top = max(map(_title_height, blocks))
    part.subplots_adjust(left=0.2, right=0.98, top=1 - top / height, bottom=below / height, wspace=0.12)
    return found

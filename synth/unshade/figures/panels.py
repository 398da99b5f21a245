"""Pictures in rows and columns with their titles and captions."""

from __future__ import annotations

import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import SubFigure

WIDTH = 7.2
"""Width of a page's text, inches."""
FONT = 7
"""Points."""
LEFT = 0.32
"""Room for the rows' titles, inches."""
GAP = 0.03
LINE = 0.13
"""A line of text, inches."""
BAR = 0.34


def height(block: dict[str, Any]) -> float:
    """Inches that the block takes."""
    return _layout(block)[2]


def _layout(block: dict[str, Any]) -> tuple[float, list[float], float]:
    """Width of a panel, height of each row with its captions, height of the whole; inches."""
    count = len(block["columns"])
    # Few panels are no larger than a quarter of the page.
    width = min((WIDTH - LEFT) / count - GAP, 1.7)
    rows = []
    for row in block["rows"]:
        lines = max(
            [cell["caption"].count("/") // 2 + 1 for cell in row["cells"] if cell and cell["caption"]], default=0
        )
        rows.append(_panel_height(row, width) + GAP + LINE * lines)
    top = LINE * (1.5 if block["title"] else 0) + LINE * _heading_lines(block, width) + 0.06
    return width, rows, top + sum(rows) + (BAR if block["error"] else 0.05)


def _panel_height(row: dict[str, Any], width: float) -> float:
    """Inches of the row's highest panel."""
    return width * max((cell["height_over_width"] for cell in row["cells"] if cell), default=1.0)


def _heading_lines(block: dict[str, Any], width: float) -> int:
    return max(len(_wrapped(title, width).split("\n")) for title in block["columns"])


def _wrapped(text: str, width: float) -> str:
    """Lines of about the width of a panel."""
    return textwrap.fill(text, max(8, int(width * 17)), break_long_words=False) or text


def draw(part: SubFigure, blocks: list[dict[str, Any]], folder: Path) -> None:
    """Draws one block; panels are shown texel by texel."""
    import matplotlib.image as image

    (block,) = blocks
    width, rows, whole = _layout(block)
    place = lambda x, y: (x / WIDTH, 1 - y / whole)
    down = 0.04
    if block["title"]:
        part.text(*place(0.02, down), block["title"], va="top", weight="bold")
        down += 1.5 * LINE
    down += LINE * _heading_lines(block, width)
    for at, title in enumerate(block["columns"]):
        x = LEFT + at * (width + GAP) + width / 2
        part.text(*place(x, down), _wrapped(title, width), ha="center", va="bottom")
    down += 0.02
    for row, tall in zip(block["rows"], rows):
        high = _panel_height(row, width)
        title = _wrapped(row["title"], high)
        part.text(*place(LEFT / 2, down + high / 2), title, rotation=90, ha="center", va="center")
        for at, cell in enumerate(row["cells"]):
            if cell is None:
                continue
            x = LEFT + at * (width + GAP)
            axes = part.add_axes((x / WIDTH, 1 - (down + high) / whole, width / WIDTH, high / whole))
            axes.imshow(image.imread(folder / cell["file"]), interpolation="nearest")
            axes.set_axis_off()
            if cell["caption"]:
                caption = cell["caption"].replace(" / ", "\n", 1)
                part.text(*place(x + width / 2, down + high + 0.01), caption, ha="center", va="top", size=FONT - 1.5)
        down += tall
    if block["error"]:
        _colour_bar(part, block["error"], (LEFT / WIDTH, (BAR - 0.14) / whole, 0.3, 0.07 / whole))


def _colour_bar(part: SubFigure, error: list[Any], where: tuple[float, float, float, float]) -> None:
    """The colours of the error pictures, which are those of the map "magma"."""
    import numpy as np

    label, top = error
    axes = part.add_axes(where)
    axes.imshow(np.linspace(0, 1, 256)[None], aspect="auto", cmap="magma", extent=(0, top, 0, 1))
    axes.set_yticks([])
    axes.set_xticks([0, top / 2, top])
    axes.tick_params(length=1.5, pad=1, labelsize=5.5)
    axes.text(1.03, 0.5, f"error: {label}", transform=axes.transAxes, va="center")

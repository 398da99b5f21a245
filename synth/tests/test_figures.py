"""Figures of a paper: what is drawn of a description."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from unshade.errors import ReportError
from unshade.figures.draw import draw
from unshade.figures.plots import scale_heats

TEAL, ORANGE = (10, 140, 130), (240, 120, 20)


def folder_with(folder: Path, *blocks: dict[str, Any]) -> Path:
    (folder / "panels").mkdir(parents=True)
    for name, colour in (("teal", TEAL), ("orange", ORANGE)):
        Image.new("RGB", (16, 16), colour).save(folder / f"panels/{name}.png")
    (folder / "figure.json").write_text(json.dumps({"caption": "", "blocks": blocks}))
    return folder


def panels(columns: int, rows: int) -> dict[str, Any]:
    """Teal everywhere, orange in the last cell, and nothing in the first of the last row."""
    cell = lambda name: {"file": f"panels/{name}.png", "height_over_width": 1.0, "caption": "27.95 dB / 0.857 / 0.144"}
    cells = [[cell("teal") for _ in range(columns)] for _ in range(rows)]
    cells[-1][-1] = cell("orange")
    cells[-1][0] = None
    return {
        "kind": "panels", "title": "a face", "columns": [f"column {i}" for i in range(columns)],
        "rows": [{"title": f"row {i}", "cells": row} for i, row in enumerate(cells)], "error": ["RMS", 0.1],
    }  # fmt: skip


HEAT = {
    "kind": "heat", "title": "albedo", "label": "dB", "x_label": "exposure", "y_label": "specular",
    "x": [0.5, 1, 2], "y": [0.6, 1.6], "values": [[20.0, 21.0, None], [25.0, 26.0, 27.0]],
}  # fmt: skip
LINES = {
    "kind": "lines", "title": "detail", "x_label": "cycles", "y_label": "gain", "logarithmic": True,
    "across": [0.0, 1.0],
    "lines": [
        {"name": "a", "x": [0.1, 0.2], "y": [1.0, 0.5], "interval": [[0.9, 1.1], [0.4, 0.6]]},
        {"name": "b", "x": [0.1, 0.2], "y": [0.8, 0.1], "interval": [None, None]},
    ],
}  # fmt: skip
BARS = {
    "kind": "bars", "title": "albedo", "label": "dB", "steps": True, "levels": [["flat", 30.0]],
    "bars": [
        {"name": "a", "value": 20.0, "interval": [19.0, 21.0]},
        {"name": "b", "value": None, "interval": None},
        {"name": "c", "value": 28.0, "interval": None},
    ],
}  # fmt: skip


def area(picture: np.ndarray, colour: tuple[int, int, int]) -> np.ndarray:
    """The pixels of a colour, as rows and columns."""
    return np.argwhere((np.abs(picture.astype(int) - colour) <= 2).all(axis=2))


def test_panels_have_equal_size_in_their_places(tmp_path: Path) -> None:
    png, _ = draw(folder_with(tmp_path / "f", panels(5, 3)))
    picture = np.array(Image.open(png).convert("RGB"))
    assert picture.shape[1] == 2160
    teal, orange = area(picture, TEAL), area(picture, ORANGE)
    height, width = np.ptp(orange, axis=0) + 1
    assert abs(height - width) <= 2 and len(orange) >= 0.98 * height * width
    assert len(teal) == pytest.approx(13 * len(orange), rel=0.02)
    # The last of the last row, and nothing in the first of it.
    assert orange[:, 1].min() > 0.75 * picture.shape[1] and orange[:, 0].min() > teal[:, 0].max() - height
    below = teal[teal[:, 0] > orange[:, 0].min()]
    assert below[:, 1].min() > teal[:, 1].min() + width


def test_all_kinds_stand_below_each_other_and_equal_descriptions_give_equal_bytes(tmp_path: Path) -> None:
    blocks = (panels(4, 2), HEAT, {**HEAT, "label": "°"}, LINES, BARS, {**BARS, "steps": False})
    made = [draw(folder_with(tmp_path / name, *blocks)) for name in "ab"]
    for one, other in zip(*made):
        assert one.read_bytes() == other.read_bytes()
    png, pdf = made[0]
    assert pdf.read_bytes().startswith(b"%PDF")
    # In points: 7.2 inches.
    box = re.search(rb"/MediaBox \[ 0 0 ([\d.]+)", pdf.read_bytes())
    assert box and float(box[1]) == pytest.approx(7.2 * 72)
    heights = [Image.open(draw(folder_with(tmp_path / str(i), block))[0]).height for i, block in enumerate(blocks)]
    # The two plots of bars share a row.
    assert Image.open(png).height == pytest.approx(sum(heights[:5]), abs=10)


def test_a_figure_that_cannot_be_drawn_is_refused_in_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = folder_with(tmp_path / "f", {"kind": "sculpture"})
    with pytest.raises(ReportError, match=r"figure\.json: blocks \['sculpture'\] are not known"):
        draw(folder)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(ReportError, match=r"pip install 'unshade\[figures\]'"):
        draw(folder)
    assert not (folder / "figure.png").exists()


def test_equal_quantities_have_one_colour_scale() -> None:
    maps = [
        {"label": "a", "values": [[1.0, None]]},
        {"label": "b", "values": [[7.0]]},
        {"label": "a", "values": [[3.0]]},
    ]
    scale_heats(maps)
    assert [map_["range"] for map_ in maps] == [(1.0, 3.0), (7.0, 7.0), (1.0, 3.0)]

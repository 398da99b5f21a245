"""A suite's scores over time as an SVG, with the steps that a change-point search finds in them.

The history is the file that ``unshade compare --history`` adds a line of JSON to for each run. The steps are
found by Pelt (Killick, Fearnhead, Eckley 2012) as ``ruptures`` has it, on each score over its own noise: the
median absolute difference of neighbours, which a few steps do not move.
"""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import CompareError

FIGURES = {
    "diffuse_albedo/scale_global@coverage-e5:none": "Aligning factor of the diffuse albedo",
    "diffuse_albedo/psnr_srgb@coverage-e5:global": "PSNR of the diffuse albedo, dB",
    "specular_normal/normal_mean_deg@coverage-e5:none": "Mean angle of the specular normal, °",
    "relit/*/psnr_srgb@mask-e5:global": "PSNR of the relit pictures, dB",
}
"""Row ids that are drawn, a panel each, with their titles; ``*`` stands for all lights, which are averaged."""

_PENALTY = 4.0
"""Penalty of a step over the logarithm of the number of runs, in squared standard deviations: a history without
steps shows one in fewer than one in twenty (a test counts them)."""
_MIN_RUNS = 6
_COLOURS = ("#1b6ca8", "#c2571a", "#2e7d4f", "#8a4fa3", "#7a6a1f", "#555555")
_WIDTH, _PANEL, _LEFT, _RIGHT, _TOP = 760, 150, 64, 16, 30


def steps(values: Sequence[float]) -> list[int]:
    """Indices of the first value after each step of a series; none of fewer than six values.

    Raises `CompareError` where ``ruptures`` is not installed.
    """
    try:
        from ruptures import Pelt
    except ImportError:
        raise CompareError(
            "ruptures, which finds the steps, is not installed; pip install 'unshade[history]'"
        ) from None
    series: NDArray[np.float64] = np.asarray(values, float)
    spread = float(np.ptp(series)) if len(series) else 0.0
    if len(series) < _MIN_RUNS or spread == 0.0:
        return []
    noise = float(np.median(np.abs(np.diff(series)))) / (0.6745 * np.sqrt(2.0))
    # Runs of the same code have the same scores: then every change is a step.
    series = series / max(noise, 1e-3 * spread)
    found = Pelt(model="l2", min_size=2, jump=1).fit(series[:, None]).predict(pen=_PENALTY * np.log(len(series)))
    return [int(index) for index in found[:-1]]


def write(history: Path, out: Path) -> int:
    """Draw ``history`` into the SVG ``out``; the number of steps in it. Raises `CompareError`."""
    records = _read(history)
    panels = [(title, _series(records, key)) for key, title in FIGURES.items()]
    panels = [(title, lines) for title, lines in panels if lines]
    methods = sorted({method for _, lines in panels for method in lines})
    height = _TOP + _PANEL * len(panels) + 24
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH} {height}" font-family="sans-serif" font-size="12">',
        f"<title>{escape(records[-1]['suite'])}: {len(records)} runs</title>",
        f'<rect width="{_WIDTH}" height="{height}" fill="white"/>',
    ]
    place = _LEFT
    for index, method in enumerate(methods):
        parts.append(f'<rect x="{place}" y="10" width="12" height="12" fill="{_COLOURS[index % len(_COLOURS)]}"/>')
        parts.append(f'<text x="{place + 17}" y="20">{escape(method)}</text>')
        place += 34 + 7 * len(method)
    count = 0
    for index, (title, lines) in enumerate(panels):
        drawn, found = _panel(title, lines, methods, records, _TOP + index * _PANEL)
        parts += drawn
        count += found
    if not panels:
        raise CompareError(f"{history}: holds no score that is drawn; there are {', '.join(FIGURES)}")
    first, last = records[0]["at"][:10], records[-1]["at"][:10]
    parts.append(f'<text x="{_LEFT}" y="{height - 8}">{escape(first)}</text>')
    parts.append(f'<text x="{_WIDTH - _RIGHT}" y="{height - 8}" text-anchor="end">{escape(last)}</text></svg>')
    out.parent.mkdir(parents=True, exist_ok=True)
    partial = out.with_name(out.name + ".partial")
    partial.write_text("\n".join(parts) + "\n", encoding="utf-8")
    os.replace(partial, out)
    return count


def _read(history: Path) -> list[dict[str, Any]]:
    try:
        lines = history.read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise CompareError(f"{history}: cannot be read: {error.strerror}") from None
    records = []
    for number, line in enumerate(lines, 1):
        try:
            record = json.loads(line)
            if record["format"] != 1:
                raise ValueError(f"format {record['format']}, this version reads 1")
            records.append({key: record[key] for key in ("at", "commit", "suite", "values")})
        except (ValueError, KeyError, TypeError) as error:
            raise CompareError(f"{history}:{number}: is not a line of a history: {error}; remove the line") from None
    if not records:
        raise CompareError(f"{history}: is empty")
    return records


def _series(records: list[dict[str, Any]], key: str) -> dict[str, list[tuple[int, float]]]:
    """By method, the number of each run that has the figure, and its value."""
    head, star, tail = key.partition("*")
    lines: dict[str, list[tuple[int, float]]] = {}
    for index, record in enumerate(records):
        found: dict[str, list[float]] = {}
        for name, value in record["values"].items():
            method, _, row = name.partition("/")
            # Its maps are the truth: a constant that would press all others into a line.
            if method == "oracle" and not row.startswith("relit"):
                continue
            if row == key or (star and row.startswith(head) and row.endswith(tail)):
                found.setdefault(method, []).append(value)
        for method, values in found.items():
            lines.setdefault(method, []).append((index, float(np.mean(values))))
    return lines


def _panel(
    title: str, lines: dict[str, list[tuple[int, float]]], methods: list[str], records: list[dict[str, Any]], top: int
) -> tuple[list[str], int]:
    values = [value for line in lines.values() for _, value in line]
    low, high = min(values), max(values)
    low, high = (low - 0.5, high + 0.5) if low == high else (low, high)
    x = lambda run: _LEFT + (run + 0.5) / len(records) * (_WIDTH - _LEFT - _RIGHT)
    y = lambda value: top + 32 + (high - value) / (high - low) * (_PANEL - 50)
    parts = [f'<text x="{_LEFT}" y="{top + 18}" font-weight="bold">{escape(title)}</text>']
    for value in (low, (low + high) / 2, high):
        place = y(value)
        parts.append(f'<path d="M{_LEFT} {place:.1f}H{_WIDTH - _RIGHT}" stroke="#ddd"/>')
        parts.append(f'<text x="{_LEFT - 6}" y="{place + 4:.1f}" text-anchor="end" fill="#555">{value:.4g}</text>')
    count = 0
    for method, line in lines.items():
        colour = _COLOURS[methods.index(method) % len(_COLOURS)]
        points = " ".join(f"{x(run):.1f},{y(value):.1f}" for run, value in line)
        parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.5"/>')
        parts += [f'<circle cx="{x(run):.1f}" cy="{y(value):.1f}" r="2.2" fill="{colour}"/>' for run, value in line]
        for step in steps([value for _, value in line]):
            count += 1
            run = line[step][0]
            place = x(run - 0.5)
            name = (records[run]["commit"] or f"run {run + 1}")[:8]
            parts.append(
                f'<path d="M{place:.1f} {top + 26}V{top + _PANEL - 14}" stroke="{colour}" stroke-dasharray="3 3"/>'
                f'<text x="{place + 3:.1f}" y="{top + 31}" font-size="10" fill="{colour}">{escape(name)}</text>'
            )
    return parts, count

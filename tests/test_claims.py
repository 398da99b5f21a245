"""The numbers of README.md, docs/emily.md and docs/summary.md are those of docs/emily.csv and docs/results.csv."""

from __future__ import annotations

import csv
import importlib.util
import re
import sys
from collections.abc import Callable

import pytest
from doc_examples import ROOT

_found = importlib.util.spec_from_file_location("tables", ROOT / "docs/tables.py")
assert _found and _found.loader
tables = importlib.util.module_from_spec(_found)
sys.modules["tables"] = tables
_found.loader.exec_module(tables)

PAGES = tables.tables()
FILES = {
    "README.md": "the CSV files of docs/",
    "docs/emily.md": "docs/emily.csv",
    "docs/summary.md": "docs/results.csv",
}


def cells(line: str) -> list[str]:
    return [cell.strip() for cell in line.strip("|").split("|")]


def first_difference(page: str, text: str) -> str | None:
    """A sentence about the first cell that states something other than the CSV files, None if all agree."""
    lines = text.split("\n")
    for table in PAGES[page]:
        first, end = tables.place(lines, table)
        expected = [table.heading, *table.rows]
        stated = [cells(line) for i, line in enumerate(lines[first:end]) if i != 1]
        if len(stated) != len(expected):
            return f"{page}: the table {table.heading[0]!r} has {len(stated)} lines, {FILES[page]} has {len(expected)}."
        for found, row in zip(stated, expected):
            for heading, here, there in zip(table.heading, found, row, strict=True):
                if here != there:
                    return f"{page}: {heading!r} of {' '.join(row[:2])!r} is {here!r}, {FILES[page]} has {there!r}."
    return None


@pytest.mark.parametrize("page", PAGES)
def test_tables_state_what_the_csv_files_have(page: str) -> None:
    """To write them: ``python docs/tables.py``."""
    assert first_difference(page, (ROOT / page).read_text(encoding="utf-8")) is None


@pytest.mark.parametrize("page", PAGES)
def test_a_changed_digit_is_found_in_every_table(page: str) -> None:
    text = (ROOT / page).read_text(encoding="utf-8")
    for table in PAGES[page]:
        line = table.lines()[-1]
        at = max(i for i, letter in enumerate(line) if letter.isdigit())
        changed = f"{line[:at]}{(int(line[at]) + 1) % 10}{line[at + 1 :]}"
        assert text.count(line) == 1
        found = first_difference(page, text.replace(line, changed))
        assert found and found.startswith(page)


def value(file: str, light: str, method: str, row: str, column: str = "mean") -> float:
    """A number of a CSV file, looked up without the program that writes the tables."""
    with (ROOT / "docs" / file).open(newline="") as lines:
        found = [
            float(line[column])
            for line in csv.DictReader(lines)
            if (line["light"], line["method"].removesuffix(" (512² textures)")) == (light, method)
            and line["row"].split("@")[0] + ":" + line["row"].rpartition(":")[2] == row
        ]
    assert len(found) == 1, (file, light, method, row)
    return found[0]


ALBEDO, AS_IS = "diffuse_albedo/psnr_srgb:global", "diffuse_albedo/psnr_srgb:none"
OTHERS, VIEW = "relit/<other lights, mean>/psnr_srgb:global", "view/psnr_srgb:none"
NORMAL = "specular_normal/normal_mean_deg:none"
ORACLE, MEAN, SH = "oracle (true maps)", "mean projected texture", "spherical harmonics, Lambert"
PASSIVE = ("paper-tuned", "paper", SH, MEAN, "semantic initialisation")
SIX = ("studio", "uniform", "flash", "courtyard", "sun", "two-colour")


def heads(light: str, method: str, row: str) -> float:
    return value("emily.csv", light, method, row)


def faces(light: str, method: str, row: str) -> float:
    return value("results.csv", light, method, row)


def ends(values: list[float]) -> list[float]:
    return [min(values), max(values)]


def margins() -> list[float]:
    """How far the next passive method is below `unshade` in uniform light, and the ends in the others."""
    found = {light: faces(light, "unshade", ALBEDO) - max(faces(light, m, ALBEDO) for m in PASSIVE) for light in SIX}
    uniform = found.pop("uniform")
    return [uniform, *ends(list(found.values()))]


def emily_as_is() -> list[float]:
    solvers = ("unshade", "paper", "paper-tuned", SH)
    return ends([heads("uniform", m, ALBEDO) - heads("uniform", m, AS_IS) for m in solvers])


def best_normal() -> list[float]:
    """The mesh's error, and the gain of the best solver."""
    every = [heads(light, m, NORMAL) for light in ("flash", "uniform") for m in ("unshade", "paper", "paper-tuned")]
    mesh = heads("flash", MEAN, NORMAL)
    return [mesh, mesh - min(every)]


SENTENCES: list[tuple[str, str, Callable[[], list[float]]]] = [
    ("docs/emily.md", r"it is (\S+) dB below the oracle", lambda: [
        heads("flash", ORACLE, OTHERS) - heads("flash", "unshade", OTHERS)]),
    ("docs/emily.md", r"synthesises views in flash (\S+) dB better", lambda: [
        heads("flash", "paper-tuned", VIEW) - heads("flash", "unshade", VIEW)]),
    ("docs/emily.md", r"an error of ([\d.]+)°, and the best solver gains ([\d.]+)°", best_normal),
    ("docs/emily.md", r"As is, solvers are (\S+) to (\S+) dB lower", emily_as_is),
    ("docs/summary.md", r"method is (\S+) dB of albedo below it in uniform .* and (\S+) to (\S+) dB in the others", margins),
    ("docs/summary.md", r"gains most under the flash, (\S+) dB", lambda: [
        max(faces(light, "paper-tuned", ALBEDO) - faces(light, "paper", ALBEDO) for light in SIX)]),
    ("docs/summary.md", r"the albedo of `unshade` is (\S+) to (\S+) dB lower", lambda: ends(
        [faces(light, "unshade", ALBEDO) - faces(light, "unshade", AS_IS) for light in SIX])),
    ("docs/summary.md", r"`unshade` is (\S+) to (\S+) dB below it in other lights", lambda: ends(
        [faces(light, ORACLE, OTHERS) - faces(light, "unshade", OTHERS) for light in SIX])),
]  # fmt: skip


@pytest.mark.parametrize(("page", "pattern", "computed"), SENTENCES, ids=[pattern[:30] for _, pattern, _ in SENTENCES])
def test_sentences_state_what_the_csv_files_have(page: str, pattern: str, computed: Callable[[], list[float]]) -> None:
    found = re.search(pattern, (ROOT / page).read_text(encoding="utf-8"))
    assert found, f"{page} has no sentence {pattern!r}; change it in tests/test_claims.py too"
    for stated, exact in zip(found.groups(), computed(), strict=True):
        decimals = len(stated.partition(".")[2])
        assert abs(float(stated) - exact) < 0.5001 * 10**-decimals, f"{page}: {found[0]!r}: computed {exact:.3f}"


def test_the_albedo_column_is_read_from_the_right_lines() -> None:
    """Without the program that writes the tables."""
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    for light, file, methods in [
        ("flash", "emily.csv", ("unshade", "paper-tuned", SH, MEAN)),
        ("studio", "results.csv", ("unshade", "paper-tuned", "paper", SH)),
    ]:
        row = next(line for line in readme.split("\n") if line.startswith(f"| {light} |"))
        expected = [f"{value(file, light, method, ALBEDO):.1f}" for method in methods]
        assert cells(row)[1].split(" / ") == expected

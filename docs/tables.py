"""Writes the tables of README.md, docs/emily.md and docs/summary.md from docs/emily.csv and docs/results.csv, which
``unshade table`` makes of runs: ``python docs/tables.py``."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

FACTORED, AS_IS = "diffuse_albedo/psnr_srgb@coverage-e5:global", "diffuse_albedo/psnr_srgb@coverage-e5:none"
VIEW, OWN = "view/psnr_srgb@mask-e5:none", "relit/<own light>/psnr_srgb@mask-e5:global"
OTHERS = "relit/<other lights, mean>/psnr_srgb@mask-e5:global"
NORMAL, SPECULAR = "specular_normal/normal_mean_deg@coverage-e5:none", "specular_albedo/rmse@coverage-e5:none"
CORRELATION, ENERGY = "view_specular_layer/pearson@mask-e5:none", "view_specular_layer/energy_ratio@mask-e5:none"

UNSHADE, PAPER, TUNED, ORACLE = "unshade", "paper", "paper-tuned", "oracle (true maps)"
SH, MEAN = "spherical harmonics, Lambert", "mean projected texture"
INITIAL, LABELS = "semantic initialisation", "true mean of each label (privileged)"
NAMES = {
    UNSHADE: "`unshade`",
    PAPER: "`paper`",
    TUNED: "`paper-tuned`",
    SH: "`sh-lambert`",
    MEAN: "mean projected texture",
    INITIAL: "semantic initialisation",
    LABELS: "true mean of each label",
    ORACLE: "oracle",
}
NONE = "\N{EN DASH}"
LIGHTS = {"courtyard": "courtyard (HDRI)", "two-colour": "two colours"}
"""Lights whose titles differ from their names."""


@dataclass(frozen=True)
class Table:
    """A table of a page: ``rows`` of cells under a ``heading``."""

    heading: list[str]
    rows: list[list[str]]

    def lines(self) -> list[str]:
        """The table in Markdown."""
        written = [f"| {' | '.join(cells)} |" for cells in (self.heading, *self.rows)]
        return [written[0], "|" + "---|" * len(self.heading), *written[1:]]


class Results:
    """The lines of a CSV file by light, method and row of the scores."""

    def __init__(self, file: Path) -> None:
        with file.open(newline="") as lines:
            found = list(csv.DictReader(lines))
        # Pages name a method without the size of its textures.
        self._lines = {(line["light"], line["method"].split(" (512²")[0], line["row"]): line for line in found}
        self.faces = max(int(line["faces"]) for line in found)

    def value(self, light: str, method: str, row: str, column: str = "mean") -> float | None:
        """A number of the file; None if the method has no such score."""
        line = self._lines.get((light, method, row))
        return float(line[column]) if line and line[column] else None

    def text(self, light: str, method: str, row: str, decimals: int = 1, column: str = "mean") -> str:
        value = self.value(light, method, row, column)
        return NONE if value is None else f"{value:.{decimals}f}"

    def several(self, light: str, methods: tuple[str, ...], row: str, decimals: int = 1, unit: str = "") -> str:
        """A cell with the means of several methods."""
        return " / ".join(self.text(light, method, row, decimals) + unit for method in methods)

    def with_oracle(self, light: str, methods: tuple[str, ...], row: str) -> str:
        return f"{self.several(light, methods, row)} ({self.text(light, ORACLE, row)})"

    def with_range(self, light: str, method: str, row: str) -> str:
        """The mean, and the range if there are several faces."""
        mean, low, high = (self.text(light, method, row, column=c) for c in ("mean", "smallest", "largest"))
        return f"{mean} ({low} to {high})" if low != high else mean

    def share(self, light: str, method: str) -> str:
        """The error of the specular normals relative to the mesh's, which the mean texture has."""
        value, mesh = self.value(light, method, NORMAL), self.value(light, MEAN, NORMAL)
        return NONE if value is None or not mesh else f"{100 * value / mesh:.0f} %"

    def heads(self, light: str, method: str) -> str:
        """A note of how many faces a method has, if not all."""
        faces = self.value(light, method, FACTORED, "faces")
        return f" ({faces:.0f} of {self.faces} heads)" if faces and faces < self.faces else ""


def emily_in_short(results: Results) -> Table:
    """README's table of the Digital Emily matrix."""
    four, solvers = (UNSHADE, TUNED, SH, MEAN), (UNSHADE, TUNED)
    mesh = results.text("flash", MEAN, NORMAL, 2)
    normal = f"specular normal (mesh {mesh}°)"
    heading = ["captured in", "albedo", "view synthesis", "relit, same light", "relit, other light", normal]
    rows = [
        [
            light,
            results.several(light, four, FACTORED),
            results.several(light, solvers, VIEW),
            results.with_oracle(light, four, OWN),
            results.with_oracle(light, four, OTHERS),
            results.several(light, solvers, NORMAL, 2, "°"),
        ]
        for light in ("flash", "uniform")
    ]
    return Table(heading, rows)


def matched_in_short(results: Results) -> Table:
    """README's table of the twelve faces whose material solvers assume."""
    four = (UNSHADE, TUNED, PAPER, SH)
    listed = " / ".join(NAMES[method] for method in four)
    heading = [
        "light",
        f"albedo: {listed}",
        "relit in other lights (oracle)",
        "specular normal / mesh's, the first three",
    ]
    rows = [
        [
            light,
            results.several(light, four, FACTORED),
            results.with_oracle(light, four, OTHERS),
            " / ".join(results.share(light, method) for method in four[:3]),
        ]
        for light in ("studio", "uniform", "flash")
    ]
    return Table(heading, rows)


def emily(results: Results) -> Table:
    """The table of docs/emily.md."""
    heading = ["captured in", "method", "albedo: as is / one factor", "view synthesis", "relit: same light"]
    heading += ["relit: other light", "specular normal, error", "specular albedo, RMSE"]
    rows: list[list[str]] = []
    for light in ("flash", "uniform"):
        for method in (UNSHADE, PAPER, TUNED, SH, MEAN, ORACLE):
            first = "" if rows and rows[-1][0] in (light, "") and method != UNSHADE else light
            exact = method == ORACLE
            albedo = f"{results.text(light, method, AS_IS)} / {results.with_range(light, method, FACTORED)}"
            rows.append(
                [
                    first,
                    NAMES[method] + results.heads(light, method),
                    "exact" if exact else albedo,
                    *(results.with_range(light, method, row) for row in (VIEW, OWN, OTHERS)),
                    "0" if exact else results.text(light, method, NORMAL, 2) + "°",
                    "0" if exact else results.text(light, method, SPECULAR, 4),
                ]
            )
    return Table(heading, rows)


SIX = ("studio", "uniform", "flash", "courtyard", "sun", "two-colour")


def by_light(results: Results, title: str, row: str, methods: tuple[str, ...]) -> Table:
    """A table of docs/summary.md: a score of several methods in each light."""
    rows = [[LIGHTS.get(light, light), *(results.text(light, each, row) for each in methods)] for light in SIX]
    return Table([title, *(NAMES[method] for method in methods)], rows)


def of_unshade(results: Results) -> Table:
    """The further scores of the default solver in docs/summary.md."""
    heading = ["`unshade`", "albedo, 95 % over faces", "range over faces", "as is", "relit: own light"]
    heading += ["specular normal / mesh's", "highlights: correlation, energy"]
    rows: list[list[str]] = []
    for light in SIX:
        mean, high = (results.value(light, UNSHADE, FACTORED, column) for column in ("mean", "high"))
        half = f" ± {high - mean:.1f}" if mean is not None and high is not None else ""
        low, top = (results.text(light, UNSHADE, FACTORED, column=c) for c in ("smallest", "largest"))
        highlights = ", ".join(results.text(light, UNSHADE, row, 2) for row in (CORRELATION, ENERGY))
        as_is, own = (results.text(light, UNSHADE, row) for row in (AS_IS, OWN))
        albedo = results.text(light, UNSHADE, FACTORED) + half
        rows.append(
            [LIGHTS.get(light, light), albedo, f"{low} to {top}", as_is, own, results.share(light, UNSHADE), highlights]
        )
    return Table(heading, rows)


def tables(root: Path = ROOT) -> dict[str, list[Table]]:
    """The tables of each page, by its path, as the CSV files under ``root`` have them."""
    heads, faces = Results(root / "docs/emily.csv"), Results(root / "docs/results.csv")
    passive = (UNSHADE, TUNED, PAPER, SH, INITIAL, MEAN, LABELS)
    return {
        "README.md": [emily_in_short(heads), matched_in_short(faces)],
        "docs/emily.md": [emily(heads)],
        "docs/summary.md": [
            by_light(faces, "albedo, one factor", FACTORED, passive),
            by_light(faces, "relit in other lights", OTHERS, (*passive, ORACLE)),
            of_unshade(faces),
        ],
    }


def place(lines: list[str], table: Table) -> tuple[int, int]:
    """The first line of a table in a page, found by its first two headings, and the line after it."""
    start = "| " + " | ".join(table.heading[:2]) + " |"
    found = [at for at, line in enumerate(lines) if line.startswith(start)]
    if len(found) != 1:
        raise LookupError(f"{len(found)} tables start with {start!r}; the page needs one")
    end = next((at for at in range(found[0], len(lines)) if not lines[at].startswith("|")), len(lines))
    return found[0], end


def main() -> None:
    """Replaces the tables in the pages."""
    for name, written in tables().items():
        page = ROOT / name
        lines = page.read_text(encoding="utf-8").split("\n")
        for table in written:
            first, end = place(lines, table)
            lines[first:end] = table.lines()
        page.write_text("\n".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()

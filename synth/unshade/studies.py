"""Statistics over the faces of runs, and every score of them as one tidy table."""

from __future__ import annotations

import os
from typing import Any

from .commands import command
from .errors import ScoreError

_Path = str | os.PathLike[str]


class Study:
    """Statistics over faces; each list holds one dictionary a row, as in ``study.json``."""

    __slots__ = ("comparisons", "components", "fairness", "rows", "summaries")

    def __init__(self, document: dict[str, Any], rows: list[dict[str, Any]]) -> None:
        """``document`` is what ``study.json`` holds, ``rows`` the scores it was made of."""
        self.summaries: list[dict[str, Any]] = document["summaries"]
        """Every figure of every method: mean over faces, ``ci95``, worst face, pooled error."""
        self.comparisons: list[dict[str, Any]] = document["comparisons"]
        """Every two methods that compete: gain, ``ci95``, effect, ``p_holm``, verdict, faces needed."""
        self.components: list[dict[str, Any]] = document["components"]
        """Standard deviations between faces, lights, views, and seeds of the renderer and the solver."""
        self.fairness: list[dict[str, Any]] = document["fairness"]
        """Figures by group of skin tone: worst group, gap, bias."""
        self.rows = rows
        """The tidy table: one score a row, with its case, face, light, method, seeds and interval."""

    def to_parquet(self, path: _Path) -> None:
        """Write the tidy table as Parquet. Raises ``errors.ScoreError`` without pyarrow (``unshade[parquet]``)."""
        try:
            import pyarrow as pa  # type: ignore[import-not-found,import-untyped,unused-ignore]
            import pyarrow.parquet as pq  # type: ignore[import-not-found,import-untyped,unused-ignore]
        except ImportError as error:
            raise ScoreError(
                "Parquet needs the Python package pyarrow; install unshade[parquet], or take scores.csv"
            ) from error
        columns = {name: [row[name] for row in self.rows] for name in COLUMNS}
        types = {"seed": pa.int64(), "method_seed": pa.int64(), "n": pa.int64()}
        types |= {name: pa.float64() for name in ("skin_tone", "value", "ci95_low", "ci95_high", "floor")}
        schema = pa.schema([(name, types.get(name, pa.string())) for name in COLUMNS])
        pq.write_table(pa.table(columns, schema=schema), os.fspath(path))

    def __repr__(self) -> str:
        faces = {row["face"] for row in self.rows}
        methods = {row["method"] for row in self.rows}
        return f"Study of {len(methods)} methods on {len(faces)} faces, {len(self.rows)} scores"


COLUMNS = (
    "suite", "case", "face", "skin_tone", "light", "variant", "seed", "method", "method_seed", "kind", "class",
    "subject", "relit_light", "metric", "scale", "region", "label", "value", "ci95_low", "ci95_high", "n", "floor",
)  # fmt: skip
"""Columns of the tidy table, as in ``scores.csv``."""


def study(*runs: _Path, out: _Path | None = None) -> Study:
    """Statistics over the faces of finished runs; with ``out`` the folder of ``unshade study`` is written too.

    Raises ``errors.ScoreError`` for runs without scores, or with a result twice.
    """
    document, rows = command("study", runs=runs, out=out)
    return Study(document, [_tidy(row) for row in rows])


def _tidy(given: dict[str, Any]) -> dict[str, Any]:
    """An observation under the names of `COLUMNS`."""
    score: dict[str, Any] = given["row"]
    low, high = score["ci95"] or (None, None)
    named = {**score, **given, "relit_light": score["light"], "ci95_low": low, "ci95_high": high}
    return {name: named[name] for name in COLUMNS}


__all__ = ["COLUMNS", "Study", "study"]

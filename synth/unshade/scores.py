"""Scores as an object: rows to choose from, a number by its name, a table to look at."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from difflib import get_close_matches
from html import escape
from importlib import import_module
from typing import Any, Literal, overload

from . import _native
from .errors import ScoreError

_Path = str | os.PathLike[str]


class _Any:
    """Stands for a filter that was not given; None is a value of its own."""

    def __repr__(self) -> str:
        return "any"


_ANY = _Any()
_Wanted = str | None | Iterable[str | None] | _Any
_FILTERS = ("subject", "metric", "light", "region", "scale", "label")
_ROWS_SHOWN = 30
_COLUMNS = ("id", *_FILTERS, "value", "ci95_low", "ci95_high", "n", "floor", "block")


def _known(name: str) -> tuple[str, ...]:
    """Names that scores may have, whether these have them or not."""
    if name == "metric":
        from .metrics import DEFINITIONS

        return tuple(DEFINITIONS)
    return {"subject": tuple(_native.subjects), "scale": ("none", "global", "channel", "median")}.get(name, ())


@dataclass(frozen=True)
class Score:
    """One number with its protocol; the metric's unit is in ``unshade.metrics.DEFINITIONS``."""

    subject: str
    """Subject of the comparison: ``diffuse_albedo``, ``view``, ``relit``, ..."""
    metric: str
    scale: str
    """``none``, ``global``, ``channel`` or ``median``."""
    region: str
    label: str | None
    """Part of the face; None for all of it."""
    light: str | None
    """The light it is relit in."""
    value: float | None
    """None where the metric is not defined."""
    ci95: tuple[float, float] | None
    """95 % confidence interval."""
    n: int
    """Pixels or texels."""
    floor: float | None
    """The value that rendering noise alone would allow."""
    per_frame: dict[str, float] = field(default_factory=dict[str, float])
    block: int | None = None
    """Side of the blocks of the interval's bootstrap, texels or pixels."""

    @property
    def id(self) -> str:
        """``<subject>[/light]/<metric>@<region>[.label]:<scale>``."""
        light = "" if self.light is None else f"/{self.light}"
        label = "" if self.label is None else f".{self.label}"
        return f"{self.subject}{light}/{self.metric}@{self.region}{label}:{self.scale}"


class Scores:
    """The scores of one solver on one capture: `Score` rows, in the order of the file.

    ``scores["relit/uniform/psnr_srgb@mask-e5:global"]`` is the row with this id, and
    ``scores["rows"]``, ``scores["protocol"]``, ... what the file holds under that key.
    """

    __slots__ = ("_all", "_document", "_rows")

    def __init__(self, document: dict[str, Any]) -> None:
        """``document`` is what a scores file holds."""
        self._document = document
        self._rows = tuple(_row(row) for row in document["rows"])
        # The rows behind a selection, which define the known names.
        self._all = self._rows

    @classmethod
    def read(cls, path: _Path) -> Scores:
        """Read a scores file; raises ``errors.ScoreError``."""
        return cls(json.loads(_native.read_scores(path)))

    def write(self, path: _Path) -> None:
        """Write a scores file as the command line does, completely or not at all."""
        _native.write_scores(json.dumps(self._document), path)

    def select(
        self,
        *,
        subject: _Wanted = _ANY,
        metric: _Wanted = _ANY,
        light: _Wanted = _ANY,
        region: _Wanted = _ANY,
        scale: _Wanted = _ANY,
        label: _Wanted = _ANY,
    ) -> Scores:
        """The rows with these properties, each one value or several of which any will do.

        ``None`` is a value: ``label=None`` is all of the face, ``light=None`` no relit picture. Raises
        ``errors.ScoreError`` for a name that nothing has, with the names that are near.
        """
        wanted = tuple(map(_several, (subject, metric, light, region, scale, label)))
        for name, values in zip(_FILTERS, wanted, strict=True):
            if not isinstance(values, _Any):
                self._check_known(name, values)
        chosen = [
            given
            for row, given in zip(self._rows, self._document["rows"], strict=True)
            if all(map(_fits, (getattr(row, name) for name in _FILTERS), wanted))
        ]
        selection = Scores({**self._document, "rows": chosen})
        selection._all = self._all
        return selection

    def _check_known(self, name: str, wanted: tuple[str | None, ...]) -> None:
        known = {*_known(name), *(getattr(row, name) for row in self._all)} - {None}
        for value in wanted:
            if value is not None and value not in known:
                near = get_close_matches(str(value), sorted(known), n=4, cutoff=0.5)
                fix = f"did you mean {', '.join(near)}?" if near else f"there are {_listed(sorted(known)) or 'none'}"
                raise ScoreError(f"{name}: {value!r} is unknown; {fix}")

    def value(
        self,
        *,
        subject: _Wanted = _ANY,
        metric: _Wanted = _ANY,
        light: _Wanted = _ANY,
        region: _Wanted = _ANY,
        scale: _Wanted = _ANY,
        label: _Wanted = _ANY,
    ) -> float | None:
        """The number of the one row with these properties; raises ``errors.ScoreError`` if there is
        none, or more than one. None where the metric is not defined."""
        found = self.select(
            subject=subject, metric=metric, light=light, region=region, scale=scale, label=label
        )  # fmt: skip
        if len(found) == 1:
            return found._rows[0].value
        wanted = zip(_FILTERS, (subject, metric, light, region, scale, label), strict=True)
        asked = ", ".join(f"{name}={given!r}" for name, given in wanted if given is not _ANY)
        if len(found):
            differ = [name for name in _FILTERS if len(found._values(name)) > 1]
            fix = "; ".join(f"{name}: {_listed(found._values(name))}" for name in differ)
            raise ScoreError(f"{len(found)} rows have {asked or 'any property'}; choose one by {fix}")
        known = "; ".join(f"{name}: {_listed(self._values(name))}" for name in _FILTERS[:2])
        raise ScoreError(f"no row has {asked}; there are {known}")

    def to_dicts(self) -> list[dict[str, Any]]:
        """One dictionary a row, with its id in front, for a table of your own."""
        return [
            {"id": row.id, "light": None, "label": None, **given}
            for row, given in zip(self._rows, self._document["rows"], strict=True)
        ]

    def to_arrow(self) -> Any:
        """Return a ``pyarrow.Table`` of one row a score; the numbers of single frames are left out.

        Raises ``errors.ScoreError`` without pyarrow (``unshade[parquet]``).
        """
        try:
            pa: Any = import_module("pyarrow")
        except ImportError as error:
            raise ScoreError("Arrow needs the Python package pyarrow; install unshade[parquet]") from error
        number, text = pa.float64(), pa.string()
        types: dict[str, Any] = {"value": number, "ci95_low": number, "ci95_high": number, "floor": number}
        types |= {"n": pa.int64(), "block": pa.int64()}
        return pa.table(self._columns(), schema=pa.schema([(name, types.get(name, text)) for name in _COLUMNS]))

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        return self.to_arrow().__arrow_c_stream__(requested_schema)

    def to_pandas(self) -> Any:
        """Return a ``pandas.DataFrame`` of one row a score; the numbers of single frames are left out.

        Raises ``errors.ScoreError`` without pandas.
        """
        try:
            pd: Any = import_module("pandas")
        except ImportError as error:
            raise ScoreError("a data frame needs the Python package pandas; install pandas") from error
        return pd.DataFrame(self._columns())

    def _columns(self) -> dict[str, list[Any]]:
        def cell(row: Score, name: str) -> Any:
            if name.startswith("ci95_"):
                return None if row.ci95 is None else row.ci95[name == "ci95_high"]
            return getattr(row, name)

        return {name: [cell(row, name) for row in self._rows] for name in _COLUMNS}

    def _repr_html_(self) -> str:
        cells = "".join(
            f"<tr><td>{escape(row.id)}</td><td>{_number(row.value)}</td><td>"
            f"{'' if row.ci95 is None else f'{row.ci95[0]:.4g} to {row.ci95[1]:.4g}'}</td></tr>"
            for row in self._rows[:_ROWS_SHOWN]
        )
        left = len(self) - _ROWS_SHOWN
        more = f"<p>{left} more rows; select(...) chooses</p>" if left > 0 else ""
        head = escape(f"Scores of {self.solver} on {self.capture}, {len(self)} rows")
        return f"<p>{head}</p><table><tr><th>row</th><th>value</th><th>95 %</th></tr>{cells}</table>{more}"

    def _values(self, name: str) -> list[Any]:
        return list(dict.fromkeys(getattr(row, name) for row in self._rows))

    @property
    def capture(self) -> str:
        """Name of the capture's folder."""
        return str(self._document["capture"])

    @property
    def solver(self) -> str:
        """Name of the solver."""
        return str(self._document["solver"])

    def __len__(self) -> int:
        return len(self._rows)

    def __iter__(self) -> Iterator[Score]:
        return iter(self._rows)

    def __contains__(self, key: object) -> bool:
        return key in self._document or any(row.id == key for row in self._rows)

    @overload
    def __getitem__(self, key: Literal["rows"]) -> list[dict[str, Any]]: ...
    @overload
    def __getitem__(self, key: str) -> Any: ...
    def __getitem__(self, key: str) -> Any:
        if key in self._document:
            return self._document[key]
        for row in self._rows:
            if row.id == key:
                return row
        raise KeyError(key)

    def __eq__(self, other: object) -> bool:
        return self._document == other._document if isinstance(other, Scores) else NotImplemented

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        lines = [f"Scores of {self.solver} on {self.capture}, {len(self)} rows"]
        shown = self._rows[:_ROWS_SHOWN]
        width = max((len(row.id) for row in shown), default=0)
        for row in shown:
            interval = "" if row.ci95 is None else f"  [{row.ci95[0]:.4g}, {row.ci95[1]:.4g}]"
            lines.append(f"  {row.id:{width}}  {_number(row.value):>8}{interval}")
        if len(self) > len(shown):
            lines.append(f"  ... {len(self) - len(shown)} more; select(...) chooses")
        return "\n".join(lines)


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}"


def _row(row: dict[str, Any]) -> Score:
    interval = row.get("ci95")
    return Score(
        subject=row["subject"], metric=row["metric"], scale=row["scale"], region=row["region"],
        label=row.get("label"), light=row.get("light"), value=row.get("value"),
        ci95=None if interval is None else (interval[0], interval[1]),
        n=row["n"], floor=row.get("floor"), per_frame=dict(row.get("per_frame", {})),
        block=row.get("block"),
    )  # fmt: skip


def _several(wanted: _Wanted) -> tuple[str | None, ...] | _Any:
    if wanted is None or isinstance(wanted, str):
        return (wanted,)
    return wanted if isinstance(wanted, _Any) else tuple(wanted)


def _fits(value: str | None, wanted: tuple[str | None, ...] | _Any) -> bool:
    return isinstance(wanted, _Any) or value in wanted


def _listed(values: list[Any]) -> str:
    return ", ".join(map(str, values))

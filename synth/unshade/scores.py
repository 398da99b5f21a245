"""Scores as an object: rows to choose from, a number by its name, a table to look at."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
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

    __slots__ = ("_document", "_rows")

    def __init__(self, document: dict[str, Any]) -> None:
        """``document`` is what a scores file holds."""
        self._document = document
        self._rows = tuple(_row(row) for row in document["rows"])

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

        ``None`` is a value: ``label=None`` is all of the face, ``light=None`` no relit picture.
        """
        wanted = tuple(map(_several, (subject, metric, light, region, scale, label)))
        chosen = [
            given
            for row, given in zip(self._rows, self._document["rows"], strict=True)
            if all(map(_fits, (getattr(row, name) for name in _FILTERS), wanted))
        ]
        return Scores({**self._document, "rows": chosen})

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
            mend = "; ".join(f"{name}: {_listed(found._values(name))}" for name in differ)
            raise ScoreError(f"{len(found)} rows have {asked or 'any property'}; choose one by {mend}")
        mend = "; ".join(f"{name}: {_listed(self._values(name))}" for name in _FILTERS[:2])
        raise ScoreError(f"no row has {asked}; there are {mend}")

    def to_dicts(self) -> list[dict[str, Any]]:
        """One dictionary a row, with its id in front, for a table of your own."""
        return [
            {"id": row.id, "light": None, "label": None, **given}
            for row, given in zip(self._rows, self._document["rows"], strict=True)
        ]

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
            value = "-" if row.value is None else f"{row.value:.4g}"
            lines.append(f"  {row.id:{width}}  {value:>8}{interval}")
        if len(self) > len(shown):
            lines.append(f"  ... {len(self) - len(shown)} more; select(...) chooses")
        return "\n".join(lines)


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

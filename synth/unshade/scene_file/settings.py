"""Named parameters of one kind of light, as a frozen dataclass that states their ranges."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import Any

from ..errors import SceneError
from .checks import whole


def real(default: float, low: float, high: float) -> Any:
    """A field that holds a number from ``low`` to ``high``."""

    def read(table: Mapping[str, Any], key: str, place: str) -> float:
        value = table[key]
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not low <= value <= high:
            raise SceneError(f"{key} in {place} is {value!r}; use a number from {low:g} to {high:g}")
        return float(value)

    return dataclasses.field(default=float(default), metadata={"read": read})


def integer(default: int, low: int, high: int) -> Any:
    """A field that holds a whole number from ``low`` to ``high``."""

    def read(table: Mapping[str, Any], key: str, place: str) -> int:
        return whole(table, key, place, None, low, high)

    return dataclasses.field(default=default, metadata={"read": read})


def one_of(*allowed: str) -> Any:
    """A field that holds one of some texts, the first by default."""

    def read(table: Mapping[str, Any], key: str, place: str) -> str:
        if table[key] not in allowed:
            raise SceneError(f"{key} in {place} is {table[key]!r}; use one of {', '.join(allowed)}")
        return table[key]

    return dataclasses.field(default=allowed[0], metadata={"read": read})


def flag(default: bool) -> Any:
    """A field that is true or false."""

    def read(table: Mapping[str, Any], key: str, place: str) -> bool:
        if not isinstance(table[key], bool):
            raise SceneError(f"{key} in {place} is {table[key]!r}; use true or false")
        return table[key]

    return dataclasses.field(default=default, metadata={"read": read})


def colour(*default: float) -> Any:
    """A field that holds a linear Rec.709 colour, not negative and not black."""

    def read(table: Mapping[str, Any], key: str, place: str) -> tuple[float, float, float]:
        value = table[key]
        good = isinstance(value, (list, tuple)) and len(value) == 3
        good = good and all(
            isinstance(v, (int, float)) and not isinstance(v, bool) and 0 <= v < math.inf for v in value
        )
        if not good or not any(value):
            raise SceneError(f"{key} in {place} is {value!r}; use three numbers of 0 or more, as [1.0, 0.5, 0.2]")
        return tuple(float(v) for v in value)

    return dataclasses.field(default=tuple(map(float, default)), metadata={"read": read})


def names(kind: type) -> tuple[str, ...]:
    """The keys of a dataclass of such fields."""
    return tuple(field.name for field in dataclasses.fields(kind))


def read_settings(kind: type, table: Mapping[str, Any], place: str) -> Any:
    """An instance of ``kind`` from a table; absent keys keep their defaults."""
    given = {f.name: f.metadata["read"](table, f.name, place) for f in dataclasses.fields(kind) if f.name in table}
    return kind(**given)

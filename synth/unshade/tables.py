"""Reading tables of a scene: single values, and dataclasses whose fields state what they hold.

Every fault is an error that names the key, its table, and the nearest valid key or the values that would do.
"""

from __future__ import annotations

import dataclasses
import difflib
import math
from collections.abc import Callable, Collection, Mapping
from typing import Any, TypeVar

from .errors import SceneError

_Kind = TypeVar("_Kind")


class Table:
    """A table that is being read; ``place`` names it in errors, which are of the class ``error``."""

    def __init__(self, values: Mapping[str, Any], place: str, error: type[SceneError] = SceneError) -> None:
        self.values, self.place, self.error = values, place, error

    def __contains__(self, key: str) -> bool:
        return key in self.values

    def wrong(self, key: str, reason: str) -> SceneError:
        """The error of a wrong key."""
        return self.error(f"{key} in {self.place} {reason}", key=key)

    def _unusable(self, key: str, value: Any, wanted: str) -> SceneError:
        return self.wrong(key, f"is {'missing' if value is None else repr(value)}; use {wanted}")

    def require_known(self, known: Collection[str]) -> None:
        """Raise for a key that is not among the ``known``."""
        for key in self.values:
            if key not in known:
                near = difflib.get_close_matches(key, known, 1, 0.0)[0]
                raise self.error(f"unknown key '{key}' in {self.place}; did you mean '{near}'?", key=key)

    def subtable(self, key: str) -> Mapping[str, Any]:
        """A table in this table."""
        value = self.values.get(key)
        if not isinstance(value, dict):
            raise self.error(f"{self.place}: the table [{key}] is missing; write it", key=key)
        return value

    def text(self, key: str) -> str:
        """A text that is not empty."""
        value = self.values.get(key)
        if not isinstance(value, str) or not value:
            raise self.wrong(key, f'is missing or not a text; write {key} = "..."')
        return value

    def folder_name(self) -> str:
        """The ``name``, which folders carry."""
        name = self.text("name")
        if name in (".", "..") or any(c in '/\\:*?"<>|' or ord(c) < 32 for c in name):
            raise self.wrong("name", f"is {name!r}, but folders carry it; use letters, digits, - and _")
        return name

    def choice(self, key: str, allowed: tuple[Any, ...], default: Any = None) -> Any:
        """One of some texts or numbers."""
        value = self.values.get(key, default)
        if not isinstance(value, type(allowed[0])) or value not in allowed:
            words = [str(one) for one in allowed]
            wanted = " or ".join(words) if len(words) == 2 else f"one of {', '.join(words)}"
            raise self._unusable(key, value, wanted)
        return value

    def whole(self, key: str, low: int, high: int, default: int | None = None) -> int:
        """A whole number."""
        value = self.values.get(key, default)
        if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
            raise self._unusable(key, value, f"a whole number from {low} to {high}")
        return value

    def number(
        self,
        key: str,
        low: float = -math.inf,
        high: float = math.inf,
        default: float | None = None,
        *,
        above: float = -math.inf,
    ) -> float:
        """A finite number from ``low`` to ``high``, and above ``above``."""
        value = self.values.get(key, default)
        if not _is_number(value) or not low <= value <= high or not value > above:
            wanted = "a number"
            if above > -math.inf:
                wanted += f" above {above:g}" + (f", at most {high:g}" if high < math.inf else "")
            elif low > -math.inf:
                wanted += f" from {low:g} to {high:g}"
            raise self._unusable(key, value, wanted)
        return float(value)

    def flag(self, key: str, default: bool = False) -> bool:
        """True or false."""
        value = self.values.get(key, default)
        if not isinstance(value, bool):
            raise self._unusable(key, value, "true or false")
        return value

    def vector(
        self, key: str, wanted: str, count: int, low: float = -math.inf, high: float = math.inf, default: Any = None
    ) -> tuple[float, ...]:
        """``count`` finite numbers from ``low`` to ``high``."""
        value = self.values.get(key, default)
        good = isinstance(value, (list, tuple)) and len(value) == count and all(map(_is_number, value))
        if not good or not all(low <= v <= high for v in value):
            raise self._unusable(key, value, wanted)
        return tuple(map(float, value))


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def _field(default: Any, read: Callable[[Table, str], Any]) -> Any:
    given = {} if default is dataclasses.MISSING else {"default": default}
    return dataclasses.field(**given, metadata={"read": read})


def real(default: float | None, low: float = -math.inf, high: float = math.inf, *, above: float = -math.inf) -> Any:
    """A field that holds a number, see `Table.number`."""
    default = None if default is None else float(default)
    return _field(default, lambda table, key: table.number(key, low, high, above=above))


def integer(default: Any, low: int, high: int) -> Any:
    """A field that holds a whole number."""
    return _field(default, lambda table, key: table.whole(key, low, high))


def one_of(*allowed: Any, default: Any = dataclasses.MISSING) -> Any:
    """A field that holds one of some texts or numbers, the first by default."""
    default = allowed[0] if default is dataclasses.MISSING else default
    return _field(default, lambda table, key: table.choice(key, allowed))


def flag(default: bool) -> Any:
    """A field that is true or false."""
    return _field(default, lambda table, key: table.flag(key))


def vector(default: Any, wanted: str, count: int, low: float = -math.inf, high: float = math.inf) -> Any:
    """A field that holds some numbers; errors say what is ``wanted``."""
    return _field(default, lambda table, key: table.vector(key, wanted, count, low, high))


def numbers(wanted: str, fewest: int, most: int, low: float, high: float) -> Any:
    """A field that holds ``fewest`` to ``most`` different numbers, or by default none; errors say what is ``wanted``."""

    def read(table: Table, key: str) -> tuple[float, ...]:
        value = table.values[key]
        count = len(value) if isinstance(value, list) and fewest <= len(value) <= most else fewest
        found = table.vector(key, wanted, count, low, high)
        if len(set(found)) < count:
            raise table.wrong(key, f"is {value!r}; use {wanted}")
        return found

    return _field(None, read)


def colour(*default: float) -> Any:
    """A field that holds a linear Rec.709 colour, not negative and not black."""
    wanted = "three numbers of 0 or more, as [1.0, 0.5, 0.2]"

    def read(table: Table, key: str) -> tuple[float, ...]:
        value = table.vector(key, wanted, 3, 0.0)
        if not any(value):
            raise table.wrong(key, f"is {list(table.values[key])!r}; use {wanted}")
        return value

    return _field(tuple(map(float, default)), read)


def names(kind: type) -> tuple[str, ...]:
    """The keys of a dataclass."""
    return tuple(field.name for field in dataclasses.fields(kind))


def given(kind: type, table: Table) -> dict[str, Any]:
    """The values that a table states of a dataclass's fields, and those that it must state."""
    fields = [field for field in dataclasses.fields(kind) if "read" in field.metadata]
    stated = [field for field in fields if field.name in table or field.default is dataclasses.MISSING]
    return {field.name: field.metadata["read"](table, field.name) for field in stated}


def read(kind: type[_Kind], table: Table) -> _Kind:
    """A dataclass from a table that holds its keys and no other."""
    table.require_known(names(kind))
    return kind(**given(kind, table))


def changes(settings: Any) -> dict[str, Any]:
    """The values of a dataclass that differ from its defaults, as a table has them."""
    values = dataclasses.asdict(settings)
    defaults = {field.name: field.default for field in dataclasses.fields(settings)}
    return {key: value for key, value in values.items() if value != defaults[key]}

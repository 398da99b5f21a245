"""Dictionaries in the place of TOML files: a scene, a suite, a configuration."""

from __future__ import annotations

import json
import math
import os
import re
import tempfile
from collections.abc import Generator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from .errors import UnshadeError

Document = str | os.PathLike[str] | Mapping[str, Any]
"""A path, or what the file would hold as a dictionary; its relative paths are those of the current folder."""


@contextmanager
def as_file(given: Document, what: str, error: type[UnshadeError]) -> Generator[str | os.PathLike[str]]:
    """The file of ``given``: a dictionary is written to a temporary one, and errors name ``what`` in its place.

    Raises ``error`` for a value that TOML cannot hold.
    """
    if not isinstance(given, Mapping):
        yield given
        return
    with tempfile.TemporaryDirectory(prefix="unshade-") as folder:
        path = Path(folder) / f"{what}.toml"
        # The core reads paths of a file with this mark beside it as relative to the folder that the mark names.
        (Path(folder) / ".relative-to").write_text(os.getcwd())
        path.write_text(toml_of(given, what, error))
        try:
            yield path
        except UnshadeError as raised:
            message = re.sub(rf"{re.escape(str(path))}(:\d+)?", f"the {what} (a dict)", str(raised))
            if message == str(raised):
                raise
            raise type(raised)(message) from None


def toml_of(table: Mapping[str, Any], what: str, error: type[UnshadeError]) -> str:
    """The TOML text of a dictionary; one top-level key a line, lists of tables as such."""
    lines: list[str] = []
    tables: list[str] = []
    for key, value in table.items():
        if isinstance(value, Mapping):
            tables += [f"[{_key(key, what, error)}]", *_body(value, str(key), what, error)]
        elif _is_tables(value):
            for entry in value:
                tables += [f"[[{_key(key, what, error)}]]", *_body(entry, str(key), what, error)]
        elif value is not None:
            lines.append(f"{_key(key, what, error)} = {_value(value, str(key), what, error)}")
    return "\n".join([*lines, *tables, ""])


def _is_tables(value: Any) -> bool:
    if not isinstance(value, Sequence) or isinstance(value, str):
        return False
    entries: list[Any] = list(value)  # pyright: ignore[reportUnknownArgumentType]
    return bool(entries) and all(isinstance(entry, Mapping) for entry in entries)


def _body(table: Mapping[str, Any], place: str, what: str, error: type[UnshadeError]) -> list[str]:
    return [
        f"{_key(key, what, error)} = {_value(value, f'{place}.{key}', what, error)}"
        for key, value in table.items()
        if value is not None
    ]


def _key(key: object, what: str, error: type[UnshadeError]) -> str:
    if not isinstance(key, str):
        raise error(f"the {what} (a dict): {key!r} is not a text; keys are texts")
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else text_of(key)


def text_of(text: str) -> str:
    """The TOML string of a text; JSON leaves DEL bare."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _value(value: Any, place: str, what: str, error: type[UnshadeError]) -> str:
    if hasattr(value, "tolist"):  # numpy's numbers and arrays
        value = value.tolist()
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value) if math.isfinite(value) else str(value)
    if isinstance(value, str):
        return text_of(value)
    if isinstance(value, os.PathLike):
        return text_of(os.fspath(value))
    if isinstance(value, Mapping):
        body = _body(value, place, what, error)
        return "{" + ", ".join(body) + "}"
    if isinstance(value, Sequence) and not isinstance(value, bytes):
        return "[" + ", ".join(_value(entry, place, what, error) for entry in value) + "]"
    raise error(f"the {what} (a dict): {place} is a {type(value).__name__}; give texts, numbers, lists and dicts")

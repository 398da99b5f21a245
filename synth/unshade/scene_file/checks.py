"""Reading single values of a scene's tables; every fault is a `SceneError` that names the
key, its table, and the nearest valid key or the values that would do."""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping
from typing import Any

from ..errors import SceneError


def known_keys(table: Mapping[str, Any], known, place: str) -> None:
    for key in table:
        if key not in known:
            near = difflib.get_close_matches(key, known, 1, 0.0)[0]
            raise SceneError(f"unknown key '{key}' in {place}; did you mean '{near}'?")


def subtable(table: Mapping[str, Any], key: str, place: str) -> Mapping[str, Any]:
    value = table.get(key)
    if not isinstance(value, dict):
        raise SceneError(f"{place}: the table [{key}] is missing; write it")
    return value


def text(table: Mapping[str, Any], key: str, place: str) -> str:
    value = table.get(key)
    if not isinstance(value, str) or not value:
        raise SceneError(f'{key} in {place} is missing or no text; write {key} = "..."')
    return value


def folder_name(table: Mapping[str, Any], place: str) -> str:
    name = text(table, "name", place)
    if name in (".", "..") or any(c in '/\\:*?"<>|' or ord(c) < 32 for c in name):
        raise SceneError(f"name in {place} is {name!r}, but folders carry it; use letters, digits, - and _")
    return name


def choice(table: Mapping[str, Any], key: str, allowed: tuple[str, ...], place: str) -> str:
    value = table.get(key)
    if value not in allowed:
        said = "missing" if value is None else repr(value)
        raise SceneError(f"{key} in {place} is {said}; use one of {', '.join(allowed)}")
    return value


def whole(table: Mapping[str, Any], key: str, place: str, default: int | None, low: int, high: int) -> int:
    value = table.get(key, default)
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        said = "missing" if value is None else repr(value)
        raise SceneError(f"{key} in {place} is {said}; use a whole number from {low} to {high}")
    return value


def number(table: Mapping[str, Any], key: str, place: str, default: float, *, above: float = -math.inf) -> float:
    value = table.get(key, default)
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not number or math.isnan(value) or (key in table and math.isinf(value)) or not value > above:
        wanted = "a number" if above == -math.inf else f"a number above {above:g}"
        raise SceneError(f"{key} in {place} is {value!r}; use {wanted}")
    return float(value)


def yes_or_no(table: Mapping[str, Any], key: str, place: str, default: bool) -> bool:
    value = table.get(key, default)
    if not isinstance(value, bool):
        raise SceneError(f"{key} in {place} is {value!r}; use true or false")
    return value

"""Competitors: each a method in a file of its own, run from a suite by its name.

A method's class is what it gets, and no ranking mixes classes: *passive* gets the capture that every solver
gets; *controlled* gets photographs of the same face, from the same places, in light of its own choice.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from inspect import signature
from pathlib import Path
from typing import Any

from ..errors import SolveError
from ..stated_light import stated_light

PASSIVE = {"sh-lambert": "sh_lambert", "path-traced": "path_traced"}
"""Name to module, whose ``recover(capture, **settings)`` returns `Maps` and the light, as `Maps.write` takes both."""

CONTROLLED = {"binary-patterns": "binary_patterns", "flash-only": "flash_only", "light-stage": "light_stage"}
"""Name to module, whose ``recover(capture, laboratory, **settings)`` returns `Maps`."""


def require_still_light(name: str, capture: Path) -> None:
    """Raises `SolveError` if the passive method ``name`` cannot use the capture's light. Controlled methods photograph
    the face in lights of their own."""
    fault = stated_light(capture).fault
    if name in PASSIVE and fault is not None:
        raise SolveError(f"{fault}, but {name} assumes one light that stands still and equal exposures; use unshade")


def method(name: str, settings: dict[str, Any]) -> Callable[..., Any]:
    """The method's ``recover``. Raises `SolveError` for unknown settings."""
    module = import_module(f".{(PASSIVE | CONTROLLED)[name]}", __package__)
    recover: Callable[..., Any] = module.recover
    known = [key for key, value in signature(recover).parameters.items() if value.kind is value.KEYWORD_ONLY]
    for key in settings:
        if key not in known:
            raise SolveError(f"{name}: unknown setting {key!r}; there are {', '.join(known)}")
    return recover

"""The `[labels]` table."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any

from ..errors import SceneError
from .checks import known_keys, number, yes_or_no


@dataclass(frozen=True)
class LabelFaults:
    """Faults of the label pictures that solvers get; none by default. The truth keeps the perfect ones."""

    boundary_error: float = 0.0
    """Share of the boundary pixels of every training view that take the label of the other side.

    A boundary pixel has a label and, above, below, left or right of it, a pixel of another label
    (0, the background, is none). Both sides of a boundary count. The wrong ones lie in runs of a
    few pixels along one side, as where a face parser misses an edge; 1 swaps both sides everywhere.
    """
    omit: bool = False
    """The capture has no label pictures, and ``transforms.json`` names none."""

    one: bool = False
    """Everything that has a label is "skin", as where nobody outlined lips, brows and hair."""

    hair_is_skin: bool = False
    """What is "scalp" is "skin", as where a parser knows the features of a face alone."""

    def to_table(self) -> dict[str, Any]:
        """Keys that differ from the defaults, with their values, as the scene file has them."""
        return {key: value for key, value in asdict(self).items() if value != getattr(LabelFaults(), key)}


def parse_labels(table: Mapping[str, Any], place: str) -> LabelFaults:
    known_keys(table, [field.name for field in fields(LabelFaults)], place)
    error = number(table, "boundary_error", place, LabelFaults.boundary_error)
    if not 0 <= error <= 1:
        raise SceneError(f"boundary_error in {place} is {error:g}; use a number from 0 to 1")
    omit, one, hair_is_skin = (
        yes_or_no(table, key, place, getattr(LabelFaults, key)) for key in ("omit", "one", "hair_is_skin")
    )
    if omit and "boundary_error" in table:
        raise SceneError(f"boundary_error in {place} does nothing where omit = true leaves no labels; keep one")
    others = {"omit": omit, "boundary_error": error, "hair_is_skin": hair_is_skin}
    if one and any(others.values()):
        other = next(key for key, value in others.items() if value)
        raise SceneError(f"one = true in {place} leaves nothing to {other}; keep one of them")
    if omit and hair_is_skin:
        raise SceneError(f"omit = true in {place} leaves nothing to hair_is_skin; keep one of them")
    return LabelFaults(error, omit, one, hair_is_skin)

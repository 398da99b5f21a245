"""The `[labels]` table."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ..errors import SceneError
from ..tables import Table, changes, flag, read, real


@dataclass(frozen=True)
class LabelFaults:
    """Faults of the label pictures that solvers get; none by default. The truth keeps the perfect ones."""

    boundary_error: float = real(0.0, 0.0, 1.0)
    """Share of the boundary pixels of every training view that take the label of the other side.

    A boundary pixel has a label and, above, below, left or right of it, a pixel of another label
    (0, the background, is none). Both sides of a boundary count. The wrong ones lie in runs of a
    few pixels along one side, as where a face parser misses an edge; 1 swaps both sides everywhere.
    """
    omit: bool = flag(False)
    """The capture has no label pictures, and ``transforms.json`` names none."""

    one: bool = flag(False)
    """Everything that has a label is "skin", as where nobody outlined lips, brows and hair."""

    hair_is_skin: bool = flag(False)
    """What is "scalp" is "skin", as where a parser knows the features of a face alone."""

    def to_table(self) -> dict[str, Any]:
        """Keys that differ from the defaults, with their values, as the scene file has them."""
        return changes(self)


def parse_labels(values: Mapping[str, Any], place: str) -> LabelFaults:
    table = Table(values, place)
    faults = read(LabelFaults, table)
    if faults.omit and "boundary_error" in table:
        raise table.wrong("boundary_error", "does nothing where omit = true leaves no labels; keep one")
    other = next((key for key in ("omit", "boundary_error", "hair_is_skin") if getattr(faults, key)), None)
    if faults.one and other:
        raise SceneError(f"one = true in {place} leaves nothing to {other}; keep one of them", key="one")
    if faults.omit and faults.hair_is_skin:
        raise SceneError(f"omit = true in {place} leaves nothing to hair_is_skin; keep one of them", key="omit")
    return faults

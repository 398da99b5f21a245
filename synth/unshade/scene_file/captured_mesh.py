"""The `[captured_mesh]` table."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from .checks import known_keys


@dataclass(frozen=True)
class CapturedMesh:
    """What is wrong with the mesh that solvers get; nothing by default. The truth keeps the perfect one."""

    def to_table(self) -> dict[str, Any]:
        """What differs from the defaults; empty where nothing does."""
        return {key: value for key, value in asdict(self).items() if value != getattr(CapturedMesh(), key)}


def parse_captured_mesh(table: Mapping[str, Any], place: str) -> CapturedMesh:
    known_keys(table, (), place)
    return CapturedMesh()

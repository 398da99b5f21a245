"""The `[image_formation]` table."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from .checks import known_keys


@dataclass(frozen=True)
class Formation:
    """How a camera turns radiance into the picture that solvers get; all off by default."""

    def to_table(self) -> dict[str, Any]:
        """What differs from the defaults; empty where nothing does."""
        return {key: value for key, value in asdict(self).items() if value != getattr(Formation(), key)}


def parse_formation(table: Mapping[str, Any], place: str) -> Formation:
    known_keys(table, (), place)
    return Formation()

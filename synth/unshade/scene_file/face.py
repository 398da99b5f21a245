"""The `[face]` table: a generated face, or files of a head of one's own."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..face.spec import FaceSpec

AnyHead = FaceSpec


def parse_face(table: Mapping[str, Any], place: str, folder: Path) -> AnyHead:
    """``folder`` is what relative file names start from."""
    return FaceSpec.from_table(table, place=place)

"""The `[face]` table: a generated face, or the files of your own head."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..face.spec import FaceSpec
from ..own_head.spec import HeadFiles

AnyHead = FaceSpec | HeadFiles


def parse_face(table: Mapping[str, Any], place: str, folder: Path) -> AnyHead:
    """A table with a ``mesh`` names files, any other a face to generate.

    ``folder`` is what relative file names start from.
    """
    if "mesh" in table:
        return HeadFiles.from_table(table, place=place, folder=folder)
    return FaceSpec.from_table(table, place=place)

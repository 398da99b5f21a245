"""The programs whose cameras are read."""

from __future__ import annotations

from pathlib import Path

from ..errors import CaptureError
from .colmap_model import read_colmap
from .emily_folder import read_emily
from .metashape_file import read_metashape
from .source import Source
from .tracked_folder import read_tracked
from .transforms_file import read_transforms

FORMATS = ("transforms", "colmap", "metashape", "emily", "tracked")


def read_source(format: str, path: Path, pictures: Path | None = None) -> Source:
    """The cameras of a capture. Raises `CaptureError`."""
    if format == "transforms":
        return read_transforms(path)
    readers = {"colmap": read_colmap, "metashape": read_metashape, "emily": read_emily, "tracked": read_tracked}
    if format not in readers:
        raise CaptureError(
            f"format {format!r} is unknown; there are {', '.join(FORMATS)} (RealityCapture exports colmap)"
        )
    return readers[format](path, pictures)

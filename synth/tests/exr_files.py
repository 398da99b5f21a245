"""Uncompressed EXR files written byte by byte, with what the renderer's writer cannot state."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np

ACESCG = (0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767)
XYZ = (1, 0, 0, 1, 0, 0, 1 / 3, 1 / 3)


def write_exr_file(
    path: Path,
    channels: dict[str, np.ndarray],
    *,
    corner: tuple[int, int] = (0, 0),
    display: tuple[int, int] | None = None,
    chromaticities: tuple[float, ...] | None = None,
    envmap: int | None = None,
) -> None:
    """Planes [H, W] by name; ``corner`` is where the data window begins in a display window
    from 0, 0 of ``display`` (width, height)."""
    planes = {name: np.asarray(channels[name], "<f4") for name in sorted(channels)}
    height, width = next(iter(planes.values())).shape
    across, down = display or (width, height)
    window = struct.pack("<4i", *corner, corner[0] + width - 1, corner[1] + height - 1)
    listed = b"".join(name.encode() + b"\0" + struct.pack("<iBxxxii", 2, 0, 1, 1) for name in planes) + b"\0"
    attributes = [
        ("channels", "chlist", listed), ("compression", "compression", b"\0"), ("dataWindow", "box2i", window),
        ("displayWindow", "box2i", struct.pack("<4i", 0, 0, across - 1, down - 1)), ("lineOrder", "lineOrder", b"\0"),
        ("pixelAspectRatio", "float", struct.pack("<f", 1)), ("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
        ("screenWindowWidth", "float", struct.pack("<f", 1)),
    ]  # fmt: skip
    if chromaticities is not None:
        attributes.append(("chromaticities", "chromaticities", struct.pack("<8f", *chromaticities)))
    if envmap is not None:
        attributes.append(("envmap", "envmap", bytes([envmap])))
    text = b"".join(
        f"{name}\0{kind}\0".encode() + struct.pack("<i", len(value)) + value for name, kind, value in attributes
    )
    head = struct.pack("<2i", 20000630, 2) + text + b"\0"
    row = 8 + 4 * width * len(planes)
    first = len(head) + 8 * height
    offsets = b"".join(struct.pack("<Q", first + row * y) for y in range(height))
    rows = b"".join(
        struct.pack("<2i", corner[1] + y, row - 8) + b"".join(plane[y].tobytes() for plane in planes.values())
        for y in range(height)
    )
    path.write_bytes(head + offsets + rows)

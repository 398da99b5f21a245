"""Makes docs/light.jpg: ``python docs/light_picture.py CAPTURE MAPS [MAPS ...] [-- CAPTURE MAPS ...] ...``.

A row for every capture: its light as the mean of the solver's cells, then what each solve found, latitude over
longitude. Radiance L, scaled to the same mean over the sphere, is shown as sRGB of L / (1 + L).
"""

from __future__ import annotations

import sys
from itertools import groupby
from pathlib import Path

import numpy as np
from picture import picture, srgb
from PIL import Image

ROWS = 16
CELL = 12
#: Mean radiance of what is shown.
MEAN = 0.5


def tile(light: np.ndarray) -> np.ndarray:
    """The cells of a light as squares, with a margin of white."""
    cells = light.reshape(ROWS, len(light) // ROWS, 2 * ROWS, -1, 3).mean((1, 3))
    weight = np.sin((np.arange(ROWS) + 0.5) / ROWS * np.pi)[:, None, None]
    cells = cells * MEAN * (weight * np.ones_like(cells)).sum() / (weight * cells).sum()
    shown = srgb(cells / (1 + cells)).repeat(CELL, 0).repeat(CELL, 1)
    return np.pad(shown, ((2, 2), (2, 2), (0, 0)), constant_values=255)


def main(rows: list[list[Path]]) -> None:
    """Writes ``docs/light.jpg``."""
    lights = [[capture / "truth" / "light.exr", *(one / "light.exr" for one in maps)] for capture, *maps in rows]
    tiles = [np.concatenate([tile(picture(path)) for path in row], axis=1) for row in lights]
    Image.fromarray(np.concatenate(tiles)).save(Path(__file__).with_name("light.jpg"), quality=92)


if __name__ == "__main__":
    parts = groupby(sys.argv[1:], lambda word: word == "--")
    main([[Path(word) for word in words] for separator, words in parts if not separator])

"""Makes the README's picture from a finished run: ``python docs/picture.py runs/demo``."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
from PIL import Image

import unshade
from unshade.files.pictures import read_exr, read_gray
from unshade.render import llvm

llvm.activate(llvm.choose())

SIDE = 420
"""Width of a tile, pixels."""
GAP = 6


def srgb(linear: np.ndarray) -> np.ndarray:
    """8-bit sRGB (IEC 61966-2-1) of linear values."""
    x = np.clip(linear, 0, 1)
    return np.round(255 * np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)).astype(np.uint8)


def picture(path: Path) -> np.ndarray:
    """The channels R, G and B of a float EXR."""
    channels = read_exr(path)
    return np.stack([channels[name] for name in "RGB"], axis=-1)


def head(mask: np.ndarray) -> tuple[slice, slice]:
    """A square around the face, with room for the hair above it."""
    rows, columns = np.nonzero(mask)
    side = int(1.35 * max(np.ptp(rows), np.ptp(columns)))
    top = max(0, int(rows.max() - 0.9 * side))
    left = max(0, int((columns.min() + columns.max() - side) / 2))
    return slice(top, top + side), slice(left, left + side)


def sized(pixels: np.ndarray, like: np.ndarray) -> np.ndarray:
    """A picture in the size of another."""
    return np.asarray(Image.fromarray(pixels).resize(like.shape[::-1], Image.Resampling.LANCZOS))


def tile(pixels: np.ndarray) -> np.ndarray:
    """A tile of the picture with its gap."""
    small = np.asarray(Image.fromarray(pixels).resize((SIDE, SIDE), Image.Resampling.LANCZOS))
    return np.pad(small, ((0, GAP), (0, GAP), (0, 0)), constant_values=255)


def main(run: Path) -> None:
    """Writes ``docs/demo.jpg`` from the first case and solver of ``run``: the truth above what was recovered."""
    case = json.loads((run / "run.json").read_text())["cases"][0]
    solver, capture = case["solvers"][0], unshade.Capture(run / case["capture"])
    frame, lights = capture.withheld[-1], [case["light"]]
    relit = capture.path / "truth/relit"
    lights += sorted({path.name for path in relit.iterdir()} - set(lights))[:2]
    true, maps = capture.truth(), unshade.Maps.read(run / solver["maps"])
    face = head(read_gray(capture.path / "masks" / f"{frame}.png"))
    chart = head(true.coverage)
    normal = lambda n: np.round(255 * (0.5 * n + 0.5)).astype(np.uint8)
    shown = lambda m: [srgb(m.diffuse_albedo), normal(m.specular_normal)]
    rows = []
    for folder, of in ((relit, true), (run / solver["relit"] / "global", maps)):
        tiles = [srgb(picture(folder / light / f"{frame}.exr"))[face] for light in lights]
        tiles += [(sized(pixels, true.coverage) * (true.coverage > 0)[..., None])[chart] for pixels in shown(of)]
        rows.append(np.concatenate([tile(pixels) for pixels in tiles], axis=1))
    Image.fromarray(np.concatenate(rows)[:-GAP, :-GAP]).save(Path(__file__).with_name("demo.jpg"), quality=90)


if __name__ == "__main__":
    main(Path(sys.argv[1]))

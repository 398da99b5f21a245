"""Makes the README's picture from a finished run: ``python docs/picture.py runs/demo``."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
from PIL import Image

import unshade
from unshade.files.pictures import read_exr
from unshade.render import llvm

llvm.activate(llvm.choose())

SIDE = 256


def srgb(linear: np.ndarray) -> np.ndarray:
    """8-bit sRGB (IEC 61966-2-1) of linear values."""
    x = np.clip(linear, 0, 1)
    return np.round(255 * np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)).astype(np.uint8)


def picture(path: Path) -> np.ndarray:
    """The channels R, G and B of a float EXR."""
    channels = read_exr(path)
    return np.stack([channels[name] for name in "RGB"], axis=-1)


def tile(pixels: np.ndarray) -> np.ndarray:
    """A square of the picture's row."""
    return np.asarray(Image.fromarray(pixels).resize((SIDE, SIDE), Image.Resampling.LANCZOS))


def main(run: Path) -> None:
    """Writes ``docs/demo.jpg`` from the first case and solver of ``run``."""
    case = json.loads((run / "run.json").read_text())["cases"][0]
    solver, capture = case["solvers"][0], unshade.Capture(run / case["capture"])
    frame = capture.withheld[-1]
    truth = picture(capture.path / "images" / f"{frame}.exr")
    relit = picture(run / solver["relit"] / "global" / case["light"] / f"{frame}.exr")
    true, maps = capture.truth(), unshade.Maps.read(run / solver["maps"])
    inside = (capture.truth().coverage > 0)[..., None]
    normal = lambda n: np.round(255 * (0.5 * n + 0.5)).astype(np.uint8)
    tiles = [
        srgb(truth), srgb(relit), srgb(4 * np.abs(truth - relit)),
        srgb(true.diffuse_albedo * inside), srgb(maps.diffuse_albedo * inside),
        normal(true.specular_normal) * inside, normal(maps.specular_normal) * inside,
    ]  # fmt: skip
    row = np.concatenate([tile(pixels) for pixels in tiles], axis=1)
    Image.fromarray(row).save(Path(__file__).with_name("demo.jpg"), quality=88)


if __name__ == "__main__":
    main(Path(sys.argv[1]))

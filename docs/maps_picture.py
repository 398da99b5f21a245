"""Makes docs/maps.jpg: ``python docs/maps_picture.py CAPTURE MAPS [MAPS ...]``.

Diffuse albedo above, specular normals below; the truth first, then what each solver left, with its
own factor on the albedo (the one that scores call global: least squares over the seen texels).
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from picture import srgb, tile
from PIL import Image

import unshade


def at_size(texture: np.ndarray, side: int) -> np.ndarray:
    """Means of blocks down to ``side`` texels, or copies up to it; both sides powers of two."""
    size = len(texture)
    if size > side:
        return texture.reshape(side, size // side, side, size // side, -1).mean((1, 3))
    return texture.repeat(side // size, 0).repeat(side // size, 1)


def column(maps: unshade.Maps, true: unshade.Maps, seen: np.ndarray) -> np.ndarray:
    """The two tiles of one solver, masked to what was seen."""
    side = len(seen)
    albedo, truth = at_size(maps.diffuse_albedo, side), at_size(true.diffuse_albedo, side)
    factor = (albedo * truth)[seen].sum() / (albedo**2)[seen].sum()
    normal = np.round(255 * (0.5 * at_size(maps.specular_normal, side) + 0.5)).astype(np.uint8)
    inside = seen[..., None]
    return np.concatenate([tile(srgb(factor * albedo * inside)), tile(normal * inside)])


def main(capture: Path, solved: list[Path]) -> None:
    """Writes ``docs/maps.jpg``."""
    true = unshade.Capture(capture).truth()
    maps = [unshade.Maps.read(folder) for folder in solved]
    seen = np.all([at_size((m.coverage > 0)[..., None], 512)[..., 0] > 0 for m in maps], axis=0)
    columns = [column(one, true, seen) for one in (true, *maps)]
    Image.fromarray(np.concatenate(columns, axis=1)).save(Path(__file__).with_name("maps.jpg"), quality=90)


if __name__ == "__main__":
    main(Path(sys.argv[1]), [Path(name) for name in sys.argv[2:]])

"""Pictures that Cycles wrote, as the layers that Mitsuba's have."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..errors import RendererError
from ..files.pictures import read_exr
from ..render.layers import Layers
from ..render.passes import seed_of

PASSES = 4
"""Pictures of one view, each with its share of the samples; their spread is the variance of the mean."""


def seeds(*parts: object) -> list[int]:
    """Cycles' seeds of one view, which depend on every part."""
    return [seed_of("cycles", *parts, number) >> 1 for number in range(PASSES)]


def samples_each(samples: int) -> int:
    return max(1, samples // PASSES)


def read_layers(folder: Path, view: str) -> Layers:
    """The mean of a view's pictures ``<view>-<number>.exr``, split at the first surface as Cycles' own passes are.

    The pictures are removed.
    """
    paths = [folder / f"{view}-{number}.exr" for number in range(PASSES)]
    pictures = [_split(path) for path in paths]
    for path in paths:
        path.unlink()
    diffuse, specular = (np.stack([picture[layer] for picture in pictures]) for layer in range(2))
    variance = (diffuse + specular).var(0, ddof=1) / PASSES
    return Layers(*(values.astype(np.float32) for values in (diffuse.mean(0), specular.mean(0), variance)))


def _split(path: Path) -> tuple[np.ndarray, np.ndarray]:
    channels = read_exr(path)
    found = {name.split(".", 1)[-1]: plane for name, plane in channels.items()}

    def colour(name: str) -> np.ndarray:
        try:
            return np.stack([found[f"{name}.{c}"] for c in "RGB"], -1).astype(np.float64)
        except KeyError as missing:
            raise RendererError(f"{path}: Blender wrote no channel {missing}; use Blender 5.0") from missing

    return tuple(  # type: ignore[return-value]
        (colour(f"{layer} Direct") + colour(f"{layer} Indirect")) * colour(f"{layer} Color")
        for layer in ("Diffuse", "Glossy")
    )

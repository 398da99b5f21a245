"""Small pictures for notebooks: HTML that needs no network."""

from __future__ import annotations

import base64
import html
import io
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._native import Capture
from .srgb import encoded

_SIDE = 160
_VIEWS = 8


def of_maps(title: str, maps: Iterable[tuple[str, NDArray[Any]]]) -> str:
    """Returns every map as a picture of its own range, under its name."""
    return _strip(title, ((name, _shown(name, array)) for name, array in maps))


def of_capture(capture: Capture) -> str:
    """Returns the first training views, exposed alike."""
    names = capture.train[:_VIEWS]
    pictures = {name: _small(capture.image(name)) for name in names}
    bright = max((float(np.percentile(picture, 99)) for picture in pictures.values()), default=1.0)
    return _strip(repr(capture), ((name, _srgb(picture / max(bright, 1e-6))) for name, picture in pictures.items()))


def _shown(name: str, array: NDArray[Any]) -> NDArray[np.uint8]:
    small = np.nan_to_num(_small(array))
    if name.endswith("_albedo"):
        return _srgb(small / max(float(np.percentile(small, 99.5)), 1e-6) if name.startswith("specular") else small)
    if name.endswith("_normal"):
        return np.clip(small * 127.5 + 127.5, 0, 255).astype(np.uint8)
    return np.clip(small if name == "coverage" else small * 255, 0, 255).astype(np.uint8)


def _small(picture: NDArray[Any]) -> NDArray[np.float32]:
    """Every n-th pixel, `_SIDE` or fewer a side."""
    step = -(-max(picture.shape[:2]) // _SIDE)
    return np.asarray(picture[::step, ::step], np.float32)


def _srgb(linear: NDArray[np.float32]) -> NDArray[np.uint8]:
    return np.round(255 * encoded(np.clip(linear, 0, 1))).astype(np.uint8)


def _strip(title: str, pictures: Iterable[tuple[str, NDArray[np.uint8]]]) -> str:
    from PIL import Image

    def figure(name: str, picture: NDArray[np.uint8]) -> str:
        file = io.BytesIO()
        Image.fromarray(picture).save(file, "PNG")
        data = base64.b64encode(file.getvalue()).decode()
        source = f"data:image/png;base64,{data}"
        word = html.escape(name)
        style = "display:inline-block;margin:4px"
        return f'<figure style="{style}"><img src="{source}" alt="{word}"><figcaption>{word}</figcaption></figure>'

    return f"<p>{html.escape(title)}</p>" + "".join(figure(*pair) for pair in pictures)

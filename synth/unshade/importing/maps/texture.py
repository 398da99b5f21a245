"""Another method's texture: its codes as stored, made linear, and looked up between texels."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ... import _native
from ...errors import MapsError
from ...face.texels import Texels
from ...files.pictures import ROUGHNESS_CHANNELS
from ..pictures import decode, read_photograph

Floats = NDArray[np.float32]

ENDINGS = (".exr", ".png", ".tif", ".tiff", ".jpg", ".jpeg", ".hdr")

DEVIATION = "_std"
"""End of the name of a map's standard deviation per texel."""

_CHANNELS = {"R": 0, "G": 1, "B": 2}


@dataclass(frozen=True)
class Codes:
    """A square picture's numbers (N,N,3) as stored, row 0 on top: 0 to 1 of integers, any of floats.

    ``alpha`` (N,N) is its fourth channel, ``exact`` whether it holds floats, ``lobes`` whether its channels are
    alpha1, alpha2, share1, ``grey`` whether there is one.
    """

    path: Path
    values: Floats
    alpha: Floats | None
    exact: bool
    lobes: bool = False
    grey: bool = False

    @property
    def size(self) -> int:
        """Texels along a side."""
        return len(self.values)

    def plane(self, channel: str) -> Floats:
        """One channel (N,N), or the mean of R, G, B. Raises `MapsError`."""
        if channel == "mean":
            return np.asarray(self.values.mean(-1), np.float32)
        if channel == "A":
            if self.alpha is None:
                raise MapsError(f"{self.path}: has no alpha; name another channel")
            return self.alpha
        return self.values[..., _CHANNELS[channel]]


def find_texture(
    folder: Path, patterns: tuple[str, ...], taken: Collection[Path] = (), *, below: bool = True
) -> Path | None:
    """The first file that a name or pattern fits, without regard to case; a name without an ending fits any picture.
    A pattern fits no file that is ``taken``, and no standard deviation (``_std``); ``below`` takes folders in."""
    paths = folder.rglob("*") if below else folder.glob("*")
    files = [path for path in paths if path.is_file() and path.suffix.lower() in ENDINGS]
    files = [path for path in files if not path.stem.endswith(DEVIATION)]
    files.sort(key=lambda path: (len(path.parts), path))
    for pattern in patterns:
        whole = Path(pattern).suffix.lower() in (*ENDINGS, ".*")
        for path in files:
            name = path.relative_to(folder) if whole else path.relative_to(folder).with_suffix("")
            if Path(name.as_posix().lower()).match(pattern.lower()) and not ("*" in pattern and path in taken):
                return path
    return None


def read_codes(path: Path) -> Codes:
    """Reads a texture as it is stored. Raises `MapsError` or `PictureError`."""
    alpha = None
    exact = path.suffix.lower() in (".exr", ".hdr")
    lobes = grey = False
    if path.suffix.lower() == ".exr":
        names, planes = _native.read_exr(path)
        short = [name.rsplit(".")[-1].upper() for name in names]
        lobes = set(short) == {name.upper() for name in ROUGHNESS_CHANNELS}
        order = [name.upper() for name in ROUGHNESS_CHANNELS] if lobes else list("RGB")
        grey = not set(order) <= set(short)
        if grey and len(set(short) - {"A"}) != 1:
            raise MapsError(
                f"{path}: has channels {', '.join(names)}; write R, G, B, or one, or {', '.join(ROUGHNESS_CHANNELS)}"
            )
        values = np.ascontiguousarray(planes[..., [0, 0, 0] if grey else [short.index(name) for name in order]])
        alpha = planes[..., short.index("A")] if "A" in short else None
    else:
        photograph = read_photograph(path, "linear")
        values, alpha = photograph.radiance, photograph.alpha
    height, width = values.shape[:2]
    if height != width:
        raise MapsError(f"{path}: is {width} x {height} texels; write a square texture that fills the unit square")
    return Codes(path, values, alpha, exact, lobes, grey)


def linear(values: Floats, curve: str) -> Floats:
    """Values after a transfer curve of `CURVES` is undone; those below 0 or above 1 are continued by it."""
    if curve == "linear":
        return values
    return np.asarray(np.sign(values) * decode(np.abs(values), curve), np.float32)


def padded(values: Floats, chart: Texels) -> Floats:
    """The picture (N,N,...) with every texel outside the chart like its nearest inside, so that no seam bleeds."""
    return values[chart.nearest_inside()]


def halved(values: Floats, chart: NDArray[np.bool_]) -> Floats:
    """Means of 2 x 2 texels inside the chart; where all four are outside, of these."""
    weight = np.where(chart, 1.0, 1e-6).astype(np.float32)
    weight = weight.reshape(*weight.shape, *[1] * (values.ndim - 2))
    n = len(values) // 2
    fold = lambda picture: picture[: 2 * n, : 2 * n].reshape(n, 2, n, 2, *picture.shape[2:]).sum((1, 3))
    return np.asarray(fold(values * weight) / fold(weight), np.float32)


def sampled(values: Floats, uv: NDArray[np.float64]) -> Floats:
    """A picture (N,N,...) whose row 0 lies at v = 1, at places (M,2): bilinear, clamped at the border."""
    n = len(values)
    x = (uv[:, 0] * n - 0.5).clip(0, n - 1)
    y = ((1 - uv[:, 1]) * n - 0.5).clip(0, n - 1)
    # A place on a texel's centre is that texel, whatever rounding leaves of it.
    x, y = (np.where(np.abs(p - np.rint(p)) < 1e-3, np.rint(p), p) for p in (x, y))
    left, top = np.floor(x).astype(int), np.floor(y).astype(int)
    right, bottom = np.minimum(left + 1, n - 1), np.minimum(top + 1, n - 1)
    ends = (len(uv), *[1] * (values.ndim - 2))
    across, down = ((p - low).astype(np.float32).reshape(ends) for p, low in ((x, left), (y, top)))
    above = values[top, left] + (values[top, right] - values[top, left]) * across
    below = values[bottom, left] + (values[bottom, right] - values[bottom, left]) * across
    return np.asarray(above + (below - above) * down, np.float32)

"""LPIPS (Zhang et al. 2018): how far apart a network sees two pictures, by its authors' package.

It is the extra ``lpips``. The weights of AlexNet and VGG-16 are fetched once, by torchvision, into ``TORCH_HOME``;
those of the distance come with the package, version 0.1.
"""

from __future__ import annotations

import importlib.metadata
import os
import warnings
from functools import lru_cache

import numpy as np

from . import _native
from .errors import MetricError

NETS = ("alex", "vgg")


def distance(net: str, prediction, truth, mask=None, *, erode=False, scale="none") -> float:
    """LPIPS of a linear picture and its truth, lower is better; arguments as those of :mod:`unshade.metrics`.

    The network sees sRGB values clipped to [0, 1], black outside the mask, and the whole frame counts. Pictures of
    one channel are shown as grey. Raises ``errors.MetricError`` without the extra or its weights.
    """
    network = _network(net)
    import torch

    shown = _native.shown(prediction, truth, mask, erode=erode, scale=scale)
    if min(shown[0].shape[:2]) < 32:
        raise MetricError(f"prediction is {shown[0].shape[1]}x{shown[0].shape[0]}; LPIPS needs 32 pixels a side")
    planes = [np.broadcast_to(picture, (*picture.shape[:2], 3)).transpose(2, 0, 1)[None] for picture in shown]
    tensors = [torch.from_numpy(np.ascontiguousarray(2 * plane - 1)) for plane in planes]
    threads = torch.get_num_threads()
    torch.set_num_threads(1)  # the order of sums, and with it the last digit, depends on it
    try:
        with torch.no_grad():
            return float(network(*tensors))
    finally:
        torch.set_num_threads(threads)


def judge(net: str, pictures: list[dict[str, str]]) -> list[float]:
    """LPIPS of every pair of files (``picture``, ``truth``, ``mask``), on the mask eroded once by 5 x 5."""
    _network(net)

    def judged(pair: dict[str, str]) -> float:
        both = (
            _native.read_exr(pair[which], ["R", "G", "B"], colour=True, finite=False)[1] for which in ("picture", "truth")
        )  # fmt: skip
        return distance(net, *both, _native.read_gray(pair["mask"]), erode=True)

    return [judged(pair) for pair in pictures]


def found() -> str:
    """The version of LPIPS on this machine, in words."""
    try:
        return importlib.metadata.version("lpips")
    except importlib.metadata.PackageNotFoundError:
        return "unavailable (optional): pip install 'unshade[lpips]'"


@lru_cache
def _network(net: str):
    if net not in NETS:
        raise MetricError(f"there is no network {net!r} for LPIPS: {', '.join(NETS)}")
    try:
        import lpips
    except (ImportError, OSError) as error:
        raise MetricError(f"LPIPS is unavailable ({error}); pip install 'unshade[lpips]'") from None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # torchvision's, of arguments that lpips gives it
            return lpips.LPIPS(net=net, version="0.1", verbose=False).eval()
    except (OSError, RuntimeError) as error:
        home = os.environ.get("TORCH_HOME", "~/.cache/torch")
        fix = f"they are fetched once into TORCH_HOME, which is {home}"
        raise MetricError(f"LPIPS is unavailable: no weights of {net} ({error}); {fix}") from None

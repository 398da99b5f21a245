"""Regions of similar skin, from the labels of the views."""

from __future__ import annotations

import numpy as np

from unshade import Capture

from .texel_samples import TexelSamples


def regions(capture: Capture, texels: TexelSamples) -> np.ndarray:
    """(M,) the label of each texel in the view that sees it best, as 0 to n - 1; 0 for all without labels."""
    labels = [capture.labels(name) for name in capture.train]
    best = texels.weights.argmax(0)
    found = np.zeros(len(best), int)
    for view, picture in enumerate(labels):
        if picture is not None:
            mine = best == view
            column, row = np.rint(texels.pixels[view, mine]).astype(int).T
            found[mine] = picture[row.clip(0, picture.shape[0] - 1), column.clip(0, picture.shape[1] - 1)]
    return np.unique(found, return_inverse=True)[1]

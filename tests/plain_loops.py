"""A method of one's own that keeps one processor busy: a reweighted mean of each texel, in plain loops.

`tests/heavy_cluster.py` hands it to a suite: while it computes, one process leaves the other processors idle.
"""

import numpy as np

import unshade

SIZE = 96
ROUNDS = 40


def recover(capture: unshade.Capture) -> unshade.Maps:
    samples: dict[int, list[np.ndarray]] = {}
    for name in capture.train:
        mesh = capture.gbuffer(name)
        inside = (capture.mask(name) > 127) & np.isfinite(mesh["uvs"]).all(-1)
        u, v = np.clip(mesh["uvs"][inside].T, 0, 0.9999)
        texels = (SIZE - 1 - (v * SIZE).astype(int)) * SIZE + (u * SIZE).astype(int)
        for texel, colour in zip(texels, capture.image(name)[inside], strict=True):
            samples.setdefault(int(texel), []).append(colour)
    albedo = np.full((SIZE * SIZE, 3), 0.4)
    for texel, colours in samples.items():
        albedo[texel] = np.clip(_robust_mean(colours), 0, 1)
    return unshade.Maps(diffuse_albedo=albedo.reshape(SIZE, SIZE, 3).astype(np.float32))


def _robust_mean(colours: list[np.ndarray]) -> np.ndarray:
    """By weights of Cauchy, so that a highlight in one view counts little."""
    mean = sum(colours) / len(colours)
    for _ in range(ROUNDS):
        weights = [1 / (1 + float(((colour - mean) ** 2).sum()) / 1e-3) for colour in colours]
        mean = sum(weight * colour for weight, colour in zip(weights, colours, strict=True)) / sum(weights)
    return mean

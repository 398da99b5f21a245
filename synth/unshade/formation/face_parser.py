"""Labels as an imperfect face parser gives them."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter

from ..camera.camera import Camera
from ..face import Label
from ..scene_file import Scene
from .seeds import generator

_RUN_PIXELS = 2.0
"""Standard deviation of the blur of the noise that picks the wrong pixels: where a tenth of
them is wrong, their runs are four pixels long in the mean (Rice's formula)."""


def stated_labels(labels: np.ndarray, camera: Camera, scene: Scene) -> np.ndarray | None:
    """Label ids of a view as the capture states them, [H, W] uint8, 0 for none; ``None`` if it has none."""
    if scene.labels.omit:
        return None
    if scene.labels.one and camera.train:
        return np.where(labels > 0, np.uint8(Label.SKIN), labels)
    if scene.labels.hair_is_skin and camera.train:
        labels = np.where(labels == Label.SCALP, np.uint8(Label.SKIN), labels)
    fraction = scene.labels.boundary_error
    return _mistaken(labels, fraction, generator("labels", scene, camera)) if fraction and camera.train else labels


def _mistaken(labels: np.ndarray, fraction: float, rng: np.random.Generator) -> np.ndarray:
    """``labels`` with the nearest whole number to ``fraction`` of their boundary pixels mistaken."""
    other = _other_side(labels)
    boundary = np.flatnonzero(other)
    # Every side of a boundary has noise of its own, so that a run moves the boundary to one side.
    score = np.zeros(labels.shape)
    for label in np.unique(labels.flat[boundary]):
        noise = gaussian_filter(rng.standard_normal(labels.shape), _RUN_PIXELS)
        score = np.where(labels == label, noise, score)
    worst = boundary[np.argsort(-score.flat[boundary], kind="stable")][: round(fraction * len(boundary))]
    mistaken = labels.copy()
    mistaken.flat[worst] = other.flat[worst]
    return mistaken


def _other_side(labels: np.ndarray) -> np.ndarray:
    """The label across the boundary: the most frequent other one of the four neighbours, the
    smaller id in a tie; 0 where there is none."""
    rows, columns = labels.shape
    padded = np.pad(labels, 1)
    steps = ((0, 1), (1, 0), (1, 2), (2, 1))
    around = np.stack([padded[y : y + rows, x : x + columns] for y, x in steps])
    crosses = (around > 0) & (around != labels) & (labels > 0)
    around = np.sort(np.where(crosses, around, 0), axis=0)
    votes = (around[:, None] == around[None]).sum(0) * (around > 0)
    best = np.argmax(votes, axis=0)
    return np.take_along_axis(around, best[None], 0)[0]

"""Colours of the views at the texels of the chart."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.ndimage import distance_transform_edt

from unshade import Capture

from ..errors import SolveError
from ..face.texels import Texels, rasterise
from ..vectors import unit

_REACH = 0.003
"""Metres that a texel may lie behind what the pixels around its place show: more is hidden."""

_OFF = 0.1
"""Pixels that a picture may differ from a pinhole's."""

_STEEPEST = 0.1
"""Least cosine at which a view counts: beyond it a pixel spans many texels."""


@dataclass(frozen=True)
class TexelSamples:
    """M texels of an N x N chart, row 0 at v = 1, in V views."""

    texels: Texels
    points: np.ndarray
    """(M, 3) metres, world space."""
    normals: np.ndarray
    """(M, 3) unit normals of the mesh, world space."""
    to_eye: np.ndarray
    """(V, M, 3) unit vectors to the cameras."""
    weights: np.ndarray
    """(V, M) cosine between normal and view; 0 where a view does not see the texel."""
    pixels: np.ndarray
    """(V, M, 2) column and row in the picture, pixel centres at whole numbers."""

    def colours(self, pictures: list[np.ndarray]) -> np.ndarray:
        """(V, M, C) of pictures (H, W, C), bilinear; 0 where a view does not see the texel."""
        return np.stack(
            [np.where(w[:, None] > 0, _bilinear(p, at), 0) for p, at, w in zip(pictures, self.pixels, self.weights)]
        )

    def mean(self, colours: np.ndarray, weights: np.ndarray | None = None) -> np.ndarray:
        """(M, C) of (V, M, C), weighted by the cosine unless by ``weights`` (V, M); 0 where no view has any."""
        weights = self.weights if weights is None else weights
        return (colours * weights[..., None]).sum(0) / np.maximum(weights.sum(0), 1e-12)[:, None]

    @property
    def seen(self) -> np.ndarray:
        """(M,) whether any view sees the texel."""
        return self.weights.max(0) > 0

    def filled(self, values: np.ndarray) -> np.ndarray:
        """(N, N, C) float32 of (M, C): unseen texels and those beside the chart take the nearest seen one's."""
        known = self.texels.image(self.seen)
        rows, columns = distance_transform_edt(~known, return_distances=False, return_indices=True)
        return self.texels.image(np.ascontiguousarray(values, np.float32))[rows, columns]

    def normals_filled(self, normals: np.ndarray | None = None) -> np.ndarray:
        """(N, N, 3) float32, unit: ``normals`` (M, 3) where a view sees the texel, elsewhere the mesh's, which is known
        all over the chart; texels beside it take the nearest one's."""
        known = self.normals if normals is None else np.where(self.seen[:, None], normals, self.normals)
        rows, columns = self.texels.nearest_inside()
        return self.texels.image(unit(known).astype(np.float32))[rows, columns]

    def of_picture(self, picture: np.ndarray) -> np.ndarray:
        """(M, C) of a picture of the chart (n, n, C) of any size, bilinear; row 0 at v = 1."""
        size, n = len(self.texels.inside), len(picture)
        row, column = np.nonzero(self.texels.inside)
        return _bilinear(picture, (np.stack([column, row], 1) + 0.5) * n / size - 0.5)

    @property
    def coverage(self) -> np.ndarray:
        """(N, N) bool."""
        return self.texels.image(self.seen)


def sample_texels(capture: Capture, size: int, views: list[str] | None = None) -> TexelSamples:
    """The texels of a chart of ``size`` texels a side in ``views`` (the training views); pinholes alone."""
    mesh = capture.mesh
    texels = rasterise(mesh["uvs"].astype(float), mesh["triangles"].astype(np.int64), size)
    points = texels.sample(mesh["vertices"]).astype(float)
    normals = unit(texels.sample(mesh["normals"]).astype(float))
    found = [_seen_by(capture, name, points, normals) for name in (views or capture.train)]
    to_eye, weights, pixels = (np.stack(parts) for parts in zip(*found))
    return TexelSamples(texels, points, normals, to_eye, weights, pixels)


def _seen_by(capture: Capture, name: str, points: np.ndarray, normals: np.ndarray) -> tuple[np.ndarray, ...]:
    camera = capture.camera(name)
    eye = camera["camera_to_world"][:3, 3].astype(float)
    away = eye - points
    distance = np.linalg.norm(away, axis=1)
    to_eye = away / distance[:, None]
    at = _project(camera, points)
    cosine = (to_eye * normals).sum(1)
    place = np.floor(at).astype(int)
    size = np.array([camera["width"], camera["height"]])
    seen = (cosine > _STEEPEST) & (place >= 0).all(1) & (place + 1 < size).all(1)
    positions = capture.gbuffer(name)["positions"].astype(float)
    inside = np.isfinite(positions).all(-1)
    _require_pinhole(capture, name, np.argwhere(inside)[:, ::-1], _project(camera, positions[inside]))
    if name in capture.train:
        inside &= capture.mask(name) > 127
    shown = np.where(inside, np.linalg.norm(positions - eye, axis=-1), -np.inf)
    column, row = place[seen].T
    nearest = np.min([shown[row + down, column + right] for down in (0, 1) for right in (0, 1)], 0)
    seen[seen] = nearest > distance[seen] - _REACH
    return to_eye, np.where(seen, cosine, 0), at


def _project(camera: Mapping[str, Any], points: np.ndarray) -> np.ndarray:
    """Column and row (M, 2) of world points (M, 3) in a pinhole's picture."""
    matrix = camera["camera_to_world"].astype(float)
    local = (points - matrix[:3, 3]) @ matrix[:3, :3]
    depth = np.maximum(-local[:, 2:], 1e-9)
    return local[:, :2] * [1, -1] / depth * camera["focal"] + camera["centre"] - 0.5


def _require_pinhole(capture: Capture, name: str, pixels: np.ndarray, projected: np.ndarray) -> None:
    """Raises `SolveError` where a lens sends what ``pixels`` (M, 2) show elsewhere than a pinhole does."""
    if len(pixels) and np.abs(projected - pixels).max() > _OFF:
        raise SolveError(f"{capture.path}: view {name} has a lens that distorts; undistort its picture for this method")


def _bilinear(picture: np.ndarray, at: np.ndarray) -> np.ndarray:
    height, width = picture.shape[:2]
    place = np.clip(np.floor(at).astype(int), 0, [width - 2, height - 2])
    across, down = np.clip(at - place, 0, 1).T[..., None]
    column, row = place.T
    top = picture[row, column] * (1 - across) + picture[row, column + 1] * across
    bottom = picture[row + 1, column] * (1 - across) + picture[row + 1, column + 1] * across
    return top * (1 - down) + bottom * down

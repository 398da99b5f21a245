"""A mesh where there is none: the visual hull of the masks (Laurentini 1994).

The hull is the largest shape whose silhouettes lie within all masks. Its field is the least, over the views, of a
point's signed distance to the mask's outline, in the unit of the source, so that marching cubes meets the outline
between grid points. Concavities (eye sockets, the side of the nose) are filled: no silhouette shows them.
"""

from __future__ import annotations

import cv2
import igl
import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.ndimage import binary_fill_holes

from ..errors import CaptureError
from ..vectors import unit
from .chart_mesh import ChartMesh, smooth_normals
from .detective import Evidence

Points = NDArray[np.float64]

_COARSE, _FINE = 48, 128
"""Cells along the longest side of the grid that finds the hull's bounds, and of the one that is cut."""
_TRIANGLES = 12_000
"""Largest number of triangles of the finished mesh."""
_ROUNDS, _SHRINK, _GROW = 10, 0.5, -0.53
"""Smoothing that keeps the volume (Taubin 1995): rounds, and the factors of the two steps of each."""
_LEAST_VIEWS = 3


def carve(evidence: list[Evidence]) -> ChartMesh:
    """Returns the visual hull of views with masks, with normals and without texture coordinates, in the source's unit.

    Raises `CaptureError` if there are fewer than three informative masks, or nothing lies within all of them.
    """
    views = [_View(e.straight()) for e in evidence if e.is_telling]
    if len(views) < _LEAST_VIEWS:
        raise CaptureError(
            f"mesh hull: {len(views)} of {len(evidence)} views have a mask with an outline, but a hull needs at least "
            f"{_LEAST_VIEWS}; add masks (--masks), or name a mesh"
        )
    centre = _nearest_to_rays(views)
    radius = max(view.radius_about(centre) for view in views)
    ball = centre, radius
    points, inside, step = _sampled(views, ball, centre - radius, centre + radius, _COARSE)
    if not (inside > 0).any():
        raise CaptureError(
            "mesh hull: no point lies within the masks of all views; fix cameras or masks, or leave out the views "
            "that do not fit (--leave-out)"
        )
    solid = points[inside > 0]
    points, inside, _ = _sampled(views, ball, solid.min(0) - 2 * step, solid.max(0) + 2 * step, _FINE)
    vertices, triangles = _surface(points, inside)
    vertices = _smoothed(vertices, triangles)
    if len(triangles) > _TRIANGLES:
        vertices, triangles, *_ = igl.qslim(vertices, triangles, _TRIANGLES)
    normals, none = unit(smooth_normals(vertices, triangles)), np.zeros((len(vertices), 2))
    part_of = np.zeros(len(triangles), np.int64)
    return ChartMesh(vertices, triangles.astype(np.int64), none, normals, None, ("hull",), part_of, has_own_uv=False)


class _View:
    """A camera and the signed distance of its pixels to the mask's outline, in pixels, positive inside."""

    def __init__(self, evidence: Evidence) -> None:
        self.camera = evidence.camera
        # Eyes that a mask leaves out would be tunnels.
        mask = np.pad(binary_fill_holes(evidence.mask).astype(np.uint8), 1, mode="edge")
        # Half a pixel from the last centre inside lies the outline.
        inside = cv2.distanceTransform(mask, cv2.DIST_L2, cv2.DIST_MASK_PRECISE) - 0.5
        outside = cv2.distanceTransform(1 - mask, cv2.DIST_L2, cv2.DIST_MASK_PRECISE) - 0.5
        self.distance = np.where(mask > 0, inside, -outside)[1:-1, 1:-1].astype(np.float32)
        row, column = (float(x.mean()) for x in np.nonzero(evidence.mask))
        self.middle = np.array([column + 0.5, row + 0.5])
        self.eye = self.camera.camera_to_world[:3, 3]

    def ray(self) -> Points:
        """The unit direction (3,) from the camera through the mask's middle."""
        camera = self.camera
        x, y = (self.middle - camera.centre) / camera.focal
        return unit((camera.camera_to_world[:3, :3] @ [x, -y, -1.0])[None])[0]

    def projected(self, points: Points) -> tuple[Points, Points]:
        """Pixel coordinates (N, 2) and depths (N,) of points (N, 3)."""
        camera = self.camera
        local = (points - self.eye) @ camera.camera_to_world[:3, :3]
        depth = -local[:, 2]
        with np.errstate(divide="ignore", invalid="ignore"):
            ahead = local[:, :2] * [1, -1] / depth[:, None]
        return ahead * camera.focal + camera.centre, depth

    def radius_about(self, centre: Points) -> float:
        """The distance from a point at which the mask's farthest pixel lies."""
        (pixel,), (depth,) = self.projected(centre[None])
        rows, columns = np.nonzero(self.distance > 0)
        reach = np.hypot(columns + 0.5 - pixel[0], rows + 0.5 - pixel[1]).max()
        return float(reach * depth / min(self.camera.focal)) if depth > 0 else 0.0

    def distances(self, points: Points) -> tuple[Points, Points]:
        """Distances (N,) of points from the outlines of the mask and of the frame, positive inside; beyond the frame
        the mask says nothing (infinite)."""
        pixels, depth = self.projected(points)
        height, width = self.distance.shape
        size = np.maximum(depth, 0) / min(self.camera.focal)
        frame = np.where(depth > 0, np.minimum(pixels, [width, height] - pixels).min(1), -np.inf)
        at = np.where(frame[:, None] > 0, pixels - 0.5, 0).astype(np.float32)
        found = cv2.remap(
            self.distance, at[:, None, 0], at[:, None, 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
        )
        mask = np.where(frame > 0, found[:, 0] * size, np.inf)
        return mask, np.where(depth > 0, frame * size, -np.inf)


def _nearest_to_rays(views: list[_View]) -> Points:
    """The point (3,) with the least sum of squared distances to the rays through the masks' middles."""
    across = [np.eye(3) - np.outer(ray, ray) for ray in (view.ray() for view in views)]
    moments = sum((a @ view.eye for a, view in zip(across, views)), np.zeros(3))
    return np.linalg.lstsq(sum(across, np.zeros((3, 3))), moments, rcond=None)[0]


def _sampled(views: list[_View], ball: tuple[Points, float], low: Points, high: Points, cells: int):
    """Grid points [z, y, x, 3] between two corners, the hull's field there, and the grid's step."""
    step = float((high - low).max()) / cells
    axes = [np.arange(a, b + step, step) for a, b in zip(low, high)]
    grid = np.stack(np.meshgrid(*reversed(axes), indexing="ij")[::-1], -1)
    field = np.empty(grid.shape[:-1])
    for layer, points in enumerate(grid):
        field[layer] = _field(views, ball, points.reshape(-1, 3)).reshape(points.shape[:-1])
    return grid, field, step


def _field(views: list[_View], ball: tuple[Points, float], points: Points) -> Points:
    centre, radius = ball
    masks, frames = (np.array(distances) for distances in zip(*(view.distances(points) for view in views)))
    # Half of the views have the point in their frame.
    seen = np.sort(frames, axis=0)[len(views) // 2]
    return np.minimum(np.minimum(masks.min(0), seen), radius - np.linalg.norm(points - centre, axis=1))


def _surface(grid: NDArray[np.float64], field: NDArray[np.float64]) -> tuple[Points, NDArray[np.int64]]:
    """The largest piece of the surface at which the field is 0, closed at the grid's faces."""
    field = np.pad(field[1:-1, 1:-1, 1:-1], 1, constant_values=-1e3 * float(np.ptp(grid)))
    depth, height, width = field.shape
    vertices, triangles, _ = igl.marching_cubes(field.ravel(), grid.reshape(-1, 3), width, height, depth, 0.0)
    pieces = igl.facet_components(triangles)
    pieces = np.asarray(pieces[1] if isinstance(pieces, tuple) else pieces)
    triangles = triangles[pieces == np.bincount(pieces).argmax()]
    used, triangles = np.unique(triangles, return_inverse=True)
    vertices, triangles = vertices[used], triangles.reshape(-1, 3)
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    outwards = np.einsum("ij,ij->", a, np.cross(b, c)) > 0
    return vertices, triangles if outwards else triangles[:, ::-1].copy()


def _smoothed(vertices: Points, triangles: NDArray[np.int64]) -> Points:
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    edges = np.concatenate([edges, edges[:, ::-1]])
    count = len(vertices)
    near = sp.csr_matrix((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(count, count))
    near.data[:] = 1.0
    mean = sp.diags(1 / np.asarray(near.sum(1)).ravel()) @ near
    for factor in (_SHRINK, _GROW) * _ROUNDS:
        vertices = vertices + factor * (mean @ vertices - vertices)
    return vertices

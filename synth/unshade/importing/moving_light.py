"""Whether the light stood still with respect to the head, as a solve assumes, or differs from view to view.

Under a light that stands still, a place of a matte surface has one radiance from everywhere, whatever the light and
its shadows; exposure scales whole views. On a turntable, or with a flash on the camera, each view has its own light.
Both are fitted to what several views see of places of the mesh:

    log radiance = place + view                         one light
    log radiance = place + view + normal . direction    a light of each view's own, to first order

Highlights, noise and meshes that are a little off leave residuals that the second model explains no better.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from ..vectors import twice_areas, unit
from .chart_mesh import ChartMesh, smooth_normals
from .photographs import ImportedView
from .pictures import Floats
from .pinhole import Pinhole

_PLACES = 2000
"""Places of the mesh that are looked at, spread by area."""

_VIEWS, _SEEN = 3, 200
"""Views of a place, and places of a view, that are needed."""

_SIDE = 160
"""Longest side (pixels) to which pictures are shrunk: cameras that are a little off matter less."""

_STEEPNESS = 0.35
"""Cosine between normal and view from which a place is seen well."""

_DEPTH = 0.01
"""Share of its depth by which a place may lie behind what is seen there."""

_DARK = 0.05
"""Share of the median radiance that is added before the logarithm: shadows hold noise."""

_ROUNDS, _HUBER = 5, 1.5
"""Rounds of reweighting, and the number of standard deviations above which residuals count less."""

_EXPLAINED, _AMOUNT = 0.5, 0.1
"""Share of the variance between views, and its root mean square, that lights of the views' own must explain. Renders
of faces in still lights (lamp, flash, sun, softboxes of two colours) have 0.14 and 0.02, with cameras off by a pixel
of 72 up to 0.43 and 0.10; the same lights turned with the cameras have 0.67 and 0.12 or more."""

_DISAGREES = 0.25
"""Difference between views, with lights of their own, from which photographs do not agree. Renders of still and moving
lights, with cameras off by a pixel of 72, stay below 0.23; turned, mirrored or exchanged photographs come to 0.3 to 0.8
in lamps, and to 0.2 in even light."""


@dataclass(frozen=True)
class LitView:
    """A view's camera without its lens, its radiance [H, W, 3], and where the face is [H, W]; None if unknown."""

    camera: Pinhole
    radiance: Floats
    mask: NDArray[np.bool_] | None

    @classmethod
    def of(cls, taken: ImportedView) -> LitView:
        """A small copy of a view."""
        small = taken.undistorted().smaller(-(-max(taken.radiance.shape[:2]) // _SIDE))
        return cls(small.camera, small.radiance, None if small.mask is None else small.mask > 0)


@dataclass(frozen=True)
class LightMotion:
    """Differences between views of one place of the surface (root mean square of the logarithm) after one light is
    fitted to all ``views``, and after one of its own to each."""

    views: int
    one_light: float
    own_lights: float

    @property
    def moves(self) -> bool:
        """Whether the light moved with respect to the head."""
        explained = self.one_light**2 - self.own_lights**2
        return not self.disagrees and explained > _AMOUNT**2 and explained > _EXPLAINED * self.one_light**2

    @property
    def disagrees(self) -> bool:
        """Whether views differ more than by their light: photographs are not where their cameras and the mesh are."""
        return self.own_lights > _DISAGREES

    def warning(self, light_frame: str, *, fits: bool = False) -> str | None:
        """The fault in a sentence; None without one. ``light_frame`` is what the light is said to stand still with,
        ``fits`` whether silhouettes overlap the masks well."""
        if self.disagrees and fits:
            return (
                f"one place of the mesh differs by {self.own_lights:.0%} between views whatever their light, although "
                "silhouettes fit the masks: the surface is glossier than skin (metal, varnish, water), the mesh lacks "
                "detail, or photographs of alike outlines are exchanged"
            )
        if self.disagrees:
            return (
                f"one place of the mesh differs by {self.own_lights:.0%} between views whatever their light, so "
                "photographs do not belong to their cameras or to the mesh, or the surface is glossier than skin; look at "
                "the order of files, at photographs that are turned or mirrored, and at the mesh over the photographs"
            )
        spread = (
            f"one place differs by {self.one_light:.0%} between views, and by {self.own_lights:.0%} if each has a light "
            "of its own"
        )
        if self.moves and light_frame == "head":
            return (
                f"the light moves with respect to the head, as on a turntable or with a flash on the camera: {spread}; "
                "if lamps and camera stood still while the head turned, or the lamp is on the camera, import with "
                "light_frame camera (--light-frame camera); else move the camera and leave head and lights where they "
                "are (or look at photographs that lie another way than their cameras)"
            )
        if light_frame == "camera" and not self.moves:
            return (
                f"light_frame is camera, but the light seems to stand still with respect to the head: {spread}; import "
                "without it if head and lights stood still while the camera moved"
            )
        return None

    def record(self) -> dict[str, float | bool]:
        """The numbers, for ``import.json``."""
        spread = {"one_light": round(self.one_light, 4), "own_lights": round(self.own_lights, 4)}
        return {"views": self.views, **spread, "moves": self.moves}


def light_motion(mesh: ChartMesh, views: list[LitView]) -> LightMotion | None:
    """Fits both models; None where too few places are seen by several views."""
    places, normals = _places(mesh)
    looks = [_look(mesh, view, places, normals) for view in views]
    looks = [(values, seen) for values, seen in looks if seen.sum() >= _SEEN]
    if len(looks) < _VIEWS:
        return None
    values, seen = (np.array(rows) for rows in zip(*looks))
    often = seen.sum(0) >= _VIEWS
    if often.sum() < _SEEN:
        return None
    values, seen, normals = values[:, often].clip(0), seen[:, often], normals[often]
    values = _evenly_exposed(values, seen)
    dark = _DARK * np.median(values[seen], axis=0)
    if not (dark > 0).all():
        return None
    logarithm = np.log(values + dark)
    one, own = np.ones((len(normals), 1)), np.c_[np.ones(len(normals)), normals]
    weights = seen.astype(float)
    for _ in range(_ROUNDS):
        residual = _residual(logarithm, weights, own)
        limit = _HUBER * 1.4826 * float(np.median(residual[seen])) + 1e-9
        weights = np.where(seen, np.minimum(1, limit / residual.clip(1e-12)), 0)
    spread = [np.sqrt(np.average(_residual(logarithm, weights, basis) ** 2, weights=weights)) for basis in (one, own)]
    return LightMotion(len(looks), float(spread[0]), float(spread[1]))


def _evenly_exposed(values: NDArray[np.float64], seen: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Radiance (V, N, 3) over each view's exposure, which bright places estimate."""
    total = values.sum(2)
    exposure = np.ones(len(values))
    for _ in range(_ROUNDS):
        places = (total / exposure[:, None] * seen).sum(0) / seen.sum(0)
        bright = places >= np.median(places)
        ratios = [np.median((total[view] / places.clip(1e-30))[seen[view] & bright]) for view in range(len(values))]
        exposure = np.nan_to_num(ratios, nan=1.0).clip(1e-9)
        exposure /= np.exp(np.log(exposure).mean())
    return values / exposure[:, None, None]


def _places(mesh: ChartMesh) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Centroids (N, 3) of triangles, spread by area, and their unit normals (N, 3)."""
    corners = mesh.vertices[mesh.triangles]
    area = twice_areas(mesh.vertices, mesh.triangles)
    steps = (np.arange(_PLACES) + 0.5) / _PLACES * area.sum()
    chosen = np.unique(np.searchsorted(np.cumsum(area), steps).clip(0, len(area) - 1))
    normals = smooth_normals(mesh.vertices, mesh.triangles) if mesh.normals is None else mesh.normals
    return corners[chosen].mean(1), unit(unit(normals)[mesh.triangles[chosen]].mean(1))


def _look(
    mesh: ChartMesh, view: LitView, places: NDArray[np.float64], normals: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """The radiance of each place in a view (N, 3), and which of them it sees well, away from outlines (N,)."""
    camera = view.camera
    pose = camera.camera_to_world
    local = (places - pose[:3, 3]) @ pose[:3, :3]
    depth = -local[:, 2]
    with np.errstate(divide="ignore", invalid="ignore"):
        columns = np.floor(camera.centre[0] + camera.focal[0] * local[:, 0] / depth)
        rows = np.floor(camera.centre[1] - camera.focal[1] * local[:, 1] / depth)
    seen = (depth > 0) & (columns >= 0) & (columns < camera.width) & (rows >= 0) & (rows < camera.height)
    rows, columns = (np.where(seen, index, 0).astype(int) for index in (rows, columns))
    hit = camera.depth(mesh.vertices, mesh.triangles)
    inside = np.isfinite(hit) if view.mask is None else np.isfinite(hit) & view.mask
    inside = cv2.erode(inside.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
    seen &= inside[rows, columns] & (np.abs(hit[rows, columns] - depth) <= _DEPTH * np.abs(depth))
    towards = pose[:3, 3] - places
    seen &= np.einsum("ij,ij->i", towards, normals) > _STEEPNESS * np.linalg.norm(towards, axis=1)
    return cv2.blur(view.radiance, (3, 3))[rows, columns].astype(float), seen


def _residual(
    values: NDArray[np.float64], weights: NDArray[np.float64], basis: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The root mean square over channels (V, N) of what is left of ``values`` (V, N, 3) after a constant for each
    place and, for each view, the functions of places in ``basis`` (N, K) are fitted with ``weights`` (V, N)."""
    views, size = len(values), basis.shape[1]
    # The constants of places are eliminated from the normal equations; what is left is small.
    weighted = weights[:, :, None] * basis
    rows = weighted.transpose(1, 0, 2).reshape(len(basis), views * size)
    total = weights.sum(0).clip(1e-12)
    mean = np.einsum("vn,vnc->nc", weights, values) / total[:, None]
    matrix = -(rows / total[:, None]).T @ rows
    for view in range(views):
        block = slice(view * size, (view + 1) * size)
        matrix[block, block] += weighted[view].T @ basis
    side = np.einsum("vnk,vnc->vkc", weighted, values - mean).reshape(views * size, -1)
    # Lights that all views share are constants of the places: the matrix has no full rank.
    found = np.linalg.lstsq(matrix, side, rcond=1e-10)[0].reshape(views, size, -1)
    fitted = np.einsum("nk,vkc->vnc", basis, found)
    left = values - mean - fitted + np.einsum("vn,vnc->nc", weights, fitted) / total[:, None]
    return np.sqrt(np.mean(left**2, axis=2))

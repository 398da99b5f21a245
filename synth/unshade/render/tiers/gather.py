"""Blurs irradiance over the skin with the normalised-diffusion profile.

Every point gathers from all points within reach, weighed by area and profile at their true
distance in space, so that light passes from the back of an ear to its front. The weights
of a point are then scaled to sum to one: under even light a point shows exactly its albedo,
on flat skin (where the sum is one to begin with), at an edge, in a fold, or on a thin ear.
Between two places of a curved surface the exchange is therefore not exactly symmetric, and
the energy of the whole is conserved only as far as the raw sums are alike.
"""

from __future__ import annotations

from dataclasses import dataclass

import drjit as dr
import mitsuba as mi
import numpy as np

from . import profile
from .surface import SkinPoints

_MAX_CELLS = 200
"""Cells along the longest edge."""


@dataclass(frozen=True)
class Blurred:
    """`irradiance` (M, bakes, 3) f32; `raw_sum` (M,3) of the weights before they were scaled."""

    irradiance: np.ndarray
    raw_sum: np.ndarray


def blur(
    irradiance: np.ndarray, points: SkinPoints, albedo: np.ndarray, mean_free_path: np.ndarray, open_: np.ndarray
) -> Blurred:
    """Gathers ``irradiance`` (M, bakes, 3); ``albedo`` (M,3) sets the profile of the receiver.

    ``mean_free_path`` (3,) in metres; ``open_`` (M,) bool: points that light can reach at all.
    """
    radius = profile.scale_radius(np.asarray(mean_free_path), albedo).astype(np.float32)
    reach = profile.REACH * radius.max(1)
    cells = _Cells.of(points.positions, float(reach.max()) / 2)
    order = cells.order
    disc = np.sqrt(points.areas / np.pi).astype(np.float32)
    own = profile.within(disc[:, None], radius).astype(np.float32)
    weight = np.where(open_, points.areas, 0).astype(np.float32)
    own[~open_] = 0
    bakes = irradiance.shape[1]
    sources = _Sources(
        points.positions[order], points.facing[order], weight[order], 2 / 3 * disc[order],
        [irradiance[order, k] for k in range(bakes)],
    )  # fmt: skip
    # Constants of a receiver's profile: 1/(3 d) and 1/(8 pi d).
    steep, high = (mi.Color3f(_columns((a / radius[order]).astype(np.float32))) for a in (1 / 3, 1 / (8 * np.pi)))
    lane = dr.arange(mi.UInt32, len(order))
    sums, total = _gather(
        sources, cells.device(), lane, steep, high, mi.Float((reach**2)[order]), mi.Color3f(_columns(own[order]))
    )
    raw = np.empty((len(order), 3), np.float32)
    result = np.empty_like(irradiance)
    raw[order] = np.array(total).T
    for k in range(bakes):
        result[order, k] = np.array(sums[k]).T
    # A point that nothing reaches keeps its own light.
    lonely = raw <= 0
    scaled = result / np.where(lonely, 1, raw)[:, None]
    return Blurred(np.where(lonely[:, None], irradiance, scaled).astype(np.float32), raw)


@dataclass(frozen=True)
class _Cells:
    """Points sorted into cubes at least half as wide as the reach, x fastest."""

    order: np.ndarray
    start: np.ndarray
    shape: np.ndarray
    place: np.ndarray

    @classmethod
    def of(cls, positions: np.ndarray, width: float) -> _Cells:
        # Few enough cells for memory, however short the reach.
        width = max(width, float(np.ptp(positions, axis=0).max()) / _MAX_CELLS)
        # Two empty layers around, so that no neighbour needs a test.
        place = ((positions - positions.min(0)) / width).astype(np.int64) + 2
        shape = place.max(0) + 3
        number = (place[:, 2] * shape[1] + place[:, 1]) * shape[0] + place[:, 0]
        order = np.argsort(number, kind="stable")
        start = np.searchsorted(number[order], np.arange(shape.prod() + 1))
        return cls(order, start, shape, number[order])

    def device(self):
        """Where each cell starts, each point's cell, and the cells along x and in a layer of z."""
        wide, layer = int(self.shape[0]), int(self.shape[0] * self.shape[1])
        start, place = (mi.UInt32(table.astype(np.uint32)) for table in (self.start, self.place))
        return start, place, dr.opaque(mi.UInt32, wide), dr.opaque(mi.UInt32, layer)


class _Sources:
    """Points whose light is gathered, in the order of the cells.

    No dataclass: Dr.Jit would carry the fields of one through its loops as variables.
    """

    def __init__(self, position, normal, area, nearest, values) -> None:
        self.position = mi.Point3f(_columns(position))
        self.normal = mi.Normal3f(_columns(normal))
        self.area = mi.Float(area)
        self.nearest = mi.Float(nearest)
        self.values = [mi.Color3f(_columns(value)) for value in values]


@dr.syntax
def _gather(sources, cells, lane, steep, high, reach2, own):
    """Weighted sums of the values, and the sums of the weights, at every point."""
    start, place, wide, layer = cells
    here, facing = sources.position, sources.normal
    sums = [own * value for value in sources.values]
    total = mi.Color3f(own)
    run = mi.UInt32(0)
    while run < 25:
        # The points of five cells in a row of x are neighbours in the arrays.
        first = place + (run // 5) * layer + (run % 5) * wide
        first -= 2 * (layer + wide + 1)
        j = dr.gather(mi.UInt32, start, first)
        end = dr.gather(mi.UInt32, start, first + 5)
        while j < end:
            offset = dr.gather(mi.Point3f, sources.position, j) - here
            normal = dr.gather(mi.Normal3f, sources.normal, j)
            r2 = dr.squared_norm(offset)
            # Two surfaces that face each other across air (the lips, a nostril) exchange
            # light through the bake, not through tissue.
            air = (dr.dot(normal, facing) < 0) & (dr.dot(offset, facing) > 0) & (dr.dot(offset, normal) < 0)
            near = (r2 < reach2) & (j != lane) & ~air
            r = dr.fmax(dr.sqrt(r2), dr.gather(mi.Float, sources.nearest, j))
            far = dr.exp(-r * steep)
            weight = (far * far * far + far) * high * (dr.gather(mi.Float, sources.area, j) / r)
            weight = dr.select(near, weight, 0)
            total += weight
            for k in range(len(sums)):
                sums[k] += weight * dr.gather(mi.Color3f, sources.values[k], j)
            j += 1
        run += 1
    return sums, total


def _columns(rows: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(rows.T, dtype=np.float32)

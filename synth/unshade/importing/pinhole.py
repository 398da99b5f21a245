"""A pinhole and what it sees of a mesh."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .. import _native
from .source import Matrix


@dataclass(frozen=True)
class Pinhole:
    """A camera without a lens; pixels count from the top left corner, centres at +.5."""

    width: int
    height: int
    focal: tuple[float, float]
    centre: tuple[float, float]
    camera_to_world: Matrix

    def smaller(self, every: int) -> Pinhole:
        """The camera of a picture whose pixels are ``every`` x ``every`` of this one's."""
        return replace(
            self,
            width=max(self.width // every, 1),
            height=max(self.height // every, 1),
            focal=(self.focal[0] / every, self.focal[1] / every),
            centre=(self.centre[0] / every, self.centre[1] / every),
        )

    def silhouette(self, vertices: NDArray[np.float64], triangles: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Which pixels' centres show the mesh (height, width)."""
        return np.isfinite(self.depth(vertices, triangles))

    def depth(self, vertices: NDArray[np.float64], triangles: NDArray[np.int64]) -> NDArray[np.float32]:
        """Depth of the mesh along the camera's axis at pixels' centres (height, width), infinite beside it."""
        matrix = self.camera_to_world.tolist()
        return _native.depth_of(
            vertices, triangles, (self.width, self.height), list(self.focal), list(self.centre), matrix
        )

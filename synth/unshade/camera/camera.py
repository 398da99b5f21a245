"""One camera: a pinhole with square pixels, or one with a lens that distorts.

Its matrix maps camera to world with OpenGL axes (x right, y up, looking down -z); pixel
(i, j) has its centre at (i + .5, j + .5), row 0 at the top.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass

import mitsuba as mi
import numpy as np

from ..errors import SceneError
from ..scene_file import passes_for
from ..vectors import unit
from .distortion import Distortion

_UP = np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True)
class Camera:
    """One camera: name of its frame, pixels, focal length in pixels, 4x4 camera to world."""

    name: str
    width: int
    height: int
    focal: float
    matrix: np.ndarray
    train: bool
    distortion: Distortion | None = None
    place: int = 0
    """Its number among the training views, or among the withheld ones."""

    def __post_init__(self) -> None:
        if self.distortion is not None and self._reach() is None:
            terms = ", ".join(f"{key} {value:g}" for key, value in asdict(self.distortion).items())
            raise SceneError(
                f"lens_distortion ({terms}) folds the picture of camera {self.name} over: "
                "one pixel would show two directions; use smaller terms or a longer focal length"
            )

    @property
    def position(self) -> np.ndarray:
        return self.matrix[:3, 3]

    def pixel_directions(self) -> np.ndarray:
        """Unit directions [height * width, 3] through the pixel centres, row by row."""
        x = (np.arange(self.width) + 0.5 - self.width / 2) / self.focal
        y = (self.height / 2 - np.arange(self.height) - 0.5) / self.focal
        x, y = np.meshgrid(x, y)
        if self.distortion is not None:
            x, y = self.distortion.undistort(x, -y)
            y = -y
        local = np.stack([x, y, np.full_like(x, -1.0)], -1).reshape(-1, 3)
        return unit(local) @ self.matrix[:3, :3].T

    def project(self, points: np.ndarray) -> np.ndarray:
        """Pixel coordinates [N, 2] (x right, y down) of world points [N, 3] in front."""
        local = (points - self.position) @ self.matrix[:3, :3]
        if self.distortion is not None:
            local = self._distorted(local)
        plane = self.focal * local[:, :2] / -local[:, 2:]
        return np.stack([plane[:, 0] + self.width / 2, self.height / 2 - plane[:, 1]], 1)

    def _distorted(self, local: np.ndarray) -> np.ndarray:
        """Camera coordinates [N, 3] that the pinhole sends where the lens sends ``local``."""
        x, y = local[:, 0] / -local[:, 2], local[:, 1] / local[:, 2]
        # Beyond the picture the polynomial may fold back into it; a straight line does not.
        beyond = np.maximum(np.hypot(x, y) / self._reach(), 1)
        x, y = self.distortion.distort(x / beyond, y / beyond)
        return np.stack([x * beyond, -y * beyond, np.full_like(x, -1.0)], 1)

    def _reach(self) -> float | None:
        return self.distortion.reach(self.width / 2 / self.focal, self.height / 2 / self.focal)

    def frame(self) -> dict:
        """The camera's entry in ``transforms.json``."""
        lens = {} if self.distortion is None else asdict(self.distortion)
        return {
            "name": self.name,
            "file_path": f"images/{self.name}.exr",
            "mask_path": f"masks/{self.name}.png",
            "label_path": f"labels/{self.name}.png",
            "w": self.width,
            "h": self.height,
            "fl_x": self.focal,
            "fl_y": self.focal,
            "cx": self.width / 2,
            "cy": self.height / 2,
            **lens,
            "transform_matrix": self.matrix.tolist(),
        }

    def sensor(self, samples: int):
        """The camera in Mitsuba, whose own axes are x left, y up, z forward.

        Always a pinhole: what a lens does to its rays, `passes.render_layers` adds.
        """
        to_world = self.matrix @ np.diag([-1.0, 1.0, -1.0, 1.0])
        return mi.load_dict(
            {
                "type": "perspective",
                "fov": math.degrees(2 * math.atan(self.width / 2 / self.focal)),
                "fov_axis": "x",
                "to_world": mi.ScalarTransform4f(to_world),
                "near_clip": 0.01,
                "far_clip": 100.0,
                "film": {
                    "type": "hdrfilm",
                    "width": self.width,
                    "height": self.height,
                    "rfilter": {"type": "box"},
                },
                "sampler": {"type": "multijitter", "sample_count": samples // passes_for(samples)},
            }
        )


def look_at(position: np.ndarray, target: np.ndarray) -> np.ndarray:
    """Camera-to-world matrix (OpenGL axes) of an upright camera."""
    back = position - target
    back = back / np.linalg.norm(back)
    right = np.cross(_UP, back)
    right /= np.linalg.norm(right)
    matrix = np.eye(4)
    matrix[:3] = np.stack([right, np.cross(back, right), back, position], 1)
    return matrix

"""Lens distortion after Brown (1966), in OpenCV's convention and with its names.

Coordinates are those of the film divided by the focal length, **x right and y down**, as
OpenCV counts them: a pinhole sends a point (X, Y, Z) in front of the camera to (X / Z, Y / Z);
the lens sends it to ``distort`` of that. nerfstudio reads the same numbers from
``transforms.json`` where ``camera_model`` is ``OPENCV``.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass

import numpy as np

NEWTON_STEPS = 10
"""Newton's method doubles its digits each step; ordinary lenses are done after four."""

_TOLERANCE = 1e-10
"""Largest residual of an inverse: a millionth of a pixel at any focal length we meet."""


@dataclass(frozen=True)
class Distortion:
    """Radial terms ``k1`` (r^2) and ``k2`` (r^4), tangential terms ``p1`` and ``p2``."""

    k1: float
    k2: float
    p1: float
    p2: float

    def distort(self, x, y):
        """Where the lens sends the pinhole's (x, y). Numbers, arrays, or Dr.Jit's numbers."""
        k1, k2, p1, p2 = astuple(self)
        r2 = x * x + y * y
        radial = 1 + r2 * (k1 + r2 * k2)
        return (
            x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
            y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y,
        )

    def jacobian(self, x, y):
        """Derivatives of `distort`: dx/dx, dx/dy (equal to dy/dx), dy/dy."""
        k1, k2, p1, p2 = astuple(self)
        r2 = x * x + y * y
        radial, slope = 1 + r2 * (k1 + r2 * k2), 2 * (k1 + 2 * k2 * r2)
        return (
            radial + slope * x * x + 2 * p1 * y + 6 * p2 * x,
            slope * x * y + 2 * p1 * x + 2 * p2 * y,
            radial + slope * y * y + 6 * p1 * y + 2 * p2 * x,
        )

    def undistort(self, x, y):
        """The inverse of `distort` by Newton's method, in the types that it is given."""
        u, v = x, y
        for _ in range(NEWTON_STEPS):
            a, b, d = self.jacobian(u, v)
            found_x, found_y = self.distort(u, v)
            off_x, off_y = x - found_x, y - found_y
            scale = 1 / (a * d - b * b)
            u, v = u + scale * (d * off_x - b * off_y), v + scale * (a * off_y - b * off_x)
        return u, v

    def reach(self, half_width: float, half_height: float) -> float | None:
        """Largest undistorted radius in a picture of this half size (film over focal length).

        ``None`` where the lens has no inverse on the whole disk of that radius: the image
        folds over, and one pixel shows two directions.
        """
        along = np.linspace(-1, 1, 65)
        x = half_width * np.concatenate([along, along, np.full(65, -1.0), np.ones(65)])
        y = half_height * np.concatenate([np.full(65, -1.0), np.ones(65), along, along])
        with np.errstate(all="ignore"):
            u, v = self.undistort(x, y)
            off = np.hypot(*np.subtract(self.distort(u, v), (x, y)))
        if not (off < _TOLERANCE).all():
            return None
        # From the axis outwards, so that the inverse found is the one that the axis lies on.
        reach = float(np.hypot(u, v).max())
        radius, angle = np.meshgrid(np.linspace(0, reach, 129), np.linspace(0, 2 * np.pi, 128, endpoint=False))
        a, b, d = self.jacobian(radius * np.cos(angle), radius * np.sin(angle))
        # Symmetric, so both eigenvalues positive means a one-to-one map of the convex disk.
        return reach if ((a > 0) & (a * d - b * b > 0)).all() else None

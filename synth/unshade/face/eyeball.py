"""The shape of an eyeball: a sphere, the cornea on it, and where it looks."""

from __future__ import annotations

import numpy as np

IRIS = 20.0
"""Half angle (degrees) of the iris seen from the eyeball's centre.

The head data's eyeballs are 31 mm wide behind lids that open 22 mm: an iris of 10.5 mm keeps
the proportion to the lids of a natural one (11.7 mm, 29 mm), not that to the eyeball.
"""

_CORNEA_RADIUS = 7.8 / 5.85
"""Radius of the cornea in radii of the limbus: 7.8 mm over a limbus of 11.7 mm (Gullstrand's eye)."""

_LIMBUS_BLEND = 0.008
"""Cornea and sclera meet in a shallow furrow, not in an edge: reach of the blend, in radii of the eyeball."""


def height(theta: np.ndarray) -> np.ndarray:
    """Distance from the centre, in radii, at angles (radians) from the optical axis."""
    limbus = np.radians(IRIS)
    radius = _CORNEA_RADIUS * np.sin(limbus)
    centre = np.cos(limbus) - np.sqrt(radius**2 - np.sin(limbus) ** 2)
    theta = np.minimum(theta, np.pi / 2)
    inside = np.maximum(radius**2 - (centre * np.sin(theta)) ** 2, 0)
    bulge = centre * np.cos(theta) + np.sqrt(inside) - 1
    # A maximum with 0 that is smooth where the surfaces meet.
    return 1 + 0.5 * (bulge + np.sqrt(bulge**2 + _LIMBUS_BLEND**2))


def clearance(points: np.ndarray, sphere: np.ndarray, gaze: np.ndarray) -> np.ndarray:
    """Distance (N,) in metres of points (N,3) from the eyeball's surface along its radius; negative inside.

    `sphere` (4,) centre and radius in metres, `gaze` (3,3) the eyeball's rotation.
    """
    offset = points - sphere[:3]
    distance = np.linalg.norm(offset, axis=1)
    cosine = offset @ gaze[:, 2] / np.maximum(distance, 1e-12)
    return distance - sphere[3] * height(np.arccos(np.clip(cosine, -1, 1)))


def rotation(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """The rotation (3,3) that takes points (N,3) best to their places after (Kabsch 1976)."""
    u, _, vt = np.linalg.svd((after - after.mean(axis=0)).T @ (before - before.mean(axis=0)))
    flip = np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ vt))])
    return u @ flip @ vt

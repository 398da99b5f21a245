"""Where on the template head the skin changes: smooth fields over template millimetres.

Coordinates: origin midway between the eyes' centres, +Y up, +Z out of the face.
"""

from __future__ import annotations

import dataclasses
import functools

import numpy as np
from scipy.ndimage import gaussian_filter, map_coordinates

from . import base_mesh


def bump(points: np.ndarray, centre: tuple, radii: tuple) -> np.ndarray:
    """Gaussian (M,) f32 with standard deviations `radii` around `centre`."""
    offset = (points - np.float32(centre)) / np.float32(radii)
    return np.exp(-0.5 * np.einsum("ij,ij->i", offset, offset))


def pair(points: np.ndarray, centre: tuple, radii: tuple) -> np.ndarray:
    """A `bump` on each side of the face."""
    mirrored = np.column_stack([np.abs(points[:, 0]), points[:, 1:]])
    return bump(mirrored, centre, radii)


def smoothstep(low: float, high: float, value: np.ndarray) -> np.ndarray:
    """0 below `low`, 1 above `high`, smooth between."""
    t = np.clip((value - low) / (high - low), 0, 1)
    return t * t * (3 - 2 * t)


_LIPS_MEET_Y = -66.6
"""Height (mm) at which upper and lower lip of the template touch."""


@dataclasses.dataclass(frozen=True)
class Regions:
    """Fields (M,) f32 in 0..1 at `points` (M,3). Those from masks (`lips`, `lower_lip`, `lids`, `ears`) are 0 off the chart."""

    points: np.ndarray
    nose: np.ndarray
    nose_outline: np.ndarray
    cheek: np.ndarray
    forehead: np.ndarray
    under_eye: np.ndarray
    upper_lid: np.ndarray
    chin: np.ndarray
    ear_flush: np.ndarray
    oily: np.ndarray
    wings: np.ndarray
    perioral: np.ndarray
    temple: np.ndarray
    jaw: np.ndarray
    lips: np.ndarray
    lower_lip: np.ndarray
    lids: np.ndarray
    ears: np.ndarray


def find_regions(points: np.ndarray, masks: dict[str, np.ndarray] | None = None) -> Regions:
    """Fields at template points (M,3) mm; `masks` as of `sample_masks`, none off the chart."""
    nose = bump(points, (0, -36, 43), (16, 12, 16))
    forehead = bump(points, (0, 50, 12), (46, 24, 40))
    chin = bump(points, (0, -96, 22), (18, 10, 20))
    x, y, z = np.abs(points[:, 0]), points[:, 1], points[:, 2]
    none = np.zeros(len(points), dtype=np.float32)
    masks = masks or {"lips": none, "eyelids": none, "ears": none}
    return Regions(
        points=points,
        nose=nose,
        nose_outline=_nose_outline(points),
        cheek=pair(points, (42, -38, 2), (17, 15, 28)),
        forehead=forehead,
        under_eye=pair(points, (28, -15, 10), (13, 5, 18)),
        upper_lid=pair(points, (29, 7, 12), (16, 6, 12)),
        chin=chin,
        ear_flush=pair(points, (77, -20, -68), (8, 26, 20)),
        oily=np.clip(nose + 0.8 * forehead + 0.6 * chin + 0.5 * bump(points, (0, -12, 30), (8, 22, 20)), 0, 1),
        wings=pair(points, (17, -42, 32), (4, 7, 10)),
        perioral=bump(points, (0, -66, 28), (27, 17, 24)),
        temple=pair(points, (62, 22, -22), (14, 26, 26)),
        jaw=smoothstep(-40, -78, y + 0.32 * x) * smoothstep(-80, -40, z) * smoothstep(-124, -104, y),
        lips=masks["lips"],
        lower_lip=masks["lips"] * smoothstep(_LIPS_MEET_Y + 0.8, _LIPS_MEET_Y - 0.8, y),
        lids=masks["eyelids"],
        ears=masks["ears"],
    )


def _nose_outline(points: np.ndarray) -> np.ndarray:
    """The whole nose (M,) as a face parser outlines it: bridge, wings and base."""
    x, y, z = points.T
    half_width = np.interp(y, [-47, -44, -38, -30, -22, -10, 2, 6], [0, 12, 18.5, 17.5, 14, 10, 7.5, 0])
    return smoothstep(1.0, -1.0, np.abs(x) - half_width) * (z > 0)


# In pixels. The border of the lips runs out over about a millimetre.
_OUTLINE_BLUR = {"lips": 2.0, "eyelids": 1.0, "ears": 1.0}


@functools.cache
def _mask(name: str) -> np.ndarray:
    """Region mask of the head data; the lips span some sixty of its pixels, so outlines are blurred."""
    return gaussian_filter(base_mesh.read_region(name), _OUTLINE_BLUR[name])


def sample_masks(native_uv: np.ndarray) -> dict[str, np.ndarray]:
    """Region masks of the head data at native UV (M,2): f32 in 0..1."""
    place = np.stack([(1 - native_uv[:, 1]), native_uv[:, 0]])
    masks = {}
    for name in ("lips", "eyelids", "ears"):
        size = np.array(_mask(name).shape, dtype=np.float32)[:, None]
        masks[name] = map_coordinates(_mask(name), place * size - 0.5, order=1, mode="nearest", output=np.float32)
    return masks

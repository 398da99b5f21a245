"""Skin tone as dermatology measures it: CIELAB under D65 and the individual typology angle.

ITA = atan((L* - 50) / b*), Chardon, Cretois & Hourseau 1991; the six groups: Del Bino et
al. 2006. As with a colorimeter, light is averaged over a patch of skin first; the patches
are the forehead and both cheeks.
"""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from .cache import load_head
from .labels import Label
from .paint import Maps
from .regions import bump

GROUPS = (
    ("very light", 55.0),
    ("light", 41.0),
    ("intermediate", 28.0),
    ("tan", 10.0),
    ("brown", -30.0),
    ("dark", -90.0),
)
"""Groups of skin tone and the angle (degrees) above which each lies."""

# Centres in template mm and radius: a few colorimeter readings side by side.
_SITES = {"forehead": (0, 48, 22), "left_cheek": (42, -34, 8), "right_cheek": (-42, -34, 8)}
_PATCH_MM = 10.0

_RGB_TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
"""Linear Rec.709 to CIE 1931 XYZ (IEC 61966-2-1)."""


def cielab(rgb: np.ndarray) -> np.ndarray:
    """L*, a*, b* (...,3) under D65 of linear Rec.709 reflectances (...,3)."""
    relative = np.asarray(rgb, dtype=np.float64) @ (_RGB_TO_XYZ / _RGB_TO_XYZ.sum(axis=1, keepdims=True)).T
    delta = 6 / 29
    root = np.where(relative > delta**3, np.cbrt(relative), relative / (3 * delta**2) + 4 / 29)
    x, y, z = np.moveaxis(root, -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


def typology_angle(lab: np.ndarray) -> np.ndarray:
    """Individual typology angle (...) in degrees of CIELAB colours (...,3)."""
    return np.degrees(np.arctan2(lab[..., 0] - 50, lab[..., 2]))


def tone_group(angle: float) -> str:
    """Name of the group of an angle in degrees."""
    return next(name for name, above in GROUPS if angle > above or name == "dark")


@dataclasses.dataclass(frozen=True)
class Tone:
    """Measured tone of a face: `lab` per site (CIELAB, D65), `angle` (ITA, degrees) of their mean, and its group."""

    lab: dict[str, tuple[float, float, float]]
    angle: float
    group: str

    def to_table(self) -> dict[str, Any]:
        """The table that is written with a capture's truth."""
        sites = {name: [round(value, 2) for value in lab] for name, lab in self.lab.items()}
        return {"ita_degrees": round(self.angle, 2), "group": self.group, "lab_d65": sites}


def face_ita(maps: Maps, chart: str = "face") -> Tone:
    """Tone of a generated face from its diffuse albedo: mean of forehead and cheeks, skin alone.

    Maps of any size do; the sites are found through the chart (of `spec.CHARTS`), which all generated faces share.
    """
    head = load_head(chart == "wide")
    points = head.template[head.chart_vertices].astype(np.float32)
    size = len(maps.labels)
    column = np.clip((head.chart_uv[:, 0] * size).astype(int), 0, size - 1)
    row = np.clip(((1 - head.chart_uv[:, 1]) * size).astype(int), 0, size - 1)
    skin = maps.labels[row, column] == Label.SKIN
    lab = {}
    for name, centre in _SITES.items():
        near = np.flatnonzero(skin & (bump(points, centre, (_PATCH_MM,) * 3) > np.exp(-0.5)))
        # The texels of the rectangle that holds the patch.
        box = np.s_[row[near].min() : row[near].max() + 1, column[near].min() : column[near].max() + 1]
        mean = maps.diffuse_albedo[box][maps.labels[box] == Label.SKIN].mean(axis=0, dtype=np.float64)
        lab[name] = tuple(map(float, cielab(mean)))
    angle = float(typology_angle(np.mean(list(lab.values()), axis=0)))
    return Tone(lab, angle, tone_group(angle))

"""The `[captured_mesh]` table."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any

from ..errors import SceneError
from .checks import known_keys, number


@dataclass(frozen=True)
class CapturedMesh:
    """Faults of the mesh that solvers get; none by default. The truth keeps the perfect one."""

    vertex_share: float = 1.0
    """Share of the vertices that decimation leaves."""
    smoothing_mm: float = 0.0
    """Standard deviation of the Gaussian that detail is smoothed with along the surface."""
    bumps_mm: float = 0.0
    """Root mean square height of bumps along the normals."""
    bumps_wavelength_mm: float = 10.0
    """Their typical wavelength."""

    def to_table(self) -> dict[str, Any]:
        """Keys that differ from the defaults, with their values, as the scene file has them."""
        return {key: value for key, value in asdict(self).items() if value != getattr(CapturedMesh(), key)}


_RANGES = {
    "vertex_share": (0.01, 1.0),
    "smoothing_mm": (0.0, 30.0),
    "bumps_mm": (0.0, 5.0),
    "bumps_wavelength_mm": (0.5, 200.0),
}


def parse_captured_mesh(table: Mapping[str, Any], place: str) -> CapturedMesh:
    known_keys(table, [field.name for field in fields(CapturedMesh)], place)
    values = {}
    for key, (low, high) in _RANGES.items():
        values[key] = number(table, key, place, getattr(CapturedMesh, key))
        if not low <= values[key] <= high:
            raise SceneError(f"{key} in {place} is {values[key]:g}; use a number from {low:g} to {high:g}")
    if "bumps_wavelength_mm" in table and not values["bumps_mm"]:
        raise SceneError(f"bumps_wavelength_mm in {place} does nothing without bumps_mm; write bumps_mm = 0.2")
    return CapturedMesh(**values)

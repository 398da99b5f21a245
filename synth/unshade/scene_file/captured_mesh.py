"""The `[captured_mesh]` table."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ..tables import Table, changes, read, real


@dataclass(frozen=True)
class CapturedMesh:
    """Faults of the mesh that solvers get; none by default. The truth keeps the perfect one."""

    vertex_share: float = real(1.0, 0.01, 1.0)
    """Share of the vertices that decimation leaves."""
    smoothing_mm: float = real(0.0, 0.0, 30.0)
    """Standard deviation of the Gaussian that detail is smoothed with along the surface."""
    bumps_mm: float = real(0.0, 0.0, 5.0)
    """Root mean square height of bumps along the normals."""
    bumps_wavelength_mm: float = real(10.0, 0.5, 200.0)
    """Their typical wavelength."""

    def to_table(self) -> dict[str, Any]:
        """Keys that differ from the defaults, with their values, as the scene file has them."""
        return changes(self)


def parse_captured_mesh(values: Mapping[str, Any], place: str) -> CapturedMesh:
    table = Table(values, place)
    mesh = read(CapturedMesh, table)
    if "bumps_wavelength_mm" in table and not mesh.bumps_mm:
        raise table.wrong("bumps_wavelength_mm", "does nothing without bumps_mm; write bumps_mm = 0.2")
    return mesh

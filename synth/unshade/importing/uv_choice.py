"""Whose texture coordinates a capture has: the mesh's own, or new ones in few islands."""

from __future__ import annotations

from typing import Any

from ..errors import CaptureError
from .chart_mesh import ChartMesh

UVS = ("auto", "keep", "new")
"""The mesh's own unless there are none or they are in many islands; its own; new ones."""


def with_uv(mesh: ChartMesh, choice: str, where: str) -> tuple[ChartMesh, list[str], dict[str, Any]]:
    """Returns the mesh as it is or unwrapped, warnings, and the numbers of islands for ``import.json``.

    Raises `CaptureError` if the texture coordinates cannot carry maps; ``where`` is the mesh's file.
    """
    own, warnings = 0, list[str]()
    if mesh.has_own_uv and choice != "new":
        fault, warning, _, own = mesh.layout_faults()
        if fault is not None:
            raise CaptureError(f"{where}: {fault}, or let it be unwrapped (--uv new)")
        if choice == "keep" or warning is None:
            return mesh, [f"the mesh {warning}"] if warning else [], {"new": False, "islands": own}
    elif choice == "keep":
        raise CaptureError(f"{where}: has no texture coordinates to keep; unwrap it, or leave out --uv keep")
    new = mesh.unwrapped()
    fault, warning, _, islands = new.layout_faults()
    if fault is not None:
        raise CaptureError(f"{where}: once unwrapped, {fault}")
    if own:
        had = f"has {own} UV islands, whose seams cost accuracy"
        warnings.append(f"the mesh {had}: it is unwrapped anew, into {islands} (--uv keep keeps its own)")
    elif not mesh.has_own_uv:
        warnings.append(f"the mesh has no texture coordinates: it is unwrapped into {islands} islands")
    if warning is not None:
        warnings.append(f"the mesh {warning}")
    return new, warnings, {"new": True, "islands": islands, **({"own_islands": own} if own else {})}

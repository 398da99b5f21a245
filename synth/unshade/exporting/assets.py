"""`export`: maps into one asset folder, with ``asset.json`` (its description) and ``fidelity.json`` (its losses)."""

from __future__ import annotations

import importlib.metadata
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import ExportError
from ..files.folder import ResumableFolder, content_hash
from ..files.pictures import write_json
from ..fingerprint import fingerprint
from ..surface import Surface, read_surface, require_maps
from . import fidelity, layered_bsdf
from .blender import FILE as BLEND
from .blender import write_blender
from .fidelity import Setting, setting_of
from .gltf import FILE as GLB
from .gltf import write_gltf
from .materialx import write_materialx
from .mitsuba_scene import mitsuba_shapes, write_mitsuba
from .onto_mesh import onto_mesh
from .plain_pictures import write_pictures
from .read_gltf import gltf_shape

FORMATS = ("gltf", "mitsuba", "blender", "materialx", "png")

Report = Callable[[int, int, str], None]


@dataclass(frozen=True)
class Options:
    """How to export: one of `FORMATS`, bits of normals (and of all of ``png``), and whether to compare."""

    format: str
    bits: int = 16
    green_up: bool = True
    fidelity: bool = True


def export(
    maps: Path,
    out: Path,
    capture: Path | None,
    mesh: Path | None,
    options: Options,
    progress: Report,
    warn: Callable[[str], None],
) -> tuple[list[dict[str, Any]], list[str]]:
    """Writes the asset folder; returns what it loses, as rows and as lines to print. Raises `ExportError`, `MapsError`, `CaptureError`."""
    progress(0, 1, "maps")
    surface = read_surface(maps, capture, mesh, warn)
    if capture is not None and mesh is not None:
        progress(0, 1, "resampling onto the mesh")
        surface = onto_mesh(surface, capture, mesh)
    require_maps(surface, maps)
    inputs = [*sorted(maps.glob("*.exr")), maps / "coverage.png"]
    inputs += [file for file in (capture and capture / "mesh.obj", mesh) if file is not None]
    folder = ResumableFolder(out, f"{options} {fingerprint(__name__)} {[content_hash(path) for path in inputs]}")
    setting = setting_of(capture, surface)
    described = _write(surface, folder.path, options, setting)
    document = {"format": options.format, "generator": _generator(), "texels": surface.size, **described}
    write_json(folder.path / "asset.json", document)
    rows: list[dict[str, Any]] = []
    if options.fidelity and options.format in ("gltf", "mitsuba", "blender"):
        rows = _compare(surface, setting, folder.path, options, progress)
    folder.commit()
    progress(1, 1, "asset")
    return rows, [str(out / described["file"]), *map(fidelity.line, rows)]


def _write(surface: Surface, folder: Path, options: Options, setting: Setting) -> dict[str, Any]:
    if options.format == "gltf":
        return write_gltf(surface, folder, options.bits, _generator())
    if options.format == "materialx":
        return write_materialx(surface, folder, options.bits)
    if options.format == "png":
        return write_pictures(surface, folder, options.bits, options.green_up)
    name, light = next(iter(setting.lights.items()))
    if options.format == "mitsuba":
        return write_mitsuba(surface, folder, light, setting.camera, setting.depth)
    if options.format == "blender":
        return write_blender(surface, folder, name, light, setting.camera, setting.depth)
    raise ExportError(f"{options.format}: is not a format; use one of {', '.join(FORMATS)}")


def _compare(
    surface: Surface, setting: Setting, folder: Path, options: Options, progress: Report
) -> list[dict[str, Any]]:
    ours, pictures = fidelity.reference(setting, surface), folder / "fidelity"
    if options.format == "blender":
        rows = fidelity.compare_blend(setting, ours, folder / BLEND, pictures, progress)
    else:
        layered_bsdf.register()
        shapes = mitsuba_shapes(folder) if options.format == "mitsuba" else {"gltf": gltf_shape(folder / GLB)}
        rows = fidelity.compare(setting, ours, shapes, pictures, progress)
    document = {"protocol": fidelity.PROTOCOL, "rows": rows}
    write_json(folder / "fidelity.json", document)
    return rows


def _generator() -> str:
    try:
        return f"unshade {importlib.metadata.version('unshade')}"
    except importlib.metadata.PackageNotFoundError:
        return "unshade"

"""Another method's maps, of any layout and encoding, as a maps folder on the capture's chart."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ... import _native
from ...commands import command
from ...errors import MapsError, StorageError
from ...files.folder import ResumableFolder, content_hash
from ...files.pictures import ROUGHNESS_CHANNELS, write_exr, write_gray, write_json, write_text
from ..capture_folder import RECORD
from ..chart_mesh import read_mesh
from ..placement import UNITS
from . import decoding
from .alignment import PLACES, Alignment, align, source_to_capture
from .counterpart import Counterparts, Layout, facing_out, find_counterparts
from .own_folder import OWN, is_own_folder, read_deviations
from .preflight import Preflight, Witness
from .statement import KINDS, Statement, read_statement
from .texture import DEVIATION, Codes, Floats, find_texture, halved, padded, read_codes, sampled

AnyPath = str | os.PathLike[str]

LIMIT_MM = 5.0
"""How far (mm) a point of another mesh may be from the capture's surface and still be the same."""

NORMALS = ("normal", "diffuse_normal", "specular_normal")
"""Normals for both kinds, and those of one kind."""

_TRIAL = 256
"""Side of the chart on which encodings are tried, texels."""


class MapsWarning(UserWarning):
    """A property of imported maps that their maker should know."""


def import_maps(
    folder: AnyPath,
    out: AnyPath,
    *,
    capture: _native.Capture | AnyPath,
    mesh: AnyPath | None = None,
    adapter: str | os.PathLike[str] | None = None,
    settings: Mapping[str, Any] | None = None,
    objects: Sequence[str] = (),
    unit: str | None = None,
    place: str = "auto",
    limit_mm: float = LIMIT_MM,
    size: int | None = None,
    apply: bool = False,
) -> Path:
    """Bring the maps in ``folder``, another method's of the face of ``capture``, into the maps folder ``out``, with
    ``import.json``, which lists statements, findings and assumptions; returns ``out``.

    ``mesh`` is the OBJ that they lie on (by default that in the folder which the adapter names), of which ``objects``
    are the face. ``adapter`` is a format by name or a TOML file (by default ``unshade`` for a folder that `solve` wrote,
    else ``any``, which finds every encoding), ``settings`` are laid over it:
    ``{"v": "down", "diffuse_albedo": {"curve": "linear"}}``. ``unit`` (``m``, ``cm``, ``mm``, ``dm``, ``in``) is the
    mesh's; ``place`` is ``auto`` (units and axes are tried), ``keep``, ``source`` (where the capture was before its
    import) or ``fit`` (a similarity by ICP). Texels whose counterpart is further than ``limit_mm`` stay uncovered.
    ``size`` is that of the maps, by default that of the largest texture. A better fit than the statement is the
    error, or with ``apply`` is taken.

    Raises `MapsError`, `CaptureError`, `PictureError` or `StorageError`.
    """
    if unit is not None and unit not in UNITS:
        raise MapsError(f"unit {unit!r} is unknown; there are {', '.join(UNITS)}")
    if place not in PLACES:
        raise MapsError(f"place {place!r} is unknown; there are {', '.join(PLACES)}")
    if not 0 < limit_mm < 1000:
        raise MapsError(f"limit_mm is {limit_mm}; it must be above 0 and below 1000")
    if size is not None and not 16 <= size <= 8192:
        raise MapsError(f"size is {size}; it must be from 16 to 8192")
    if not Path(folder).is_dir():
        raise MapsError(f"{folder}: is not a folder; name the one that holds the maps")
    opened = capture if isinstance(capture, _native.Capture) else _native.Capture(capture)
    name = os.fspath(adapter) if adapter is not None else OWN if is_own_folder(Path(folder)) else "any"
    statement = read_statement(name, settings or {})
    shape = None if mesh is None else Path(mesh)
    job = _Import(Path(folder), shape, opened, statement, tuple(objects))
    job.place(unit, place, limit_mm / 1000)
    job.write(Path(out), size, limit_mm / 1000, apply=apply)
    return Path(out)


class _Import:
    """One import: reads textures and mesh, places the mesh, settles encodings, and writes maps."""

    def __init__(
        self, folder: Path, mesh: Path | None, capture: _native.Capture, statement: Statement, objects: tuple[str, ...]
    ) -> None:
        self.folder, self.capture, self.statement = folder, capture, statement
        self.codes = _textures(folder, statement)
        self.deviations = read_deviations(statement, self.codes)
        self.mesh_file = mesh or _mesh_in(folder, statement)
        self.theirs = read_mesh(self.mesh_file, objects)
        if not self.theirs.has_own_uv:
            raise MapsError(f"{self.mesh_file}: has no texture coordinates; name the mesh that the maps were made for")
        self.alignment = Alignment(np.eye(4), "as it is", 0.0)
        uv = self.theirs.uv
        if uv.min() < -1e-4 or uv.max() > 1 + 1e-4:
            raise MapsError(f"{self.mesh_file}: its UV leave the unit square; use the tile that the maps were made for")
        self.theirs = replace(self.theirs, uv=uv.clip(0, 1))

    def place(self, unit: str | None, how: str, limit: float) -> None:
        """Moves the mesh to where the capture's lies."""
        ours = self.capture.mesh
        self.alignment = align(
            (self.theirs.vertices, self.theirs.triangles),
            ours["vertices"].astype(np.float64),
            how=how,
            unit=unit,
            source=source_to_capture(self.capture.path),
            limit=limit,
            shown=str(self.mesh_file),
        )
        step = max(1, len(ours["vertices"]) // 1000)
        points, normals = (ours[key][::step].astype(np.float64) for key in ("vertices", "normals"))
        self.theirs = facing_out(self.theirs.moved(self.alignment.matrix), points, normals)

    def write(self, out: Path, size: int | None, limit: float, *, apply: bool) -> None:
        for path in (self.folder, self.mesh_file, self.capture.path):
            if out.resolve() in (path.resolve(), *path.resolve().parents):
                raise StorageError(f"{out}: holds {path.name}, which is read; choose another folder for the maps")
        layouts = {v: Layout.of(self.theirs, down=v == "down") for v in ("up", "down")}
        trial = self._counterparts(_TRIAL, limit)
        if not trial.found.any():
            raise MapsError(f"{self.mesh_file}: has no counterpart of the capture's mesh within {1000 * limit:g} mm")
        used = np.zeros(len(self.theirs.triangles), bool)
        used[trial.triangle[trial.found]] = True
        # Mirrored halves are a template's choice; of two pages one has other textures than those that are read.
        fault, _, pages, _ = self.theirs.layout_faults(used)
        if fault is not None and pages:
            raise MapsError(f"{self.mesh_file}: {fault} (object)")
        flight = Preflight(self.statement, self.codes, layouts, trial, self._witness(trial), apply=apply)
        settled = flight.settle()
        size = size or max(codes.size for codes in self.codes.values())
        counterparts = trial if size == _TRIAL else self._counterparts(size, limit)
        maps = _Chart(settled, self.codes, self.deviations, layouts[settled.v], counterparts, self._turn()).maps()
        folder = ResumableFolder(out, self._key(settled, size, limit))
        for name, values in maps.items():
            _write_map(folder.path, name, values)
        solver = self.folder.resolve().name if settled.name == "any" else settled.name
        write_text(folder.path / "solve.json", self._own_file("solve.json") or json.dumps({"solver": solver}) + "\n")
        light = self.folder / "light.exr"
        if settled.name == OWN and light.is_file() and np.allclose(self.alignment.matrix, np.eye(4)):
            (folder.path / light.name).write_bytes(light.read_bytes())  # of a head that was moved it would be another
        findings = command("check", maps=folder.path, capture=self.capture.path)
        for finding in findings:
            warnings.warn(f"{finding['map']}: {finding['message']}; {finding['fix']}", MapsWarning, stacklevel=4)
        record = self._record(settled, flight, counterparts, limit, size) | {"findings": findings}
        write_json(folder.path / RECORD, record, ensure_ascii=False)
        folder.commit()

    def _counterparts(self, size: int, limit: float) -> Counterparts:
        mesh = self.capture.mesh
        parts = (mesh["vertices"], mesh["normals"], mesh["uvs"], mesh["triangles"])
        return find_counterparts(*parts, self.theirs, size=size, limit=limit)

    def _turn(self) -> NDArray[np.float64]:
        linear = self.alignment.matrix[:3, :3]
        return linear / np.cbrt(np.linalg.det(linear))

    def _witness(self, counterparts: Counterparts) -> Witness:
        pictures = {name: self.capture.image(name) for name in self.capture.train}
        texture, seen = self.capture.project(pictures, _TRIAL)
        normals = counterparts.texels.sample(self.capture.mesh["normals"])
        return Witness(texture, seen > 0, normals, self._turn())

    def _own_file(self, name: str) -> str | None:
        """The text of a file of a folder of ours."""
        path = self.folder / name
        return path.read_text(encoding="utf-8") if self.statement.name == OWN and path.is_file() else None

    def _key(self, settled: Statement, size: int, limit: float) -> str:
        files = [content_hash(codes.path) for codes in (*self.codes.values(), *self.deviations.values())]
        files.append(self._own_file("solve.json") or "")
        places = [str(self.folder), str(self.capture.path), content_hash(self.capture.path / "transforms.json")]
        return "\n".join([*places, repr(settled), f"{size} {limit}", content_hash(self.mesh_file), *files])

    def _record(
        self, settled: Statement, flight: Preflight, counterparts: Counterparts, limit: float, size: int
    ) -> dict[str, Any]:
        found = counterparts.found
        distance = 1000 * counterparts.distance[found]
        assumed = [f"{trial.key} is {trial.taken}" for trial in flight.trials if trial.how == "assumed"]
        return {
            "format": 1,
            "unshade": _native.__version__,
            "source": {"folder": str(self.folder), "mesh": str(self.mesh_file), "adapter": settled.name},
            "known_from": settled.source,
            "textures": {
                name: {"file": str(codes.path.relative_to(self.folder)), "size": codes.size, "bits": "float" if codes.exact else "integer"}
                for name, codes in self.codes.items()
            },
            "statement": {
                name: {key: value for key, value in vars(texture).items() if key != "file"}
                for name, texture in settled.maps.items()
                if name in self.codes or texture.value is not None
            },
            "v": settled.v,
            "trials": [vars(trial) for trial in flight.trials],
            "assumed": assumed,
            "mesh_to_capture": self.alignment.matrix.tolist(),
            "placed": self.alignment.words,
            "limit_mm": 1000 * limit,
            "size": size,
            "covered": round(float(found.mean()), 6),
            "distance_mm": {"median": round(float(np.median(distance)), 4), "largest": round(float(distance.max()), 4)},
        }  # fmt: skip


class _Chart:
    """Textures looked up at the counterparts of the capture's texels."""

    def __init__(
        self, settled: Statement, codes: dict[str, Codes], deviations: dict[str, Codes], layout: Layout,
        counterparts: Counterparts, turn: NDArray[np.float64],
    ) -> None:  # fmt: skip
        self.settled, self.codes, self.deviations, self.layout = settled, codes, deviations, layout
        self.counterparts, self.turn = counterparts, turn
        self._uv = counterparts.at(layout.uv, layout.mesh.triangles)

    def maps(self) -> dict[str, Floats]:
        """Maps (N,N[,C]) by name, and ``coverage``."""
        stated, maps = self.settled.maps, dict[str, Floats]()
        if "diffuse_albedo" in self.codes:
            codes, texture = self.codes["diffuse_albedo"], stated["diffuse_albedo"]
            maps["diffuse_albedo"] = self._at(decoding.linear(codes.values, texture.curve)).clip(0) * np.float32(
                texture.scale
            )
        self._specular(maps)
        if "roughness" in self.codes and stated["roughness"].kind == "lobes":
            maps["roughness"] = self._at(self.codes["roughness"].values)
        elif "roughness" in stated and (values := self._scalar("roughness")) is not None:
            one = decoding.alpha(values, stated["roughness"].kind)
            maps["roughness"] = np.stack([one, one, np.ones_like(one)], -1)
        found_normals = {name: self._normals(name) for name in NORMALS if name in self.codes}
        for name in NORMALS[1:]:
            if (values := found_normals.get(name, found_normals.get(NORMALS[0]))) is not None:
                maps[name] = values
        if "confidence" in self.codes:
            maps["confidence"] = self._at(self.codes["confidence"].plane("mean"))
        for name, codes in self.deviations.items():
            maps[name + DEVIATION] = self._at(codes.plane("mean") if codes.grey else codes.values)
        found = self.counterparts.found
        if "coverage" in self.codes:
            found = found & (self._at(self.codes["coverage"].plane(stated["coverage"].channel)) >= 0.5)
        if not found.any():
            raise MapsError(f"{self.codes['coverage'].path}: covers nothing of the face; invert it, or leave it out")
        return {name: self._spread(values, found) for name, values in maps.items()} | {
            "coverage": self.counterparts.texels.image(np.where(found, 255, 0).astype(np.uint8))
        }

    def _specular(self, maps: dict[str, Floats]) -> None:
        texture = self.settled.maps.get("specular_albedo")
        values = None if texture is None else self._scalar("specular_albedo")
        if texture is None or values is None:
            return
        maps["specular_albedo"] = decoding.reflectance(values, texture.kind)
        if texture.kind == "metalness" and "diffuse_albedo" in maps:
            # Base colour: what is metal reflects it, what is not scatters it.
            metal = values.clip(0, 1)
            maps["specular_albedo"] += metal * maps["diffuse_albedo"].mean(-1)
            maps["diffuse_albedo"] *= (1 - metal)[:, None]
        if texture.blocked is not None:
            maps["specular_albedo"] *= 1 - self._at(self.codes["specular_albedo"].plane(texture.blocked)).clip(0, 1)

    def _scalar(self, name: str) -> Floats | None:
        texture = self.settled.maps[name]
        if name in self.codes:
            return self._at(decoding.scalar(self.codes[name], texture))
        if texture.value is not None:
            return np.full(len(self._uv), texture.value * texture.scale, np.float32)
        return None

    def _normals(self, name: str) -> Floats:
        texture = self.settled.maps[name]
        found = decoding.normals(
            self._at(decoding.vectors(self.codes[name])),
            texture.kind,
            texture.green,
            self.layout,
            self.counterparts,
            self.turn,
        )
        # Where the picture holds no direction, the mesh's.
        missing = ~np.isfinite(found)
        if missing.any():
            found[missing] = self.layout.frames(self.counterparts)[2][missing]
        return found.astype(np.float32)

    def _at(self, values: Floats) -> Floats:
        """Values at the counterparts; where texels are finer than the chart's, means of them."""
        chart = self.layout.chart(len(values))
        while self._finer(len(values)) >= 2:
            values = halved(values, chart.inside)
            chart = self.layout.chart(len(values))
        return sampled(padded(values, chart), self._uv)

    def _finer(self, size: int) -> float:
        """How many texels of a texture of ``size`` lie along one of the chart, in the median."""
        texels = self.counterparts.texels
        place = texels.image(np.column_stack([self._uv * size, self.counterparts.found]))
        step = np.abs(np.diff(place[..., :2], axis=1)).max(-1)
        both = texels.inside[:, 1:] & texels.inside[:, :-1] & (place[:, 1:, 2] > 0) & (place[:, :-1, 2] > 0)
        return float(np.median(step[both])) if both.any() else 1.0

    def _spread(self, values: Floats, found: NDArray[np.bool_]) -> Floats:
        """As a picture; texels without a counterpart have the values of the nearest with one."""
        texels = self.counterparts.texels
        known = replace(texels, inside=texels.image(found).astype(bool))
        return texels.image(values)[known.nearest_inside()]


def _textures(folder: Path, statement: Statement) -> dict[str, Codes]:
    found: dict[str, Codes] = {}
    read: dict[Path, Codes] = {}
    for name in KINDS:
        texture = statement.maps.get(name)
        if texture is None or not texture.file:
            continue
        path = find_texture(folder, texture.file, read, below=not statement.certain)
        if path is not None:
            found[name] = read[path] = read.get(path) or read_codes(path)
    if not set(found) - {"coverage", "confidence"}:
        names = sorted({name for texture in statement.maps.values() for name in texture.file})
        raise MapsError(f"{folder}: holds none of {', '.join(names)} ({statement.origin}); name the adapter that fits")
    return found


def _mesh_in(folder: Path, statement: Statement) -> Path:
    for pattern in statement.mesh:
        found = sorted(folder.rglob(pattern))
        if found:
            return found[0]
    wanted = f"; {statement.origin} looks for {', '.join(statement.mesh)}" if statement.mesh else ""
    raise MapsError(f"{folder}: has no mesh{wanted}; name the OBJ that the maps lie on (mesh)")


def _write_map(folder: Path, name: str, values: NDArray[Any]) -> None:
    if name == "coverage":
        write_gray(folder / "coverage.png", values)
    elif name == "roughness":
        write_exr(folder / "roughness.exr", dict(zip(ROUGHNESS_CHANNELS, np.moveaxis(values, -1, 0))))
    else:
        write_exr(folder / f"{name}.exr", {"Y" if values.ndim == 2 else "": values})


__all__ = ["LIMIT_MM", "MapsWarning", "import_maps"]

"""Which files make a head: the `[face]` table with a `mesh`."""

from __future__ import annotations

import dataclasses
import difflib
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..face.spec import FaceError


class MeshWarning(UserWarning):
    """Something of a mesh that its maker should know, as that it is read otherwise than its file says."""


UNITS = {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001, "in": 0.0254}
"""Metres of each unit of length."""

AXES = ("+x", "-x", "+y", "-y", "+z", "-z")
MESH_FILES = (".obj", ".glb", ".gltf")
PICTURE_FILES = (".exr", ".png")

COLOUR_SPACES = ("linear", "srgb")
NORMAL_SPACES = ("object", "tangent")
ROUGHNESS_SPACES = ("lobes", "perceptual")

SKIN_REFLECTANCE = 0.028
"""Reflectance of skin at normal incidence, of index 1.4: ((1.4 - 1) / (1.4 + 1))^2."""

NOMINAL_ROUGHNESS = (0.15, 0.35, 0.5)
"""GGX alphas of the two lobes and the share of the first, as in `skin_bsdf`."""

_MAPS = {
    "diffuse_albedo": COLOUR_SPACES,
    "specular_albedo": COLOUR_SPACES,
    "diffuse_normal": NORMAL_SPACES,
    "specular_normal": NORMAL_SPACES,
    "roughness": ROUGHNESS_SPACES,
}
"""Maps, and what the numbers of their files may mean (key ``<map>_space``)."""

Colour = tuple[float, float, float]


@dataclasses.dataclass(frozen=True)
class HeadFiles:
    """A mesh, its maps, and how to read them. Every map is a file or a constant.

    The mesh is in ``units`` with the head's top towards ``up`` and its face towards
    ``forward``, right-handed. ``origin`` is the point of the file (in its units and axes)
    that becomes the world's origin, near the head's centre and 11 cm behind the tip of
    the nose; without it, it is found from the chart's extent (see `placement`). ``chart``
    names the objects (OBJ ``o``, glTF nodes or meshes) that carry the maps; absent, it is all
    of them. Other objects only occlude, in even ``occluder_albedo`` (linear Rec.709).

    ``diffuse_albedo`` (RGB) and ``specular_albedo`` (reflectance at normal incidence; file
    values times ``specular_albedo_scale``) are ``linear`` Rec.709 or ``srgb``. Normals are
    unit vectors in the axes of the file (``object``) or in the frame of the UVs
    (``tangent``, green up, as in glTF); PNGs hold n/2 + 1/2, EXRs n itself; without a file the mesh's normals serve.
    ``roughness`` holds GGX alpha 1, alpha 2 and the share of lobe 1 (``lobes``), or one
    value r whose alpha r^2 both lobes get (``perceptual``). ``labels`` is a grey PNG of
    region ids (`Label`).
    """

    name: str
    mesh: str
    diffuse_albedo: str | Colour
    units: str = "m"
    up: str = "+y"
    forward: str = "+z"
    origin: Colour | None = None
    chart: tuple[str, ...] | None = None
    diffuse_albedo_space: str = "linear"
    specular_albedo: str | float = SKIN_REFLECTANCE
    specular_albedo_space: str = "linear"
    specular_albedo_scale: float = 1.0
    diffuse_normal: str | None = None
    diffuse_normal_space: str = "object"
    specular_normal: str | None = None
    specular_normal_space: str = "object"
    roughness: str | Colour = NOMINAL_ROUGHNESS
    roughness_space: str = "lobes"
    labels: str | None = None
    occluder_albedo: Colour = (0.35, 0.22, 0.17)
    texture_size: int = 512

    @classmethod
    def from_table(cls, table: Mapping[str, Any], *, place: str = "[face]", folder: Path = Path()) -> HeadFiles:
        """Reads a `[face]` table; file names start from ``folder``.

        Raises `FaceError` naming the key and the fix, also for files that are not there.
        """
        return _Reader(table, place, folder).head()

    def to_table(self) -> dict[str, Any]:
        """The complete table: `from_table(head.to_table()) == head`."""
        table = {key: value for key, value in dataclasses.asdict(self).items() if value is not None}
        for name in _MAPS:
            # A space says how a file is read; constants need none.
            if not isinstance(table.get(name), str):
                del table[f"{name}_space"]
        if not isinstance(self.specular_albedo, str):
            del table["specular_albedo_scale"]
        return table

    def files(self) -> dict[str, str]:
        """The files by their keys, as they are named."""
        named = {key: getattr(self, key) for key in ("mesh", *_MAPS, "labels")}
        return {key: path for key, path in named.items() if isinstance(path, str)}


class _Reader:
    """One table being read."""

    def __init__(self, table: Mapping[str, Any], place: str, folder: Path) -> None:
        self.table, self.place, self.folder = table, place, folder

    def head(self) -> HeadFiles:
        known = [field.name for field in dataclasses.fields(HeadFiles)]
        for key in self.table:
            if key not in known:
                near = difflib.get_close_matches(key, known, 1, 0.0)[0]
                raise FaceError(f"unknown key '{key}' in {self.place}; did you mean '{near}'?")
        up, forward = self._choice("up", AXES, "+y"), self._choice("forward", AXES, "+z")
        if up[1] == forward[1]:
            raise FaceError(
                f"up and forward in {self.place} are {up} and {forward}, which lie in one line; name two axes"
            )
        if "diffuse_albedo" not in self.table:
            raise FaceError(
                f"diffuse_albedo in {self.place} is missing; name an EXR or PNG, or a linear colour as [0.5, 0.35, 0.3]"
            )
        return HeadFiles(
            name=self._text("name"),
            mesh=self._file("mesh", MESH_FILES),
            units=self._choice("units", tuple(UNITS), "m"),
            up=up,
            forward=forward,
            origin=self._three("origin", -math.inf, math.inf) if "origin" in self.table else None,
            chart=self._names("chart"),
            diffuse_albedo=self._map("diffuse_albedo", lambda: self._three("diffuse_albedo", 0, 1)),
            specular_albedo=self._map(
                "specular_albedo", lambda: self._number("specular_albedo", 0, 0.05, SKIN_REFLECTANCE)
            ),
            specular_albedo_scale=self._number("specular_albedo_scale", 1e-6, 1e6, 1.0),
            diffuse_normal=self._map("diffuse_normal", lambda: None),
            specular_normal=self._map("specular_normal", lambda: None),
            roughness=self._map("roughness", self._lobes),
            labels=self._file("labels", (".png",)) if "labels" in self.table else None,
            occluder_albedo=self._three("occluder_albedo", 0, 1, HeadFiles.occluder_albedo),
            texture_size=self._whole("texture_size", 64, 8192, HeadFiles.texture_size),
            **{f"{name}_space": self._space(name) for name in _MAPS},
        )

    def _map(self, key: str, constant) -> Any:
        """The file of a map, or its constant."""
        value = self.table.get(key)
        if key.endswith("_normal") and value is not None and not isinstance(value, str):
            raise FaceError(
                f"{key} in {self.place} is {value!r}; name an EXR or PNG, or leave it out for the mesh's normals"
            )
        return self._file(key, PICTURE_FILES) if isinstance(value, str) else constant()

    def _space(self, name: str) -> str:
        key, allowed = f"{name}_space", _MAPS[name]
        if isinstance(self.table.get(name), str):
            if key not in self.table:
                raise FaceError(
                    f"{key} in {self.place} is missing; state what {self.table[name]} holds: {' or '.join(allowed)}"
                )
            return self._choice(key, allowed, allowed[0])
        if key in self.table:
            raise FaceError(f'{key} in {self.place} is without a file; name {name} = "..." or leave the key out')
        return allowed[0]

    def _lobes(self) -> Colour:
        lobes = self._three("roughness", 0, 1, NOMINAL_ROUGHNESS)
        if min(lobes[:2]) < 0.01:
            raise FaceError(f"roughness in {self.place} is {list(lobes)}; use GGX alphas of 0.01 or more")
        return lobes

    def _file(self, key: str, kinds: tuple[str, ...]) -> str:
        path = self.folder / self._text(key)
        if path.suffix.lower() not in kinds:
            raise FaceError(f"{key} in {self.place} is {path.name!r}; use a file that ends with {' or '.join(kinds)}")
        if not path.is_file():
            raise FaceError(f"{key} in {self.place}: there is no file {path}; name one that is there")
        return str(path)

    def _text(self, key: str) -> str:
        value = self.table.get(key)
        if not isinstance(value, str) or not value:
            raise FaceError(f'{key} in {self.place} is missing or no text; write {key} = "..."')
        return value

    def _choice(self, key: str, allowed: tuple[str, ...], default: str) -> str:
        value = self.table.get(key, default)
        if value not in allowed:
            raise FaceError(f"{key} in {self.place} is {value!r}; use one of {', '.join(allowed)}")
        return value

    def _whole(self, key: str, low: int, high: int, default: int) -> int:
        value = self.table.get(key, default)
        if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
            raise FaceError(f"{key} in {self.place} is {value!r}; use a whole number from {low} to {high}")
        return value

    def _number(self, key: str, low: float, high: float, default: float) -> float:
        value = self.table.get(key, default)
        if not _is_number(value) or not low <= value <= high:
            raise FaceError(f"{key} in {self.place} is {value!r}; use a number from {low:g} to {high:g}")
        return float(value)

    def _three(self, key: str, low: float, high: float, default: Colour | None = None) -> Colour:
        value = self.table.get(key, default)
        good = isinstance(value, (list, tuple)) and len(value) == 3 and all(map(_is_number, value))
        if not good or not all(low <= v <= high for v in value):
            span = "" if low == -math.inf else f" from {low:g} to {high:g}"
            raise FaceError(f"{key} in {self.place} is {value!r}; use three numbers{span}")
        return tuple(map(float, value))

    def _names(self, key: str) -> tuple[str, ...] | None:
        if key not in self.table:
            return None
        names = self.table[key]
        if not isinstance(names, (list, tuple)) or not names or not all(isinstance(name, str) for name in names):
            raise FaceError(f'{key} in {self.place} is {names!r}; list the objects that carry the maps, as ["head"]')
        return tuple(names)


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)

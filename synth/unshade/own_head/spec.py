"""Which files make a head: the `[face]` table with a `mesh`."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..face.spec import FaceError
from ..tables import Table


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
        return _HeadTable(table, place, folder).head()

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


class _HeadTable(Table):
    """The table of a head, whose file names start from ``folder``."""

    def __init__(self, values: Mapping[str, Any], place: str, folder: Path) -> None:
        super().__init__(values, place, FaceError)
        self.folder = folder

    def head(self) -> HeadFiles:
        self.require_known([field.name for field in dataclasses.fields(HeadFiles)])
        up, forward = self.choice("up", AXES, "+y"), self.choice("forward", AXES, "+z")
        if up[1] == forward[1]:
            raise FaceError(
                f"up and forward in {self.place} are {up} and {forward}, which lie in one line; name two axes", key="up"
            )
        if "diffuse_albedo" not in self:
            raise self.wrong("diffuse_albedo", "is missing; name an EXR or PNG, or a linear colour as [0.5, 0.35, 0.3]")
        return HeadFiles(
            name=self.text("name"),
            mesh=self._file("mesh", MESH_FILES),
            units=self.choice("units", tuple(UNITS), "m"),
            up=up,
            forward=forward,
            origin=self._three("origin", -math.inf, math.inf) if "origin" in self else None,
            chart=self._names("chart"),
            diffuse_albedo=self._map("diffuse_albedo", lambda: self._three("diffuse_albedo", 0, 1)),
            specular_albedo=self._map(
                "specular_albedo", lambda: self.number("specular_albedo", 0, 0.05, SKIN_REFLECTANCE)
            ),
            specular_albedo_scale=self.number("specular_albedo_scale", 1e-6, 1e6, 1.0),
            diffuse_normal=self._map("diffuse_normal", lambda: None),
            specular_normal=self._map("specular_normal", lambda: None),
            roughness=self._map("roughness", self._lobes),
            labels=self._file("labels", (".png",)) if "labels" in self else None,
            occluder_albedo=self._three("occluder_albedo", 0, 1, HeadFiles.occluder_albedo),
            texture_size=self.whole("texture_size", 64, 8192, HeadFiles.texture_size),
            **{f"{name}_space": self._space(name) for name in _MAPS},
        )

    def _map(self, key: str, constant) -> Any:
        """The file of a map, or its constant."""
        value = self.values.get(key)
        if key.endswith("_normal") and value is not None and not isinstance(value, str):
            raise self.wrong(key, f"is {value!r}; name an EXR or PNG, or leave it out for the mesh's normals")
        return self._file(key, PICTURE_FILES) if isinstance(value, str) else constant()

    def _space(self, name: str) -> str:
        key, allowed = f"{name}_space", _MAPS[name]
        if isinstance(self.values.get(name), str):
            if key not in self:
                raise self.wrong(key, f"is missing; state what {self.values[name]} holds: {' or '.join(allowed)}")
            return self.choice(key, allowed, allowed[0])
        if key in self:
            raise self.wrong(key, f'is without a file; name {name} = "..." or leave the key out')
        return allowed[0]

    def _lobes(self) -> Colour:
        lobes = self._three("roughness", 0, 1, NOMINAL_ROUGHNESS)
        if min(lobes[:2]) < 0.01:
            raise self.wrong("roughness", f"is {list(lobes)}; use GGX alphas of 0.01 or more")
        return lobes

    def _file(self, key: str, kinds: tuple[str, ...]) -> str:
        path = self.folder / self.text(key)
        if path.suffix.lower() not in kinds:
            raise self.wrong(key, f"is {path.name!r}; use a file that ends with {' or '.join(kinds)}")
        if not path.is_file():
            raise FaceError(f"{key} in {self.place}: there is no file {path}; name one that is there", key=key)
        return str(path)

    def _three(self, key: str, low: float, high: float, default: Colour | None = None) -> Colour:
        span = "" if low == -math.inf else f" from {low:g} to {high:g}"
        red, green, blue = self.vector(key, f"three numbers{span}", 3, low, high, default)
        return red, green, blue

    def _names(self, key: str) -> tuple[str, ...] | None:
        if key not in self:
            return None
        names = self.values[key]
        if not isinstance(names, (list, tuple)) or not names or not all(isinstance(name, str) for name in names):
            raise self.wrong(key, f'is {names!r}; list the objects that carry the maps, as ["head"]')
        return tuple(names)

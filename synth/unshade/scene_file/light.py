"""The `[light]` and `[[relight]]` tables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ..errors import SceneError
from ..tables import Table, colour, flag, given, integer, names, one_of, real

HADAMARD_ORDERS = (2, 4, 8, 16, 32, 64)


@dataclass(frozen=True)
class KeyLight:
    """One square softbox to a side of the face; nothing fills the shadow.

    Azimuth 0 is in front of the face, 90 at its left hand (+X); elevation 90 is above.
    """

    azimuth_degrees: float = real(60, -180, 180)
    elevation_degrees: float = real(20, -85, 85)
    distance_metres: float = real(1.5, 0.4, 100)
    size_metres: float = real(0.5, 0.01, 10)


@dataclass(frozen=True)
class TwoColours:
    """Two square softboxes of unlike colour (linear Rec.709) at either hand of the face."""

    left: tuple[float, float, float] = colour(1.0, 0.42, 0.16)
    right: tuple[float, float, float] = colour(0.22, 0.48, 1.0)
    azimuth_degrees: float = real(55, 0, 180)
    elevation_degrees: float = real(10, -85, 85)
    distance_metres: float = real(1.5, 0.4, 100)
    size_metres: float = real(0.6, 0.01, 10)


@dataclass(frozen=True)
class Sun:
    """A clear day: the sun's disc, the sky about it, and a grey ground that they light.

    ``turbidity`` is Hosek and Wilkie's: 2 clear mountain air, 10 haze. A ``ground_albedo``
    of 0 leaves all below the horizon black.
    """

    azimuth_degrees: float = real(40, -180, 180)
    elevation_degrees: float = real(35, 2, 90)
    turbidity: float = real(3, 1, 10)
    ground_albedo: float = real(0.2, 0, 1)


@dataclass(frozen=True)
class PointLight:
    """A glowing ball as small as a bare LED."""

    azimuth_degrees: float = real(-35, -180, 180)
    elevation_degrees: float = real(25, -90, 90)
    distance_metres: float = real(1.0, 0.4, 100)
    radius_metres: float = real(0.004, 0.0005, 0.05)


@dataclass(frozen=True)
class Gradient:
    """A spherical gradient (Ma et al. 2007): (1 + d . axis) / 2 over directions d, or the full sphere."""

    axis: str = one_of("full", "x+", "x-", "y+", "y-", "z+", "z-")


@dataclass(frozen=True)
class Pattern:
    """Light from a part of the sphere's directions, none from the rest.

    ``half``: the half sphere around ``axis``. ``stripes``: ``count`` bands of equal solid
    angle across ``axis``, every other one lit, beginning at the axis. ``hadamard``: the
    sphere in ``order`` cells of equal solid angle, lit where row ``index`` of the
    Hadamard matrix of that order (Sylvester's) is +1; row 0 is the full sphere.
    ``inverse`` swaps lit and dark.
    """

    pattern: str = one_of("half", "stripes", "hadamard")
    axis: str = one_of("x+", "x-", "y+", "y-", "z+", "z-")
    count: int = integer(8, 2, 64)
    order: int = integer(16, 2, 64)
    index: int = integer(1, 0, 63)
    inverse: bool = flag(False)


TURNS = "turns"
"""The kind that is several lights: views are taken in each of them by turns."""

SETTINGS: dict[str, type] = {
    "key": KeyLight,
    "two-colour": TwoColours,
    "sun": Sun,
    "point": PointLight,
    "gradient": Gradient,
    "pattern": Pattern,
}
"""Kinds with parameters of their own."""

AnySettings = KeyLight | TwoColours | Sun | PointLight | Gradient | Pattern
LIGHT_KINDS = ("dome", "studio", "flash", "envmap", *SETTINGS)


@dataclass(frozen=True)
class Light:
    """One light. ``exposure`` 1 makes the largest irradiance on the face pi.

    The kinds ``gradient`` and ``pattern`` are parts of a light stage's sphere: 1 makes the
    whole sphere's irradiance pi, so that all parts share one exposure.

    ``path``, ``rotation_degrees`` (about +Y, turning +Z towards +X) and ``clamp`` (the
    largest radiance that is kept, in the picture's own units) belong to ``envmap``;
    ``settings`` to the kinds of `SETTINGS`, ``lights`` to `TURNS`.

    ``to_head`` is the rotation (3 x 3, row by row) to the head's axes from those that the light stands still in; None
    if they are the head's. No file states it.
    """

    name: str
    kind: str
    exposure: float = 1.0
    path: str | None = None
    rotation_degrees: float = 0.0
    clamp: float | None = None
    settings: AnySettings | None = None
    lights: tuple[Light, ...] = ()
    to_head: tuple[float, ...] | None = None

    def __post_init__(self) -> None:
        if self.settings is None and self.kind in SETTINGS:
            object.__setattr__(self, "settings", SETTINGS[self.kind]())

    @property
    def groups(self) -> tuple[Light, ...]:
        """The lights that views are taken in by turns; itself, if it is one light."""
        return self.lights or (self,)

    def to_table(self) -> dict[str, Any]:
        if self.lights:
            return {"name": self.name, "kind": self.kind, "lights": [light.to_table() for light in self.lights]}
        table = {"name": self.name, "kind": self.kind, "exposure": self.exposure}
        if self.kind == "envmap":
            table |= {"path": self.path, "rotation_degrees": self.rotation_degrees}
            if self.clamp is not None:
                table["clamp"] = self.clamp
        if self.settings is not None:
            table |= asdict(self.settings)
        return table


def parse_light(values: Mapping[str, Any], place: str, folder: Path) -> Light:
    table = Table(values, place)
    kind = table.choice("kind", (*LIGHT_KINDS, TURNS))
    if kind == TURNS:
        return _parse_turns(table, folder)
    own: tuple[str, ...] = ("path", "rotation_degrees", "clamp") if kind == "envmap" else ()
    if kind in SETTINGS:
        own = names(SETTINGS[kind])
    table.require_known(("name", "kind", "exposure", *own))
    path = None
    if kind == "envmap":
        path = str(folder / table.text("path"))
        if not Path(path).is_file():
            raise SceneError(
                f"path in {place}: there is no picture {path}; name a lat-long EXR or HDR file", key="path"
            )
    settings = SETTINGS[kind](**given(SETTINGS[kind], table)) if kind in SETTINGS else None
    if isinstance(settings, Pattern):
        _check_pattern(settings, table)
    return Light(
        name=table.folder_name(),
        kind=kind,
        exposure=table.number("exposure", default=1.0, above=0.0),
        path=path,
        rotation_degrees=table.number("rotation_degrees", default=0.0),
        clamp=table.number("clamp", above=0.0) if "clamp" in table else None,
        settings=settings,
    )


def _parse_turns(table: Table, folder: Path) -> Light:
    table.require_known(("name", "kind", "lights"))
    given = table.values.get("lights")
    if not isinstance(given, list) or len(given) < 2 or not all(isinstance(one, dict) for one in given):
        raise table.wrong("lights", "must be two lights or more, as lights = [{ name = ..., kind = ... }, ...]")
    lights = tuple(parse_light(one, f"lights of {table.place}", folder) for one in given)
    names = [table.folder_name(), *(light.name for light in lights)]
    if len(set(names)) < len(names) or any(light.lights for light in lights):
        raise table.wrong("lights", "must be single lights, each with a name of its own")
    return Light(names[0], TURNS, lights=lights)


def _check_pattern(pattern: Pattern, table: Table) -> None:
    if pattern.pattern != "hadamard":
        return
    if pattern.order not in HADAMARD_ORDERS:
        raise table.wrong("order", f"is {pattern.order}; use one of {', '.join(map(str, HADAMARD_ORDERS))}")
    if pattern.index >= pattern.order:
        raise table.wrong("index", f"is {pattern.index}, but order {pattern.order} has rows 0 to {pattern.order - 1}")
    if pattern.index == 0 and pattern.inverse:
        raise SceneError(
            f"index 0 in {table.place} is the full sphere, and its inverse is dark; use another row", key="index"
        )

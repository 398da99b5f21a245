"""The `[rig]` table."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ..errors import SceneError
from ..tables import Table, given, integer, real

_OPTICS = ("seed", "distance_metres", "fov_degrees")
_KEYS = {
    "phone": ("train", "test", "max_angle_degrees", *_OPTICS),
    "emily": (),
    "desktop": _OPTICS,
    "dome": ("train", "test", "max_angle_degrees", *_OPTICS),
    "ring": ("train", "test", "sweep_degrees", "distance_metres", "fov_degrees"),
    "turntable": ("train", "test", "sweep_degrees", "distance_metres", "fov_degrees"),
}
"""Keys of each kind, as they are written."""

RIG_KINDS = tuple(_KEYS)

_DEFAULTS: dict[str, dict[str, Any]] = {
    "desktop": {"distance_metres": 0.7, "fov_degrees": 22.0},
    "dome": {"train": 24, "test": 3, "max_angle_degrees": 60.0, "distance_metres": 0.9, "fov_degrees": 17.0},
    "ring": {"distance_metres": 0.61},
    "turntable": {"distance_metres": 0.61},
}
"""Where a kind's defaults differ from those of `Rig`."""


@dataclass(frozen=True)
class Rig:
    """The cameras; which keys belong to which kind: see `_KEYS`.

    ``fov_degrees`` is the angle of the picture's shorter side. In its place,
    ``equivalent_mm`` may name the focal length of a 24 x 36 mm camera whose whole frame is
    kept. ``withheld`` names the views that are not for training; absent, each kind
    withholds its own.
    """

    name: str
    kind: str
    train: int = integer(10, 1, 900)
    test: int = integer(2, 0, 90)
    max_angle_degrees: float = real(45, above=0)
    sweep_degrees: float = real(180, 0, 360)
    seed: int = integer(0, 0, 2**63 - 1)
    distance_metres: float = real(0.55, above=0)
    fov_degrees: float = real(25, above=0)
    equivalent_mm: float | None = real(None, above=0)
    withheld: tuple[str, ...] | None = None

    def to_table(self) -> dict[str, Any]:
        table = {key: getattr(self, key) for key in ("name", "kind", *_KEYS[self.kind])}
        if self.equivalent_mm is not None:
            del table["fov_degrees"]
            table["equivalent_mm"] = self.equivalent_mm
        if self.withheld is not None:
            table["withheld"] = list(self.withheld)
        return table

    @property
    def light_frame(self) -> str:
        """Whether the capture's light stands still with respect to the ``head``, or to the ``camera``."""
        return "camera" if self.kind == "turntable" else "head"

    @property
    def short_side_degrees(self) -> float:
        """Angle of view of the picture's shorter side."""
        if self.equivalent_mm is None:
            return self.fov_degrees
        return math.degrees(2 * math.atan(12 / self.equivalent_mm))

    def view_names(self) -> tuple[str, ...]:
        """Names of all views, in the order of the rig."""
        return tuple(f"{number:03d}" for number in range(self._view_count()))

    def _view_count(self) -> int:
        return {"emily": 9, "desktop": 6}.get(self.kind, self.train + self.test)


def parse_rig(values: Mapping[str, Any], place: str) -> Rig:
    table = Table(values, place)
    kind = table.choice("kind", RIG_KINDS)
    own = _KEYS[kind]
    table.require_known(("name", "kind", *own, *(("equivalent_mm",) if own else ()), "withheld"))
    stated = _DEFAULTS.get(kind, {}) | given(Rig, table)
    rig = Rig(name=table.text("name"), kind=kind, withheld=_withheld(table), **stated)
    if "equivalent_mm" in table and "fov_degrees" in table:
        raise SceneError(f"{place} has both equivalent_mm and fov_degrees, which say the same; keep one")
    widest = 90 if kind == "phone" else 85
    if rig.max_angle_degrees > widest:
        raise table.wrong("max_angle_degrees", f"is {rig.max_angle_degrees:g}; use at most {widest}")
    if rig.distance_metres < 0.25:
        raise table.wrong("distance_metres", f"is {rig.distance_metres:g}; use at least 0.25, outside the head")
    if rig.fov_degrees >= 150:
        raise table.wrong("fov_degrees", f"is {rig.fov_degrees:g}; use less than 150")
    if rig.equivalent_mm is not None and rig.equivalent_mm < 4:
        raise table.wrong("equivalent_mm", f"is {rig.equivalent_mm:g}; use at least 4")
    _check_withheld(rig, table)
    return rig


def _withheld(table: Table) -> tuple[str, ...] | None:
    if "withheld" not in table:
        return None
    names = table.values["withheld"]
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise table.wrong("withheld", f'is {names!r}; use a list of views, as withheld = ["003", "007"]')
    if len(set(names)) < len(names):
        raise table.wrong("withheld", "names a view twice; name it once")
    return tuple(names)


def _check_withheld(rig: Rig, table: Table) -> None:
    views = rig.view_names()
    for name in rig.withheld or ():
        if name not in views:
            raise table.wrong("withheld", f"names {name!r}, but the views are {views[0]} to {views[-1]}")
    if len(rig.withheld or ()) == len(views):
        raise table.wrong("withheld", f"names all {len(views)} views; leave at least one for training")

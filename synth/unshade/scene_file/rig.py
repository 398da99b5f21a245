"""The `[rig]` table."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any

from ..errors import SceneError
from .checks import choice, known_keys, number, text, whole

RIG_KINDS = ("phone", "emily")


@dataclass(frozen=True)
class Rig:
    """The cameras. All but ``name`` and ``kind`` belong to ``phone``."""

    name: str
    kind: str
    train: int = 10
    test: int = 2
    max_angle_degrees: float = 45.0
    seed: int = 0
    distance_metres: float = 0.55
    fov_degrees: float = 25.0

    def to_table(self) -> dict[str, Any]:
        table = asdict(self)
        return table if self.kind == "phone" else {"name": self.name, "kind": self.kind}


def parse_rig(table: Mapping[str, Any], place: str) -> Rig:
    kind = choice(table, "kind", RIG_KINDS, place)
    if kind != "phone":
        known_keys(table, ("name", "kind"), place)
        return Rig(name=text(table, "name", place), kind=kind)
    known_keys(table, [field.name for field in fields(Rig)], place)
    rig = Rig(
        name=text(table, "name", place),
        kind=kind,
        train=whole(table, "train", place, Rig.train, 1, 900),
        test=whole(table, "test", place, Rig.test, 0, 90),
        max_angle_degrees=number(table, "max_angle_degrees", place, Rig.max_angle_degrees, above=0.0),
        seed=whole(table, "seed", place, Rig.seed, 0, 2**63 - 1),
        distance_metres=number(table, "distance_metres", place, Rig.distance_metres, above=0.0),
        fov_degrees=number(table, "fov_degrees", place, Rig.fov_degrees, above=0.0),
    )
    if rig.max_angle_degrees > 90:
        raise SceneError(f"max_angle_degrees in {place} is {rig.max_angle_degrees:g}; use at most 90")
    if rig.distance_metres < 0.25:
        raise SceneError(f"distance_metres in {place} is {rig.distance_metres:g}; use at least 0.25, outside the head")
    if rig.fov_degrees >= 150:
        raise SceneError(f"fov_degrees in {place} is {rig.fov_degrees:g}; use less than 150")
    return rig

"""The `[light]` and `[[relight]]` tables."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ..errors import SceneError
from .checks import choice, folder_name, known_keys, number, text

LIGHT_KINDS = ("dome", "studio", "flash", "envmap")


@dataclass(frozen=True)
class Light:
    """One light. ``exposure`` 1 makes the largest irradiance on the face pi.

    ``path``, ``rotation_degrees`` (about +Y, turning +Z towards +X) and ``clamp`` (the
    largest radiance that is kept, in the picture's own units) belong to ``envmap``.
    """

    name: str
    kind: str
    exposure: float = 1.0
    path: str | None = None
    rotation_degrees: float = 0.0
    clamp: float | None = None

    def to_table(self) -> dict[str, Any]:
        table = {key: value for key, value in asdict(self).items() if value is not None}
        if self.kind != "envmap":
            del table["rotation_degrees"]
        return table


def parse_light(table: Mapping[str, Any], place: str, folder: Path) -> Light:
    kind = choice(table, "kind", LIGHT_KINDS, place)
    own = ("path", "rotation_degrees", "clamp") if kind == "envmap" else ()
    known_keys(table, ("name", "kind", "exposure", *own), place)
    path = None
    if kind == "envmap":
        path = str(folder / text(table, "path", place))
        if not Path(path).is_file():
            raise SceneError(f"path in {place}: there is no picture {path}; name a lat-long EXR or HDR file")
    return Light(
        name=folder_name(table, place),
        kind=kind,
        exposure=number(table, "exposure", place, 1.0, above=0.0),
        path=path,
        rotation_degrees=number(table, "rotation_degrees", place, 0.0),
        clamp=number(table, "clamp", place, math.inf, above=0.0) if "clamp" in table else None,
    )

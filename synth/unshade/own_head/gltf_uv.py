"""Where the textures of a glTF material lie on its mesh: the set of coordinates, and KHR_texture_transform."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..face.spec import FaceError

_PLACES = (
    ("pbrMetallicRoughness",),
    ("extensions", "KHR_materials_pbrSpecularGlossiness"),
    ("extensions", "KHR_materials_specular"),
    (),
)
_TEXTURES = (
    "baseColorTexture",
    "diffuseTexture",
    "metallicRoughnessTexture",
    "specularGlossinessTexture",
    "specularTexture",
    "specularColorTexture",
    "normalTexture",
)
"""Textures that a head's maps are: light maps (occlusion, emission) often lie elsewhere."""


class UvPlacement(NamedTuple):
    """The coordinates TEXCOORD_`number`, which `matrix` (two rows of three) takes to the texture's, v down."""

    number: int
    matrix: tuple[tuple[float, float, float], ...]

    def applied(self, uv: np.ndarray) -> np.ndarray:
        """Coordinates (V,2) in the texture."""
        matrix = np.array(self.matrix)
        return uv @ matrix[:, :2].T + matrix[:, 2]


def uv_placement(path: Path, material: dict[str, Any], number: int | None) -> UvPlacement:
    """The one placement of a material's textures; raises `FaceError` if they have several."""
    placements: dict[str, UvPlacement] = {}
    for place in _PLACES:
        holder = material
        for key in place:
            holder = holder.get(key, {})
        placements |= {key: _of_texture(holder[key]) for key in _TEXTURES if key in holder}
    first = next(iter(placements), None)
    if first is None:
        return _of_texture({})
    for key, placement in placements.items():
        if placement != placements[first]:
            raise FaceError(
                f"{path}: material {material.get('name', number)!r}: {first} and {key} lie on the mesh differently "
                "(texCoord or KHR_texture_transform); bake them to one layout"
            )
    return placements[first]


def _of_texture(info: dict[str, Any]) -> UvPlacement:
    moved = info.get("extensions", {}).get("KHR_texture_transform", {})
    across, down = (float(value) for value in moved.get("scale", (1, 1)))
    x, y = (float(value) for value in moved.get("offset", (0, 0)))
    turn = float(moved.get("rotation", 0))
    number = moved.get("texCoord", info.get("texCoord", 0))
    if not isinstance(number, int) or not np.isfinite([across, down, x, y, turn]).all():
        raise ValueError("a material's KHR_texture_transform is not finite")
    c, s = float(np.cos(turn)), float(np.sin(turn))
    # Counter-clockwise as the texture is seen, whose v points down.
    return UvPlacement(number, ((across * c, down * s, x), (-across * s, down * c, y)))

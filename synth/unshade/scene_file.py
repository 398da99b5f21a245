"""The resolved scene file: one TOML text that says all that a capture depends on.

Unknown keys, missing keys and values of the wrong kind are `SceneError`s that name the
key, its table, and the nearest valid key or the values that would do.
"""

from __future__ import annotations

import difflib
import math
import sys
from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from .errors import SceneError
from .face.spec import FaceSpec

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

FORMAT = 1
LIGHT_KINDS = ("dome", "studio", "flash", "envmap")
RIG_KINDS = ("phone", "emily")
VARIANTS = ("auto", "llvm_ad_rgb", "scalar_rgb")


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


@dataclass(frozen=True)
class Render:
    """Picture size in pixels, samples per pixel, path segments, seed and variant."""

    width: int
    height: int
    samples: int = 128
    depth: int = 6
    seed: int = 0
    variant: str = "auto"


@dataclass(frozen=True)
class Scene:
    """Everything that a capture depends on, beside the renderer itself."""

    name: str
    face: FaceSpec
    light: Light
    relight: tuple[Light, ...]
    rig: Rig
    render: Render
    versions: Mapping[str, str]
    """The renderer that made the capture; empty before there is one."""

    @property
    def lights(self) -> tuple[Light, ...]:
        """The light of the capture, then the others."""
        return (self.light, *self.relight)


def read_scene(path: Path) -> Scene:
    """Opens a resolved scene file. Raises `SceneError` (or `FaceError` for its face)."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise SceneError(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}") from error
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise SceneError(f"{path}: is not valid TOML: {error}") from error
    return parse_scene(table, str(path), path.parent)


def parse_scene(table: Mapping[str, Any], place: str, folder: Path) -> Scene:
    """Checks a scene's table; ``folder`` is what relative picture paths start from."""
    _known_keys(table, ("format", "name", "face", "light", "relight", "rig", "render", "versions"), place)
    if table.get("format") != FORMAT:
        raise SceneError(f"{place}: format is {table.get('format', 'missing')}; this version reads format = {FORMAT}")
    name = _text(table, "name", place)
    face = FaceSpec.from_table(_table(table, "face", place), place=f"[face] of {place}")
    light = _light(_table(table, "light", place), f"[light] of {place}", folder)
    others = table.get("relight", [])
    if not isinstance(others, list) or not all(isinstance(other, dict) for other in others):
        raise SceneError(f"{place}: relight must be tables [[relight]]")
    relight = tuple(
        _light(other, f"[[relight]] number {number} of {place}", folder)
        for number, other in enumerate(others, 1)
    )
    names = [one.name for one in (light, *relight)]
    for one in names:
        if names.count(one) > 1:
            raise SceneError(f"{place}: two lights are named {one!r}; give each its own name")
    rig = _rig(_table(table, "rig", place), f"[rig] of {place}")
    render = _render(_table(table, "render", place), f"[render] of {place}")
    return Scene(name, face, light, relight, rig, render, _versions(table, place))


def _light(table: Mapping[str, Any], place: str, folder: Path) -> Light:
    kind = _choice(table, "kind", LIGHT_KINDS, place)
    own = ("path", "rotation_degrees", "clamp") if kind == "envmap" else ()
    _known_keys(table, ("name", "kind", "exposure", *own), place)
    path = None
    if kind == "envmap":
        path = str(folder / _text(table, "path", place))
        if not Path(path).is_file():
            raise SceneError(f"path in {place}: there is no picture {path}; name a lat-long EXR or HDR file")
    return Light(
        name=_folder_name(table, place),
        kind=kind,
        exposure=_number(table, "exposure", place, 1.0, above=0.0),
        path=path,
        rotation_degrees=_number(table, "rotation_degrees", place, 0.0),
        clamp=_number(table, "clamp", place, math.inf, above=0.0) if "clamp" in table else None,
    )


def _rig(table: Mapping[str, Any], place: str) -> Rig:
    kind = _choice(table, "kind", RIG_KINDS, place)
    if kind != "phone":
        _known_keys(table, ("name", "kind"), place)
        return Rig(name=_text(table, "name", place), kind=kind)
    _known_keys(table, [field.name for field in fields(Rig)], place)
    rig = Rig(
        name=_text(table, "name", place),
        kind=kind,
        train=_whole(table, "train", place, Rig.train, 1, 900),
        test=_whole(table, "test", place, Rig.test, 0, 90),
        max_angle_degrees=_number(table, "max_angle_degrees", place, Rig.max_angle_degrees, above=0.0),
        seed=_whole(table, "seed", place, Rig.seed, 0, 2**63 - 1),
        distance_metres=_number(table, "distance_metres", place, Rig.distance_metres, above=0.0),
        fov_degrees=_number(table, "fov_degrees", place, Rig.fov_degrees, above=0.0),
    )
    if rig.max_angle_degrees > 90:
        raise SceneError(f"max_angle_degrees in {place} is {rig.max_angle_degrees:g}; use at most 90")
    if rig.distance_metres < 0.25:
        raise SceneError(f"distance_metres in {place} is {rig.distance_metres:g}; use at least 0.25, outside the head")
    if rig.fov_degrees >= 150:
        raise SceneError(f"fov_degrees in {place} is {rig.fov_degrees:g}; use less than 150")
    return rig


def _render(table: Mapping[str, Any], place: str) -> Render:
    _known_keys(table, [field.name for field in fields(Render)], place)
    render = Render(
        width=_whole(table, "width", place, None, 16, 8192),
        height=_whole(table, "height", place, None, 16, 8192),
        samples=_whole(table, "samples", place, Render.samples, 4, 1 << 16),
        depth=_whole(table, "depth", place, Render.depth, 2, 64),
        seed=_whole(table, "seed", place, Render.seed, 0, 2**63 - 1),
        variant=_choice(table, "variant", VARIANTS, place) if "variant" in table else Render.variant,
    )
    if passes_for(render.samples) is None:
        near = next(n for n in range(render.samples, 1 << 17) if passes_for(n))
        raise SceneError(f"samples in {place} is {render.samples}, which stratified passes cannot share; use {near}")
    return render


def passes_for(samples: int) -> int | None:
    """Number of passes (4 to 16) whose share of the samples is a full multijitter grid."""
    for passes in range(4, 17):
        share, rest = divmod(samples, passes)
        if rest == 0 and share and share % math.isqrt(share) == 0:
            return passes
    return None


def _versions(table: Mapping[str, Any], place: str) -> dict[str, str]:
    versions = table.get("versions", {})
    if not isinstance(versions, dict) or not all(isinstance(v, str) for v in versions.values()):
        raise SceneError(f"{place}: [versions] must hold texts; it is written by synth, leave it out")
    return versions


def _known_keys(table: Mapping[str, Any], known, place: str) -> None:
    for key in table:
        if key not in known:
            near = difflib.get_close_matches(key, known, 1, 0.0)[0]
            raise SceneError(f"unknown key '{key}' in {place}; did you mean '{near}'?")


def _table(table: Mapping[str, Any], key: str, place: str) -> Mapping[str, Any]:
    value = table.get(key)
    if not isinstance(value, dict):
        raise SceneError(f"{place}: the table [{key}] is missing; write it")
    return value


def _text(table: Mapping[str, Any], key: str, place: str) -> str:
    value = table.get(key)
    if not isinstance(value, str) or not value:
        raise SceneError(f"{key} in {place} is missing or no text; write {key} = \"...\"")
    return value


def _folder_name(table: Mapping[str, Any], place: str) -> str:
    name = _text(table, "name", place)
    if name in (".", "..") or any(c in '/\\:*?"<>|' or ord(c) < 32 for c in name):
        raise SceneError(f"name in {place} is {name!r}, but folders carry it; use letters, digits, - and _")
    return name


def _choice(table: Mapping[str, Any], key: str, allowed: tuple[str, ...], place: str) -> str:
    value = table.get(key)
    if value not in allowed:
        said = "missing" if value is None else repr(value)
        raise SceneError(f"{key} in {place} is {said}; use one of {', '.join(allowed)}")
    return value


def _whole(table: Mapping[str, Any], key: str, place: str, default: int | None, low: int, high: int) -> int:
    value = table.get(key, default)
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        said = "missing" if value is None else repr(value)
        raise SceneError(f"{key} in {place} is {said}; use a whole number from {low} to {high}")
    return value


def _number(
    table: Mapping[str, Any], key: str, place: str, default: float, *, above: float = -math.inf
) -> float:
    value = table.get(key, default)
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not number or math.isnan(value) or (key in table and math.isinf(value)) or not value > above:
        wanted = "a number" if above == -math.inf else f"a number above {above:g}"
        raise SceneError(f"{key} in {place} is {value!r}; use {wanted}")
    return float(value)

"""The statement on another method's maps: files, encodings, layout. An adapter is a statement that is kept."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from ...errors import MapsError
from ..pictures import check_curve

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ADAPTERS = Path(__file__).resolve().parent.parent / "adapters"
"""Statements that come with unshade, by the names of their files."""

AUTO = "auto"

KINDS: dict[str, tuple[str, ...]] = {
    "diffuse_normal": ("object", "tangent", AUTO),
    "specular_normal": ("object", "tangent", AUTO),
    "normal": ("object", "tangent", AUTO),
    "roughness": ("alpha", "perceptual", "gloss", "alpha-squared", "lobes", AUTO),
    "specular_albedo": ("reflectance", "f0", "level", "share", "ior", "metalness", AUTO),
    "coverage": (AUTO,),
    "confidence": (AUTO,),
    "diffuse_albedo": (AUTO,),
}
"""The maps that a statement may have, and what the numbers of each may be (``as``). They are looked for
in this order: a pattern takes no file that was taken before.

Specular albedo: reflectance at normal incidence (``f0`` is the same), ``level`` / 0.08, ``share`` of 0.05, index of
refraction, metalness. Roughness: GGX alpha, its root, 1 minus its root, its square, or ``lobes`` (an EXR with alpha1,
alpha2, share1).
"""

_V = ("up", "down", AUTO)
_GREEN = ("up", "down", AUTO)
_CHANNELS = ("R", "G", "B", "A", "mean")


@dataclass(frozen=True)
class Texture:
    """One map. ``file`` are names or patterns in the folder, of which the first that is found counts.

    ``kind`` is what the numbers are (``as`` in files, see `KINDS`), ``curve`` their transfer curve, ``scale`` what they
    are multiplied by once linear, ``value`` one number in place of a file, ``green`` where a tangent-space normal's
    green points on the picture, ``blocked`` the channel that holds the share of specular light that is held back.
    """

    file: tuple[str, ...] = ()
    kind: str = AUTO
    curve: str = AUTO
    channel: str = "mean"
    scale: float = 1.0
    value: float | None = None
    green: str = AUTO
    blocked: str | None = None


@dataclass(frozen=True)
class Statement:
    """``name`` of the format, ``origin`` the file that states it, ``source`` where that is known from, ``mesh`` patterns
    of the OBJ in the folder, ``v`` whether the pictures' first row lies at v = 1 (``up``) or at v = 0 (``down``).
    ``certain`` statements are not doubted, and name files of the folder itself alone. ``laid_over`` are the keys that
    the settings state."""

    name: str
    origin: str
    source: str = ""
    mesh: tuple[str, ...] = ()
    v: str = AUTO
    maps: Mapping[str, Texture] = field(default_factory=lambda: dict[str, Texture]())
    certain: bool = False
    laid_over: frozenset[str] = frozenset()

    def stated_by(self, key: str) -> str:
        """Who states a key, as ``normal.as``."""
        return "settings" if key in self.laid_over else self.origin

    def with_map(self, name: str, **changes: Any) -> Statement:
        """The statement with other values for one map."""
        return replace(self, maps={**self.maps, name: replace(self.maps[name], **changes)})


def known_adapters() -> list[str]:
    """Names of the adapters that come with unshade."""
    return sorted(path.stem for path in ADAPTERS.glob("*.toml"))


def read_statement(adapter: str, settings: Mapping[str, Any]) -> Statement:
    """The statement of an adapter, a name or a TOML file, with ``settings`` laid over it:
    ``{"v": "down", "diffuse_albedo": {"curve": "linear"}}``. Raises `MapsError`."""
    name = adapter
    path = ADAPTERS / f"{name}.toml" if name in known_adapters() else Path(name)
    known = f"there are {', '.join(known_adapters())}, or a TOML file"
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise MapsError(f"adapter {name!r}: cannot be read: {error.strerror}; {known}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise MapsError(f"{path}: is not TOML: {error}; {known}") from error
    if table.pop("format", None) != 1:
        raise MapsError(f"{path}: has an unknown format; write format = 1")
    shown = f"adapter {path.stem}" if path.parent == ADAPTERS else str(path)
    statement = _statement(shown, table, Statement(str(table.pop("name", path.stem)), shown))
    keys = frozenset(
        key if inner is None else f"{key}.{inner}"
        for key, value in settings.items()
        for inner in (value if isinstance(value, Mapping) else (None,))
    )
    return replace(_statement("settings", dict(settings), statement), laid_over=keys)


def _statement(origin: str, table: dict[str, Any], below: Statement) -> Statement:
    maps = dict(below.maps)
    changes: dict[str, Any] = {}
    for key, value in table.items():
        if key in KINDS:
            if not isinstance(value, Mapping):
                raise MapsError(f"{origin}: {key} is {value!r}; write a table, as {key} = {{ file = ... }}")
            maps[key] = _texture(origin, key, value, maps.get(key, Texture()))
        elif key == "mesh":
            changes[key] = _names(origin, key, value)
        elif key == "source":
            changes[key] = str(value)
        elif key == "certain":
            changes[key] = value is True
        elif key == "v":
            changes[key] = _choice(origin, key, value, _V)
        else:
            raise MapsError(f"{origin}: {key!r} is unknown; there are v, mesh, {', '.join(KINDS)}")
    return replace(below, maps=maps, **changes)


def _texture(origin: str, name: str, table: Mapping[str, Any], below: Texture) -> Texture:
    changes: dict[str, Any] = {}
    known = ["as", *(item.name for item in fields(Texture) if item.name != "kind")]
    for key, value in table.items():
        place = f"{name}.{key}"
        if key == "file":
            changes["file"] = _names(origin, place, value)
        elif key == "as":
            kind = _choice(origin, place, value, KINDS[name])
            changes["kind"] = "reflectance" if kind == "f0" else kind
        elif key == "curve":
            changes["curve"] = check_curve(str(value))
        elif key in ("channel", "blocked"):
            changes[key] = _choice(origin, place, value, _CHANNELS)
        elif key == "green":
            changes["green"] = _choice(origin, place, value, _GREEN)
        elif key in ("scale", "value"):
            if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value < 1e6:
                raise MapsError(f"{origin}: {place} is {value!r}; write a number, 0 or more")
            changes[key] = float(value)
        else:
            raise MapsError(f"{origin}: {place} is unknown; there are {', '.join(known)}")
    return replace(below, **changes)


def _names(origin: str, key: str, value: Any) -> tuple[str, ...]:
    names = (value,) if isinstance(value, str) else tuple(value) if isinstance(value, list | tuple) else ()
    if not names or not all(isinstance(name, str) and name and ".." not in name for name in names):
        raise MapsError(f"{origin}: {key} is {value!r}; write a file's name in the folder, or a list of them")
    return tuple(Path(name).as_posix().lstrip("/") for name in names)


def _choice(origin: str, key: str, value: Any, choices: tuple[str, ...]) -> str:
    if value not in choices:
        raise MapsError(f"{origin}: {key} is {value!r}; there are {', '.join(choices)}")
    return str(value)

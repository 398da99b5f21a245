"""``unshade import maps``: the arguments of the command line."""

from __future__ import annotations

import argparse
import sys
import warnings
from pathlib import Path
from typing import Any

from ...errors import UnshadeError
from ..placement import UNITS
from .alignment import PLACES
from .importer import LIMIT_MM, import_maps
from .statement import known_adapters

_DESCRIPTION = "Convert another method's maps, of any UV layout and encoding, to a capture's chart."
_EPILOG = "docs/results-of-others.md describes the formats, the detection of conventions, and how to state them."


def main(arguments: list[str]) -> int:
    """Runs ``unshade import maps`` with ``arguments``; returns the exit code."""
    options = _parser().parse_args(arguments)
    try:
        with warnings.catch_warnings():
            warnings.showwarning = lambda message, *_, **__: print(f"unshade: {message}", file=sys.stderr)
            warnings.simplefilter("always")
            out = import_maps(**{**vars(options), "settings": _settings(options.settings)})
    except UnshadeError as error:
        print(f"unshade: {' '.join(str(error).split())}", file=sys.stderr)
        return error.exit_code
    print(f"{out}: {out / 'import.json'} has the stated, detected and assumed conventions", file=sys.stderr)
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="unshade import maps", description=_DESCRIPTION, epilog=_EPILOG)
    parser.add_argument("folder", type=Path, help="the folder with the maps")
    parser.add_argument("-o", "--out", type=Path, required=True, help="the maps' folder")
    parser.add_argument("--capture", type=Path, required=True, help="the capture that they were made from")
    parser.add_argument("--mesh", type=Path, help="their mesh, an OBJ; by default the one in the folder")
    parser.add_argument(
        "--adapter",
        metavar="NAME|FILE",
        help=f"the method that wrote them: {', '.join(known_adapters())}, or a TOML file",
    )
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        dest="settings",
        type=_setting,
        metavar="KEY=VALUE",
        help="override a value of the adapter: v=down, diffuse_albedo.curve=linear, normal.green=down",
    )
    parser.add_argument(
        "--object",
        action="append",
        default=[],
        dest="objects",
        metavar="NAME",
        help="an object of the mesh that is the face",
    )
    parser.add_argument("--unit", choices=tuple(UNITS), help="the mesh's unit")
    parser.add_argument(
        "--place",
        choices=PLACES,
        default="auto",
        help="try units and axes, keep the mesh's place, move it like the capture's source, or fit it",
    )
    parser.add_argument(
        "--limit-mm", type=float, default=LIMIT_MM, metavar="MM", help="ignore points farther than this from the capture's mesh"
    )  # fmt: skip
    parser.add_argument(
        "--size", type=int, metavar="N", help="texels per side; by default those of the largest texture"
    )
    parser.add_argument("--apply", action="store_true", help="use a convention that fits better than the stated one")
    return parser


def _setting(text: str) -> tuple[str, str]:
    key, equals, value = text.partition("=")
    if not equals or not key or not value:
        raise argparse.ArgumentTypeError(f"{text!r} is not KEY=VALUE")
    return key.strip(), value.strip()


def _settings(pairs: list[tuple[str, str]]) -> dict[str, Any]:
    """Tables of dotted keys; scales and values are numbers."""
    settings: dict[str, Any] = {}
    for key, text in pairs:
        name, dot, inner = key.partition(".")
        value: Any = text
        if inner in ("scale", "value"):
            try:
                value = float(text)
            except ValueError:
                value = text
        if dot:
            settings.setdefault(name, {})[inner] = value
        else:
            settings[name] = value
    return settings

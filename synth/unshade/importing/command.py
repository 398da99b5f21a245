"""``unshade import``: the arguments of the command line."""

from __future__ import annotations

import argparse
import json
import sys
import warnings
from pathlib import Path

from ..errors import UnshadeError
from ..stated_light import LIGHT_FRAMES
from .capture_folder import RECORD
from .importer import import_capture
from .parser_labels import PARSERS
from .pictures import CURVES
from .placement import PLACES, UNITS
from .programs import FORMATS
from .uv_choice import UVS

_DESCRIPTION = "Import photographs, cameras and a mesh of other programs as a capture folder."
_EPILOG = "unshade import maps --help: maps of other methods. docs/photographs.md describes the formats, the assumptions, and what to do if cameras do not fit."


def main(arguments: list[str]) -> int:
    """Runs ``unshade import`` with ``arguments``; returns the exit code."""
    if arguments[:1] == ["maps"]:
        from .maps.command import main as maps_main

        return maps_main(arguments[1:])
    options = _parser().parse_args(arguments)
    bar = _Bar()
    try:
        with warnings.catch_warnings():
            warnings.showwarning = lambda message, *_, **__: bar.line(f"unshade: {message}")
            warnings.simplefilter("always")
            out = import_capture(**vars(options), progress=bar.step)
    except UnshadeError as error:
        bar.line(f"unshade: {' '.join(str(error).split())}")
        return error.exit_code
    bar.line(f"{out}: {json.loads((out / RECORD).read_bytes())['summary']}; details in {out / RECORD}")
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="unshade import", description=_DESCRIPTION, epilog=_EPILOG)
    parser.add_argument(
        "format", choices=FORMATS, help="the program that wrote the cameras; RealityCapture exports colmap"
    )
    parser.add_argument(
        "path", type=Path, help="transforms.json, the COLMAP model or project, the XML file, the data set's folder"
    )
    parser.add_argument("-o", "--out", type=Path, required=True, help="the capture's folder")
    parser.add_argument(
        "--mesh",
        metavar="FILE|hull",
        help="the mesh, an OBJ file with texture coordinates, or hull: carved from the masks",
    )
    parser.add_argument(
        "--object",
        action="append",
        default=[],
        dest="objects",
        metavar="NAME",
        help="an object of the mesh that is the face; may be repeated",
    )
    parser.add_argument(
        "--uv",
        choices=UVS,
        default="auto",
        help="keep the mesh's UV, or unwrap it anew; auto: anew if it has none, or a hundred islands or more",
    )
    parser.add_argument(
        "--pictures", type=Path, metavar="DIR", help="the photographs' folder, if the files do not state it"
    )
    parser.add_argument(
        "--masks",
        metavar="DIR|alpha|silhouette|grabcut",
        help="a folder of masks named like the photographs, their alpha, the mesh's silhouette, or GrabCut's",
    )
    parser.add_argument(
        "--labels", type=Path, metavar="DIR", help="label pictures of a face parser, named like the photographs"
    )
    parser.add_argument(
        "--parser", metavar="NAME|FILE", help=f"the parser: {', '.join(PARSERS)}, or a JSON file of names by id"
    )
    parser.add_argument("--curve", default="auto", help=f"the photographs' transfer curve: {', '.join(CURVES)}")
    parser.add_argument("--brackets", type=int, default=1, metavar="N", help="exposures per view, in consecutive files")
    parser.add_argument("--even-exposure", action="store_true", help="divide by the exposure in EXIF")
    parser.add_argument(
        "--unknown-exposure",
        action="store_true",
        help="exposure and white balance changed from frame to frame: a solve estimates them",
    )
    parser.add_argument(
        "--frames", type=int, metavar="N", help="choose N frames of a video: sharp ones, from all sides of the head"
    )
    parser.add_argument(
        "--holdout",
        type=_holdout,
        metavar="N|NAMES",
        help="withhold every N-th view, or the named views: 8, or 003,011",
    )
    parser.add_argument("--shrink", type=int, default=1, metavar="N", help="average N x N pixels")
    parser.add_argument("--unit", choices=tuple(UNITS), help="the unit of mesh and cameras")
    parser.add_argument(
        "--place", choices=PLACES, default="auto", help="turn the head upright by its cameras, or keep its orientation"
    )
    parser.add_argument("--front", metavar="VIEW", help="a frontal view, if the cameras surround the head")
    parser.add_argument("--apply", action="store_true", help="make the change with which masks and mesh match")
    parser.add_argument(
        "--skip-missing", action="store_true", help="leave out views whose photograph or mask is missing"
    )
    parser.add_argument(
        "--leave-out", type=_names, default=[], metavar="NAMES", help="leave out the named views: 003,cam1/0002.jpg"
    )
    parser.add_argument(
        "--light-frame",
        choices=LIGHT_FRAMES,
        help="what the light stands still with: the head, or the camera (a turning head, a lamp on the camera)",
    )
    return parser


def _holdout(text: str) -> int | list[str]:
    # A number of up to two digits is a step: names of frames have more, or are given with a comma.
    if text.isdigit() and len(text) <= 2:
        return int(text)
    return _names(text)


def _names(text: str) -> list[str]:
    return [name for name in text.split(",") if name]


class _Bar:
    """A progress bar on one line of a terminal; nothing elsewhere."""

    def __init__(self) -> None:
        self._shown = sys.stderr.isatty()

    def step(self, done: int, total: int, what: str) -> None:
        if self._shown:
            print(f"\r\x1b[Kimport: {done} of {total}, {what}", end="", file=sys.stderr, flush=True)

    def line(self, text: str) -> None:
        if self._shown:
            print("\r\x1b[K", end="", file=sys.stderr)
        print(text, file=sys.stderr, flush=True)

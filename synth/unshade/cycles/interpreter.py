"""Where Blender is, and how it is run."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from ..errors import RendererError

VARIABLE = "UNSHADE_BLENDER"
FOLDER = ".venv-cycles"
"""Beside the environment that unshade runs in; `make cycles` makes it."""

_CHILD = Path(__file__).with_name("blender_child.py")


def command() -> list[str]:
    """How Blender is started with the child: a Python with ``bpy``, or a ``blender``. Raises `RendererError`."""
    named = os.environ.get(VARIABLE)
    own = Path(sys.prefix).parent / FOLDER / "bin" / "python"
    if named:
        if not Path(named).is_file():
            raise RendererError(f"{VARIABLE}={named}: is not a program; name a Python that has bpy, or blender")
        return _started_by(named)
    if own.is_file():
        return [str(own), str(_CHILD)]
    blender = shutil.which("blender")
    if blender:
        return _started_by(blender)
    raise RendererError(
        f"Blender is missing: run `make cycles`, or name a Python that has bpy (or blender) in {VARIABLE}"
    )


def _started_by(program: str) -> list[str]:
    if Path(program).name.startswith("blender"):
        return [program, "--background", "--factory-startup", "--python-exit-code", "1", "--python", str(_CHILD), "--"]
    return [program, str(_CHILD)]


def run(job: Path, report: Callable[[dict[str, Any]], None]) -> None:
    """Does a job of `description`; calls ``report`` for each picture: what is ``done``, its ``light``, ``view`` and ``number``.

    Raises `RendererError` with Blender's last words.
    """
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    environment["UNSHADE_PARENT"] = str(os.getpid())
    with subprocess.Popen(
        [*command(), str(job)], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        errors="replace", env=environment,
    ) as child:  # fmt: skip
        last = "no message"
        try:
            for words in child.stdout or ():
                if words.startswith('{"done"'):
                    report(json.loads(words))
                elif words.strip() and not words.startswith("Blender quit"):
                    last = words.strip()
        except BaseException:
            child.kill()
            raise
    if child.returncode:
        raise RendererError(f"Blender ended with {child.returncode}: {last}; try another in {VARIABLE}")

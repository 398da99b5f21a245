"""Runs a Python function as a solver: ``python -m unshade.plugin module:function CAPTURE MAPS``.

The function takes an :class:`unshade.Capture` (without its truth) and, by name, the values of the JSON
object in the variable ``UNSHADE_SET``; it returns :class:`unshade.Maps`.
"""

from __future__ import annotations

import importlib
import inspect
import json
import os
import sys

import unshade


def main(spec: str, capture: str, maps: str) -> None:
    """Call the function that ``spec`` names and write the maps that it returns."""
    module, _, function = spec.partition(":")
    sys.path.insert(0, os.getcwd())
    solver = getattr(importlib.import_module(module), function)
    settings = json.loads(os.environ.get("UNSHADE_SET", "{}"))
    try:
        inspect.signature(solver).bind(capture, **settings)
    except TypeError as error:
        sys.exit(f"{spec}{inspect.signature(solver)} cannot be called with set = {json.dumps(settings)}: {error}")
    recovered = solver(unshade.Capture(capture), **settings)
    if not isinstance(recovered, unshade.Maps):
        sys.exit(f"{spec} returned {type(recovered).__name__}; return unshade.Maps")
    recovered.write(maps)


if __name__ == "__main__":
    main(*sys.argv[1:])

"""Runs a Python function as a solver: ``python -m unshade.plugin module:function CAPTURE MAPS``.

The function takes an :class:`unshade.Capture` (without its truth) and returns
:class:`unshade.Maps`.
"""

from __future__ import annotations

import importlib
import os
import sys

import unshade


def main(spec: str, capture: str, maps: str) -> None:
    """Call the function ``spec`` names and write what it returns."""
    module, _, function = spec.partition(":")
    sys.path.insert(0, os.getcwd())
    solver = getattr(importlib.import_module(module), function)
    recovered = solver(unshade.Capture(capture))
    if not isinstance(recovered, unshade.Maps):
        sys.exit(f"{spec} returned {type(recovered).__name__}; return unshade.Maps")
    recovered.write(maps)


if __name__ == "__main__":
    main(*sys.argv[1:])

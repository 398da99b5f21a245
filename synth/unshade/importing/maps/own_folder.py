"""Maps folders as `unshade solve` writes them, on another UV than the capture's."""

from __future__ import annotations

import json
from pathlib import Path

from ... import _native
from ...files.pictures import ROUGHNESS_CHANNELS
from .statement import Statement
from .texture import DEVIATION, Codes, read_codes

OWN = "unshade"
"""The adapter that reads them."""


def is_own_folder(folder: Path) -> bool:
    """Whether a folder is a maps folder of ours: by its record, its standard deviations, or its two lobes."""
    try:
        if json.loads((folder / "solve.json").read_bytes())["solver"] == OWN:
            return True
    except (OSError, ValueError, KeyError, TypeError):
        pass
    if not (folder / "diffuse_albedo.exr").is_file():
        return False
    roughness = folder / "roughness.exr"
    if roughness.is_file():
        names, _ = _native.read_exr(roughness)
        return set(names) == set(ROUGHNESS_CHANNELS)
    return any(folder.glob(f"*{DEVIATION}.exr"))


def read_deviations(statement: Statement, codes: dict[str, Codes]) -> dict[str, Codes]:
    """The standard deviations per texel that lie beside maps of ours, by the maps' names."""
    if statement.name != OWN:
        return {}
    beside = {name: one.path.with_name(one.path.stem + DEVIATION + ".exr") for name, one in codes.items()}
    return {name: read_codes(path) for name, path in beside.items() if path.is_file()}

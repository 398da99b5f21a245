"""Hash of the renderer's versions and sources, by which kept renderings are valid or not.

``python -m unshade.fingerprint`` prints one line; equal lines mean equal pictures.
"""

from __future__ import annotations

import functools
import hashlib
from importlib.metadata import version
from pathlib import Path

from ._native import reader_sources

_LIBRARIES = ("mitsuba", "drjit", "numpy", "scipy", "libigl", "anny", "pillow")


_NO_PICTURE = "figures"
"""Draws what was measured, long after; nothing that renders imports it."""


@functools.cache  # sources that change later are not those at work here
def fingerprint() -> str:
    """Versions of the libraries and hashes of the sources that make a picture, and of those that read its files."""
    package = Path(__file__).parent
    digest = hashlib.blake2b(digest_size=16)
    for path in sorted(package.rglob("*.py")):
        if path.relative_to(package).parts[0] == _NO_PICTURE:
            continue
        digest.update(path.relative_to(package).as_posix().encode() + b"\0" + path.read_bytes())
    versions = " ".join(f"{name}={version(name)}" for name in _LIBRARIES)
    return f"{versions} sources={digest.hexdigest()} readers={reader_sources}"


if __name__ == "__main__":
    print(fingerprint())

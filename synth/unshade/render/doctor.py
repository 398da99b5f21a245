"""Checks of this machine for rendering; each that fails names its fix."""

from __future__ import annotations

import importlib.metadata
import os
import platform
from typing import Any

from .. import perceptual
from ..cache_folder import cache_folder
from ..face import FaceError
from ..face.base_mesh import data_folder, data_version
from . import cuda, llvm

_PACKAGES = ("mitsuba", "drjit", "numpy", "scipy", "libigl", "pillow")


def examine() -> list[dict[str, Any]]:
    """One entry per finding: ``name``, ``ok``, ``found``, and ``fix`` where it is not ok."""
    checks = [_entry("python", True, platform.python_version())]
    checks += [_package(name) for name in _PACKAGES]
    if all(check["ok"] for check in checks):
        checks += _variant()
    return [*checks, _head_data(), _cache(), _entry("lpips", True, perceptual.found())]


def _entry(name: str, ok: bool, found: str, fix: str = "") -> dict[str, Any]:
    return {"name": name, "ok": ok, "found": found} | ({} if ok else {"fix": fix})


def _package(name: str) -> dict[str, Any]:
    try:
        return _entry(name, True, importlib.metadata.version(name))
    except importlib.metadata.PackageNotFoundError:
        return _entry(name, False, "not installed", f"install the Python package {name}")


def _variant() -> list[dict[str, Any]]:
    choice, gpu = llvm.choose(), cuda.probe()
    library = choice.llvm
    found = f"{library.version}, {library.path} ({library.origin})" if library else str(choice.warning)
    return [
        _entry("llvm", library is not None, found, llvm.FIX),
        # That there is none is no fault, that it traces nothing is.
        _entry("gpu", gpu.ok or not gpu.found, f"traces with {cuda.CUDA_VARIANT}" if gpu.ok else gpu.reason, cuda.FIX),
        _entry("variant", True, cuda.CUDA_VARIANT if gpu.ok else choice.variant),
    ]


def _head_data() -> dict[str, Any]:
    try:
        return _entry("head data", True, f"{data_version()} in {data_folder()}")
    except FaceError as error:
        found, _, fix = str(error).partition("; ")
        return _entry("head data", False, found, fix)


def _cache() -> dict[str, Any]:
    folder = cache_folder()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        writable = os.access(folder, os.W_OK)
    except OSError:
        writable = False
    return _entry("cache", writable, str(folder), "let XDG_CACHE_HOME name a folder that can be written")

"""Chooses the renderer's variant, and the LLVM library behind it.

Left alone, Dr.Jit takes any libLLVM it finds; versions 15 and 16 abort the whole process.
So the library is named explicitly and tried in a child process first. Without a library
that works, ``scalar_rgb`` is the announced fallback: right, but too slow for more than
small pictures, since the material is Python code. An NVIDIA GPU that traces (`cuda`) comes
first where a scene leaves the choice. Variants draw different samples or round differently:
one capture is rendered, and relit, in one variant only.
"""

from __future__ import annotations

import importlib.metadata
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from ..errors import VariantError
from . import cuda, probe_memory
from .cuda import CUDA_VARIANT

LLVM_VARIANT, SCALAR_VARIANT = "llvm_ad_rgb", "scalar_rgb"

MINIMUM_VERSION = 19
"""The oldest LLVM of the system that is tried; 15 and 16 are known to abort."""

PACKAGE = "karellen-llvm-core"
"""The Python package that carries an LLVM, so that none need be installed by root."""

FIX = f"install {PACKAGE} with pip, or let DRJIT_LIBLLVM_PATH name a libLLVM of version {MINIMUM_VERSION} or newer"

_PROBE = """
import drjit, mitsuba as mi
mi.set_variant("llvm_ad_rgb")
scene = mi.load_dict({"type": "scene", "integrator": {"type": "path"}, "light": {"type": "constant"},
                      "ball": {"type": "sphere", "center": [0, 0, 4]}, "sensor": {"type": "perspective", "film": {"type": "hdrfilm", "width": 4, "height": 4}}})
picture = mi.render(scene, spp=4)
assert drjit.sum(picture.array)[0] > 0
print("works with LLVM", ".".join(map(str, drjit.detail.llvm_version())))
"""


@dataclass(frozen=True)
class Candidate:
    """A library that might do, and where it was found."""

    path: Path
    origin: str


@dataclass(frozen=True)
class Probe:
    """An LLVM library as a child process found it: its version, or why it failed."""

    path: str
    origin: str
    version: str | None
    reason: str = ""

    @property
    def ok(self) -> bool:
        return self.version is not None


@dataclass(frozen=True)
class Choice:
    """The variant to render with, its LLVM if it has one, and a warning for the user."""

    variant: str
    llvm: Probe | None
    warning: str | None = None


def candidates(system: Path = Path("/")) -> Iterator[Candidate]:
    """Libraries in the order in which they are tried; ``system`` is the root to search."""
    named = os.environ.get("DRJIT_LIBLLVM_PATH")
    if named:
        yield Candidate(Path(named), "DRJIT_LIBLLVM_PATH")
    yield from (Candidate(path, PACKAGE) for path in _of_package())
    yield from (Candidate(path, "system") for path in _of_system(system))


def _of_package() -> list[Path]:
    try:
        package = importlib.metadata.distribution(PACKAGE)
    except importlib.metadata.PackageNotFoundError:
        return []
    names = [f for f in package.files or () if re.fullmatch(r"libLLVM\.(so\.[\d.]+|dylib)", f.name)]
    return [Path(os.path.normpath(package.locate_file(name))) for name in sorted(names)]


def _of_system(root: Path) -> list[Path]:
    folders = ("usr/lib/*-linux-gnu", "usr/lib/llvm-*/lib", "usr/lib64", "usr/local/lib")
    found: dict[Path, int] = {}
    for folder in folders:
        for path in root.glob(f"{folder}/libLLVM*.so*"):
            version = re.search(r"libLLVM[-.](?:so\.)?(\d+)", path.name)
            if version and int(version[1]) >= MINIMUM_VERSION and path.exists():
                found.setdefault(path.resolve(), int(version[1]))
    return sorted(found, key=lambda path: (-found[path], str(path)))


def probe(candidate: Candidate) -> Probe:
    """Renders a tiny picture with the library in a child process; successes are remembered."""
    path = str(candidate.path)
    try:
        stat = candidate.path.stat()
    except OSError as error:
        return Probe(path, candidate.origin, None, f"cannot be read: {error.strerror}")
    drjit, mitsuba = (importlib.metadata.version(name) for name in ("drjit", "mitsuba"))
    key = f"{path} {stat.st_size} {stat.st_mtime_ns} drjit={drjit} mitsuba={mitsuba}"
    known = probe_memory.recall()
    if isinstance(known.get(key), str):
        return Probe(path, candidate.origin, known[key])
    result = _try(candidate)
    if result.version is not None:
        probe_memory.remember(key, result.version)
    return result


def _try(candidate: Candidate) -> Probe:
    environment = os.environ | {"DRJIT_LIBLLVM_PATH": str(candidate.path)}
    try:
        child = subprocess.run(
            [sys.executable, "-c", _PROBE],
            env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return Probe(str(candidate.path), candidate.origin, None, "no picture within 120 s")
    version = re.search(r"works with LLVM ([\d.]+)", child.stdout)
    if child.returncode == 0 and version:
        return Probe(str(candidate.path), candidate.origin, version[1])
    lines = child.stderr.strip().splitlines()
    words = lines[-1].strip() if lines else "no message"
    return Probe(str(candidate.path), candidate.origin, None, f"exit status {child.returncode}: {words}")


def choose(requested: str = "cpu") -> Choice:
    """The variant for a request: ``auto`` takes a GPU, an LLVM or the fallback, whichever works first, ``cpu`` no GPU;
    else the name of a variant.

    Raises `VariantError` where a variant is demanded that does not work.
    """
    if requested == SCALAR_VARIANT:
        return Choice(SCALAR_VARIANT, None)
    gpu_warning = None
    if requested in ("auto", CUDA_VARIANT):
        gpu = cuda.probe()
        if gpu.ok:
            return Choice(CUDA_VARIANT, None)
        if requested == CUDA_VARIANT:
            raise VariantError(f"{CUDA_VARIANT} cannot trace here: {gpu.reason}; {cuda.FIX}")
        if gpu.found:
            gpu_warning = f"the GPU traces nothing, so the processors do: {gpu.reason}; {cuda.FIX}"
    choice = _on_processors(requested)
    return replace(choice, warning="; ".join(filter(None, [gpu_warning, choice.warning])) or None)


def _on_processors(requested: str) -> Choice:
    """``llvm_ad_rgb``, or unless that is demanded ``scalar_rgb``."""
    failures = []
    for candidate in candidates():
        result = probe(candidate)
        if result.ok:
            return Choice(LLVM_VARIANT, result, "; ".join(failures) or None)
        failures.append(f"{result.path} ({result.origin}): {result.reason}")
    why = "; ".join(failures) or "none was found"
    if requested == LLVM_VARIANT:
        raise VariantError(f"{LLVM_VARIANT} needs an LLVM that works: {why}; {FIX}")
    slow = "rendering falls back to scalar_rgb, about 0.3 ms a sample (40 minutes for 256 x 256 with 128)"
    return Choice(SCALAR_VARIANT, None, f"no LLVM that works: {why}; {slow}; {FIX}")


def activate(choice: Choice) -> None:
    """Sets the variant of this process, once, and registers the skin material.

    Raises `VariantError` if the process already renders in another one: its classes
    belong to the variant that was set when they were made; or if Dr.Jit, imported earlier,
    has already taken another LLVM.
    """
    if choice.llvm:
        os.environ["DRJIT_LIBLLVM_PATH"] = choice.llvm.path
    import mitsuba as mi

    if mi.variant() not in (None, choice.variant):
        raise VariantError(f"this process already renders with {mi.variant()}; start another one for {choice.variant}")
    if mi.variant() is None:
        mi.set_variant(choice.variant)
    if choice.llvm:
        import drjit as dr

        # With one thread, as on a single processor, building a scene waits for itself for ever.
        if dr.thread_count() < 2:
            dr.set_thread_count(2)
        taken = ".".join(map(str, dr.detail.llvm_version()))
        if taken != choice.llvm.version:
            raise VariantError(
                f"drjit was imported first and took LLVM {taken}, not {choice.llvm.path}; "
                f"import unshade before drjit and mitsuba, or set DRJIT_LIBLLVM_PATH={choice.llvm.path}"
            )
    from .principled_skin import PrincipledSkinBSDF
    from .skin_bsdf import SkinBSDF

    mi.register_bsdf("skin", SkinBSDF)
    mi.register_bsdf("principled_skin", PrincipledSkinBSDF)

"""One scene gives the same bytes with any number of threads and any LLVM that works."""

from __future__ import annotations

import hashlib
from collections.abc import Callable

from .. import llvm
from .child import NAMES, ChildError, Setting, render_in_child
from .verdict import Verdict

THREADS = (1, 2, 5)
"""Thread counts that share the work in different ways; more than there are cores is fine."""

_SETTING = Setting(width=48, height=40, samples=64, depth=4)


def digest(setting: Setting) -> str:
    """Hash of all bytes that a child renders."""
    pictures = render_in_child(setting)
    sums = hashlib.blake2b(digest_size=8)
    for name in NAMES:
        for plane in (pictures[name].diffuse, pictures[name].specular, pictures[name].variance):
            sums.update(plane.tobytes())
    return sums.hexdigest()


def settings(threads: tuple[int, ...] = THREADS) -> dict[str, Setting]:
    """Settings that are compared, by name: every thread count with the LLVM in use, then every other LLVM that works."""
    libraries = [result for result in map(llvm.probe, llvm.candidates()) if result.ok]
    cases = {
        f"{count} thread{'s' * (count > 1)}": _case(count, libraries[0].path if libraries else None)
        for count in threads
    }
    seen = {library.version: library for library in reversed(libraries)}
    for version, library in seen.items():
        if version != libraries[0].version:
            cases[f"LLVM {version}"] = _case(2, library.path)
    return cases


def _case(threads: int, library: str | None) -> Setting:
    return Setting(**vars(_SETTING) | {"threads": threads, "library": library})


def check_determinism(cases: dict[str, Setting] | None = None, digest: Callable[[Setting], str] = digest) -> Verdict:
    """Renders every case and compares the hashes."""
    suspect = "render/passes.py: sums that depend on order, or a variant that differs"
    cases = settings() if cases is None else cases
    try:
        hashes = {name: digest(setting) for name, setting in cases.items()}
    except ChildError as error:
        return Verdict("determinism", False, f"a child renders nothing: {error}", suspect)
    first = next(iter(hashes))
    others = [name for name in hashes if hashes[name] != hashes[first]]
    compilers = 1 + sum(name.startswith("LLVM") for name in cases)
    if others:
        found = f"other bytes with {', '.join(others)} than with {first}"
    else:
        found = f"the same bytes with {', '.join(cases)} ({compilers} LLVM{'s' if compilers > 1 else ', no second one to compare'})"
    return Verdict("determinism", not others, found, suspect)

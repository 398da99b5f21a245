"""Measures how well a face's reflectance can be recovered from photographs.

The stages hand folders to each other, on disk::

    capture = unshade.synth("scenes/demo.toml", "capture")
    maps = unshade.solve(capture, out="maps")
    unshade.relight("capture", "maps", "relit")
    scores = unshade.score("capture", "maps", relit="relit")
    scores.value(subject="relit", light="studio", metric="psnr_srgb", scale="global")

Every fault is an exception of :mod:`unshade.errors` whose message says what is wrong, where,
and the fix.

A process that was forked (:mod:`multiprocessing` with ``fork``) can call everything that its parent can.
"""

import os
import sys
from importlib import import_module

# The solver chooses its device itself; without a desktop Mesa's own choice prints an error line.
os.environ.setdefault("NODEVICE_SELECT", "1")


_opencv_threads: list[int] = []


def _before_fork() -> None:
    """Ends OpenCV's threads: a child would wait for ever for the ones it lacks, even to end them."""
    if (cv2 := sys.modules.get("cv2")) is not None:
        _opencv_threads.append(cv2.getNumThreads())
        cv2.setNumThreads(1)


def _after_fork() -> None:
    """Lets OpenCV, in the parent and in the child, start threads anew at its next call."""
    if _opencv_threads:
        sys.modules["cv2"].setNumThreads(_opencv_threads.pop())


if hasattr(os, "register_at_fork"):
    os.register_at_fork(before=_before_fork, after_in_parent=_after_fork, after_in_child=_after_fork)

_HOMES = {
    "Budget": "stages",
    "Fidelity": "stages",
    "Finding": "stages",
    "Capture": "_native",
    "Maps": "maps",
    "STOP": "stopping",
    "Score": "scores",
    "Scores": "scores",
    "Study": "studies",
    "__version__": "_native",
    "budget": "stages",
    "solve": "stages",
    "calibrate": "bookkeeping",
    "exr_channels": "exr",
    "figure": "bookkeeping",
    "read_exr": "exr",
    "score_submission": "bookkeeping",
    "seal": "bookkeeping",
    "site": "bookkeeping",
    "table": "bookkeeping",
    "verify": "bookkeeping",
    "write_exr": "exr",
    "check": "stages",
    "compare": "stages",
    "consistency": "importing.consistency",
    "export": "stages",
    "metric": "own_metrics",
    "import_capture": "importing",
    "import_maps": "importing.maps",
    "relight": "stages",
    "report": "stages",
    "run": "stages",
    "score": "stages",
    "study": "studies",
    "synth": "stages",
}
_MODULES = ("errors", "metrics")

__all__ = sorted([*_HOMES, *_MODULES])


def __getattr__(name: str) -> object:
    """Load on first use: the rendering stages, started as processes, need none of this."""
    if name in _MODULES:
        return import_module(f"unshade.{name}")
    if name in _HOMES:
        return getattr(import_module(f"unshade.{_HOMES[name]}"), name)
    raise AttributeError(f"module 'unshade' has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__

"""Measures how well a face's reflectance can be recovered from photographs.

The stages hand folders to each other, on disk::

    capture = unshade.synth("scenes/demo.toml", "capture")
    maps = unshade.solve(capture, out="maps")
    unshade.relight("capture", "maps", "relit")
    scores = unshade.score("capture", "maps", relit="relit")
    scores.value(subject="relit", light="studio", metric="psnr_srgb", scale="global")

Every fault is an exception of :mod:`unshade.errors`, whose message names what is wrong, where, and the fix.

A process that was forked (:mod:`multiprocessing` with ``fork``) can call everything that its parent can.
"""

import os
import sys
from importlib import import_module

# The solver chooses its device itself; without a desktop Mesa's own choice prints an error line.
os.environ.setdefault("NODEVICE_SELECT", "1")


_opencv_threads: list[int] = []


def _before_fork() -> None:
    """Ends OpenCV's threads: a child would wait for ever for the threads that it lacks, even to end them."""
    if (cv2 := sys.modules.get("cv2")) is not None:
        _opencv_threads.append(cv2.getNumThreads())
        cv2.setNumThreads(1)


def _after_fork() -> None:
    """Lets OpenCV start threads again at its next call, in the parent and in the child."""
    if _opencv_threads:
        sys.modules["cv2"].setNumThreads(_opencv_threads.pop())


if hasattr(os, "register_at_fork"):
    os.register_at_fork(before=_before_fork, after_in_parent=_after_fork, after_in_child=_after_fork)

_NAMES = {
    "_native": "Capture __version__",
    "bookkeeping": "calibrate figure score_submission seal site table verify",
    "exr": "exr_channels read_exr write_exr",
    "head_page": "HeadPage view",
    "importing": "import_capture",
    "importing.consistency": "consistency",
    "importing.maps": "import_maps",
    "maps": "Maps",
    "own_metrics": "metric",
    "scores": "Score Scores",
    "stages": "Budget Fidelity Finding budget check compare export relight report run score solve synth",
    "stopping": "STOP",
    "studies": "Study study",
}
"""The public names, by the module that defines them."""

_HOMES = {name: module for module, names in _NAMES.items() for name in names.split()}
_MODULES = ("errors", "metrics")

__all__ = sorted([*_HOMES, *_MODULES])


def __getattr__(name: str) -> object:
    """Loads a name on its first use, because the processes of the rendering stages need none of them."""
    if name in _MODULES:
        return import_module(f"unshade.{name}")
    if name in _HOMES:
        return getattr(import_module(f"unshade.{_HOMES[name]}"), name)
    raise AttributeError(f"module 'unshade' has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__

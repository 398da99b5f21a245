"""NVIDIA GPUs: whether Mitsuba's ``cuda_ad_rgb`` traces pictures on this machine.

A driver is looked for in this process, which takes no time where there is none. Where there is one, our own tracer
renders a small head on it in a child process.
"""

from __future__ import annotations

import ctypes
import importlib.metadata
import os
import subprocess
import sys
from dataclasses import dataclass

from . import probe_memory

CUDA_VARIANT = "cuda_ad_rgb"

FIX = "install an NVIDIA driver that Mitsuba supports, or leave variant out"

_PROBE = """
from unshade.render import llvm
llvm.activate(llvm.Choice("cuda_ad_rgb", None))
from unshade.render.passes import render_layers
from unshade.render.physics import noise, specimen
lit = specimen.head().lit(noise.lights()["studio"])
sensor = specimen.camera(24, 20).sensor(4)
assert render_layers(lit, sensor, samples=4, depth=3, seed=1).total.sum() > 0
print("traces")
"""


@dataclass(frozen=True)
class Gpu:
    """Whether there is a device with a driver; ``reason`` says why it traces nothing, and is empty if it does."""

    found: bool
    reason: str = ""

    @property
    def ok(self) -> bool:
        return self.found and not self.reason


def driver() -> int | None:
    """The version of CUDA that the driver of a device has; None without a device."""
    try:
        cuda = ctypes.CDLL("libcuda.so.1")
    except OSError:
        return None
    devices, version = ctypes.c_int(), ctypes.c_int()
    calls = (
        cuda.cuInit(0),
        cuda.cuDeviceGetCount(ctypes.byref(devices)),
        cuda.cuDriverGetVersion(ctypes.byref(version)),
    )
    return version.value if not any(calls) and devices.value else None


def probe() -> Gpu:
    """The GPU of this machine; that it traces is remembered."""
    version = driver()
    if version is None:
        return Gpu(False, "no NVIDIA device with a driver (libcuda.so.1)")
    drjit, mitsuba = (importlib.metadata.version(name) for name in ("drjit", "mitsuba"))
    key = f"cuda {version} {os.environ.get('CUDA_VISIBLE_DEVICES', '')} drjit={drjit} mitsuba={mitsuba}"
    if probe_memory.recall().get(key) == "traces":
        return Gpu(True)
    reason = _trace()
    if not reason:
        probe_memory.remember(key, "traces")
    return Gpu(True, reason)


def _trace() -> str:
    """Why a child traces nothing; empty if it does."""
    try:
        child = subprocess.run(
            [sys.executable, "-c", _PROBE], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300
        )
    except subprocess.TimeoutExpired:
        return "no picture within 300 s"
    if child.returncode == 0 and "traces" in child.stdout:
        return ""
    lines = child.stderr.strip().splitlines()
    return f"exit status {child.returncode}: {lines[-1].strip() if lines else 'no message'}"

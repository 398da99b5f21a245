"""Pictures of one scene, rendered in child processes: variant, LLVM and threads of a process
are set once. The program part is ``python -m unshade.render.physics.child``."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import asdict, dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from ..layers import Layers
from ..llvm import LLVM_VARIANT

NAMES = ("dome", "studio")
"""Lights of the pictures: one that is met by chance, one that is sampled."""


class ChildError(RuntimeError):
    """A child process ended without its pictures."""


@dataclass(frozen=True)
class Setting:
    """How a child renders; ``threads`` 0 is as many as there are cores, ``library`` an LLVM to take."""

    variant: str = LLVM_VARIANT
    threads: int = 0
    library: str | None = None
    width: int = 24
    height: int = 20
    samples: int = 52
    depth: int = 3
    seed: int = 1


def render_in_child(setting: Setting) -> dict[str, Layers]:
    """One picture for each of `NAMES`. Raises `ChildError` with the child's last line."""
    return collect(start(setting))


@dataclass(frozen=True)
class RunningChild:
    process: subprocess.Popen
    folder: TemporaryDirectory


def start(setting: Setting) -> RunningChild:
    """Starts a child, so that several can render side by side; `collect` waits for it."""
    folder = TemporaryDirectory()
    environment = dict(os.environ)
    # The package may lie in a source tree that only this process's path knows of.
    root = str(Path(__file__).resolve().parents[3])
    environment["PYTHONPATH"] = os.pathsep.join([root, *filter(None, [environment.get("PYTHONPATH")])])
    if setting.library:
        environment["DRJIT_LIBLLVM_PATH"] = setting.library
    process = subprocess.Popen(
        [sys.executable, "-m", "unshade.render.physics.child", json.dumps(asdict(setting)), folder.name],
        env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
    )  # fmt: skip
    return RunningChild(process, folder)


def collect(running: RunningChild) -> dict[str, Layers]:
    with running.folder as folder:
        words, _ = running.process.communicate()
        if running.process.returncode != 0:
            last = (words.strip().splitlines() or ["no message"])[-1]
            raise ChildError(f"exit status {running.process.returncode}: {last}")
        pictures = {}
        for name in NAMES:
            with np.load(Path(folder) / f"{name}.npz") as arrays:
                pictures[name] = Layers(arrays["diffuse"], arrays["specular"], arrays["variance"])
        return pictures


def main(setting: Setting, folder: Path) -> None:
    """Renders in this process, which must be fresh."""
    from .. import llvm

    llvm.activate(llvm.choose(setting.variant))
    if setting.threads and setting.variant == LLVM_VARIANT:
        import drjit as dr

        dr.set_thread_count(setting.threads)
    from ..passes import render_layers
    from . import specimen
    from .noise import lights

    head, camera = specimen.head(), specimen.camera(setting.width, setting.height)
    for name in NAMES:
        lit = head.lit(lights()[name])
        sensor = camera.sensor(setting.samples)
        layers = render_layers(lit, sensor, samples=setting.samples, depth=setting.depth, seed=setting.seed)
        np.savez(folder / f"{name}.npz", diffuse=layers.diffuse, specular=layers.specular, variance=layers.variance)


if __name__ == "__main__":
    main(Setting(**json.loads(sys.argv[1])), Path(sys.argv[2]))

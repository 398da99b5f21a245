"""What `test_python_processes.py` does in a child, which `spawn` imports by this name."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import numpy as np

import unshade
from conftest import QUICK


def calls(run: str, case: str, out: str) -> tuple[float | None, ...]:
    """One call of every kind that has threads: a capture, metrics, maps, scores, a solve that is stopped."""
    capture = unshade.Capture(Path(run) / "captures" / case)
    picture = capture.image(capture.withheld[0])
    seen = np.isfinite(capture.gbuffer(capture.train[0])["uvs"]).mean()
    psnr = unshade.metrics.evaluate(["psnr_srgb", "ssim"], 0.9 * picture, picture)["psnr_srgb"]
    truth = capture.truth()
    truth.write(out)
    scores = unshade.score(capture, unshade.Maps(diffuse_albedo=truth.diffuse_albedo))
    losses: list[float] = []

    def first_step(_stage: str, _iteration: int, _total: int, loss: float) -> None:
        losses.append(loss)
        raise LookupError

    with suppress(LookupError):
        unshade.solve(capture, config=QUICK, progress=first_step, backend="cpu")
    return float(seen), psnr, float(len(scores)), *losses


def child(run: str, case: str, out: str, queue) -> None:
    queue.put(calls(run, case, out))

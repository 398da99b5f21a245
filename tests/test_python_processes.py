"""A process that `multiprocessing` starts can call what its parent has called."""

from __future__ import annotations

import multiprocessing
import os
from pathlib import Path

import cv2
import forked
import numpy as np
import pytest

from conftest import CASE


def warped() -> tuple[int, ...]:
    """A call for which OpenCV starts its threads."""
    at = np.ones((2000, 2000), np.float32)
    return cv2.remap(at, at, at, cv2.INTER_LINEAR).shape


@pytest.fixture(scope="module")
def by_the_parent(tiny_run: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[float | None, ...]:
    warped()
    return forked.calls(str(tiny_run), CASE, str(tmp_path_factory.mktemp("parent") / "maps"))


@pytest.mark.parametrize(
    "method", [m for m in ("fork", "forkserver", "spawn") if m in multiprocessing.get_all_start_methods()]
)
def test_a_child_gets_what_its_parent_got(method: str, by_the_parent, tiny_run: Path, tmp_path: Path) -> None:
    context = multiprocessing.get_context(method)
    queue = context.Queue()
    arguments = (str(tiny_run), CASE, str(tmp_path / "maps"), queue)
    child = context.Process(target=forked.child, args=arguments, daemon=True)
    child.start()
    try:
        # A guard alone: a child that hangs fails here.
        assert queue.get(timeout=300) == by_the_parent
        child.join(300)
        assert child.exitcode == 0
    finally:
        child.kill()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork here")
def test_opencv_works_in_a_forked_child(by_the_parent) -> None:
    with multiprocessing.get_context("fork").Pool(1) as pool:
        assert pool.apply_async(warped).get(timeout=120) == (2000, 2000)

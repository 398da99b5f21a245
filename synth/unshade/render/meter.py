"""Progress in camera samples, since pictures differ in what they cost."""

from __future__ import annotations

import resource
import sys
import time
from collections.abc import Callable

Progress = Callable[[int, int, str], None]
"""Samples done, samples in all, and what is done next."""


class Meter:
    """Counts the samples of ``pictures`` pictures of equal size, and the time that tracing them takes."""

    def __init__(self, progress: Progress, pictures: int, samples_each: int) -> None:
        self._progress = progress
        self._each = samples_each
        self._total = pictures * samples_each
        self._done = 0
        self._start = time.monotonic()
        self._traced = 0
        self._tracing = 0.0

    def note(self, what: str) -> None:
        """Something without samples begins."""
        self._progress(self._done, self._total, what)

    def finish(self, what: str) -> None:
        """All is done: states samples per second, those of tracing alone, and the largest memory."""
        rates = ""
        if self._traced:
            whole, alone = (self._traced / 1e6 / seconds for seconds in (time.monotonic() - self._start, self._tracing))
            rates = f", {whole:.2f} million samples/s, tracing alone {alone:.2f}"
        self._progress(self._total, self._total, f"{what}{rates}, at most {_peak_gigabytes():.1f} GB of memory")

    def begin(self, what: str) -> Callable[[int, int], None]:
        """A picture begins; its renderer calls the result with its own samples done and in all."""
        start = self._done
        self._done += self._each
        began: float | None = None

        def say(count: int) -> None:
            self._progress(count, self._total, f"{what}, {count / 1e6:.0f} of {self._total / 1e6:.0f} million samples")

        def within(done: int, total: int) -> None:
            nonlocal began
            say(start + self._each * done // total)
            if done == 0:
                began = time.monotonic()
            elif done == total and began is not None:
                self._traced += self._each
                self._tracing += time.monotonic() - began
                began = None

        say(start)
        return within


def _peak_gigabytes() -> float:
    """Largest resident memory of this process; macOS counts bytes, Linux kibibytes."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / 1e9 if sys.platform == "darwin" else peak * 1024 / 1e9

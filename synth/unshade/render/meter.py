"""Progress in camera samples, since pictures differ in what they cost."""

from __future__ import annotations

from collections.abc import Callable

Progress = Callable[[int, int, str], None]
"""Samples done, samples in all, and what is done next."""


class Meter:
    """Counts the samples of ``pictures`` pictures of equal size."""

    def __init__(self, progress: Progress, pictures: int, samples_each: int) -> None:
        self._progress = progress
        self._each = samples_each
        self._total = pictures * samples_each
        self._done = 0

    def note(self, what: str) -> None:
        """Something without samples begins, or all is done."""
        self._progress(self._done, self._total, what)

    def begin(self, what: str) -> Callable[[int, int], None]:
        """A picture begins; its renderer calls the result with its own samples done and in all."""
        start = self._done
        self._done += self._each

        def within(done: int, total: int) -> None:
            count = start + self._each * done // total
            self._progress(count, self._total, f"{what}, {count / 1e6:.0f} of {self._total / 1e6:.0f} million samples")

        within(0, 1)
        return within

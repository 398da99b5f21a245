"""Exceptions, named for what went wrong; Rust and Python raise the same classes.

Each message is one line: what is wrong, where, and the fix. ``exit_code`` is the exit
status of the child process for it (see :mod:`unshade.stage`).
"""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager


class UnshadeError(Exception):
    """Base of all exceptions of the package: a fault that a user can meet and fix."""

    exit_code = 2


class SceneError(UnshadeError):
    """A scene file describes something that cannot be rendered."""

    def __init__(self, message: str, *, key: str | None = None) -> None:
        """``key`` is the one that is wrong, in the table that `in_table` adds."""
        super().__init__(message)
        self.key = key
        self.table = ""

    @staticmethod
    @contextmanager
    def in_table(name: str) -> Generator[None]:
        """Errors of a scene that are raised here are about its table ``name``."""
        try:
            yield
        except SceneError as error:
            error.table = name
            raise


class CaptureError(UnshadeError):
    """A capture folder is missing, incomplete, or of another renderer."""


class MapsError(UnshadeError):
    """Maps cannot be read, made or rendered."""


class PictureError(UnshadeError):
    """A picture file cannot be read, or holds values that cannot be radiance."""


class VariantError(UnshadeError):
    """The renderer's variant that was asked for does not work on this machine."""


class StorageError(UnshadeError):
    """A file or folder cannot be written."""


class RendererError(UnshadeError):
    """The renderer's process cannot be started, or died without saying why."""


class ClusterError(UnshadeError):
    """A cluster's scheduler, store or workers cannot be used."""


class Stopped(UnshadeError):
    """A stage was stopped by its ``progress``, which returned `unshade.STOP`; the same call resumes there."""

    exit_code = 3


class ConfigError(UnshadeError):
    """A solver's configuration has an unknown key or a value out of range."""


class BackendError(UnshadeError):
    """A device that cannot compute here was asked for."""


class SolveError(UnshadeError):
    """A capture cannot be solved, by our solver or by a suite's program."""


class MetricError(UnshadeError):
    """Arrays cannot be compared: shape, type, a number that is none, or an argument that is missing."""


class ScoreError(UnshadeError):
    """Maps or pictures cannot be scored against the truth."""


class ReportError(UnshadeError):
    """A run folder cannot be shown."""


class CompareError(UnshadeError):
    """A run cannot be compared with a baseline."""


class ExportError(UnshadeError):
    """An asset cannot be written, or the program that writes or renders it is missing."""

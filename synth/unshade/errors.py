"""What can go wrong, by name; Rust and Python raise the same classes.

Each message is one line: what is wrong, where, and the mend. ``exit_code`` is what
the child process returns for it (see :mod:`unshade.stage`).
"""

from __future__ import annotations


class UnshadeError(Exception):
    """What a user can meet and mend."""

    exit_code = 2


class SceneError(UnshadeError):
    """A scene file says something that cannot be rendered."""


class CaptureError(UnshadeError):
    """A capture folder is missing, incomplete, or of another renderer."""


class MapsError(UnshadeError):
    """A maps folder cannot be rendered."""


class PictureError(UnshadeError):
    """A picture file cannot be read, or holds values that are no radiance."""


class VariantError(UnshadeError):
    """The renderer's variant that was asked for does not work on this machine."""


class StorageError(UnshadeError):
    """A file or folder cannot be written."""


class ConfigError(UnshadeError):
    """A solver's configuration has an unknown key or a value out of range."""


class BackendError(UnshadeError):
    """A device that cannot compute here was asked for."""


class SolveError(UnshadeError):
    """A capture cannot be solved."""


class MetricError(UnshadeError):
    """Two pictures cannot be compared."""


class ScoreError(UnshadeError):
    """Maps or pictures cannot be scored against the truth."""


class ReportError(UnshadeError):
    """A run folder cannot be shown."""


class CompareError(UnshadeError):
    """A run cannot be compared with a baseline."""

"""`STOP`, which a ``progress`` callback returns to stop its stage."""

from __future__ import annotations

import enum
from typing import Final


class Stop(enum.Enum):
    """The type of `STOP`."""

    STOP = "unshade.STOP"

    def __repr__(self) -> str:
        return self.value


STOP: Final = Stop.STOP
"""Returned by a ``progress`` callback, it stops the stage; every other value, False too, continues it."""

"""Region ids, as a face parser gives them."""

from __future__ import annotations

import enum


class Label(enum.IntEnum):
    NONE = 0
    SKIN = 1
    LIPS = 2
    BROW = 3
    EYELID = 4
    EAR = 5
    NOSE = 6
    SCALP = 7

"""The mesh as photogrammetry gives it: too smooth, with bumps of its own, and decimated."""

from .degrade import degrade
from .deviation import deviation

__all__ = ["degrade", "deviation"]

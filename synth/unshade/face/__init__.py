"""A face to render: shape, chart, skin and eyes of one identity, from a specification alone."""

from .build import Face, build_face
from .geometry import Chart, Part
from .labels import Label
from .paint import Maps
from .spec import FaceError, FaceSpec

__all__ = ["Chart", "Face", "FaceError", "FaceSpec", "Label", "Maps", "Part", "build_face"]

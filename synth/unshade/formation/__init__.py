"""Image formation: from the radiance of a perfect pinhole to the pictures, poses and labels that solvers get.

Training views alone are degraded. Withheld views belong to the evaluation: their cameras,
masks and pictures stay those of perfect pinholes, as everything under ``truth/``.
"""

from .face_parser import stated_labels
from .gains import view_gain
from .lens import Lens, camera_lens, needs_own_rendering
from .poses import camera_model, capture_camera, stated_frame
from .sensor import expose

__all__ = [
    "Lens",
    "camera_lens",
    "camera_model",
    "capture_camera",
    "expose",
    "needs_own_rendering",
    "stated_frame",
    "stated_labels",
    "view_gain",
]

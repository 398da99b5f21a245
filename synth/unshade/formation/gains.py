"""Automatic exposure and white balance: a factor of each view that no file of the capture states."""

from __future__ import annotations

import numpy as np

from ..camera.camera import Camera
from ..scene_file import Scene
from .seeds import generator


def view_gain(camera: Camera, scene: Scene) -> np.ndarray:
    """The factor of the light on the sensor in a view, [3] (R, G, B); 1 in withheld views, and by default."""
    formation = scene.formation
    if not camera.train or not formation.hides_exposure:
        return np.ones(3)
    all_, red, blue = generator("gain", scene, camera).standard_normal(3)
    stops = formation.gain_stops * all_ + formation.white_balance_stops * np.array([red, 0, blue])
    return 2.0**stops

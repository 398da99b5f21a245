"""The real cameras of a capture, and their entries in ``transforms.json``."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from ..camera.camera import Camera
from ..camera.distortion import Distortion
from ..face import Chart
from ..scene_file import Formation, Scene
from .seeds import generator

_PROBE = 1e-5
"""Radians and metres by which a pose is moved to see how far the picture moves."""


def capture_camera(camera: Camera, scene: Scene) -> Camera:
    """The camera with its real lens. Raises `SceneError` where the lens folds the picture."""
    terms = scene.formation.lens_distortion
    return camera if terms is None or not camera.train else replace(camera, distortion=Distortion(*terms))


def camera_model(scene: Scene) -> str:
    """The ``camera_model`` of ``transforms.json``."""
    return "PINHOLE" if scene.formation.lens_distortion is None else "OPENCV"


def stated_frame(camera: Camera, scene: Scene, mesh: Chart) -> dict:
    """The camera's entry in ``transforms.json``: its real lens, and for training views a pose
    as inexact as calibration leaves it. ``mesh`` is what the poses were fitted to."""
    real = capture_camera(camera, scene)
    error = _pose_error(real, scene, mesh) if camera.train else None
    frame = real.frame() if error is None else replace(real, matrix=_moved(real.matrix, error)).frame()
    if scene.labels.omit:
        del frame["label_path"]
    return frame


def _pose_error(camera: Camera, scene: Scene, mesh: Chart) -> np.ndarray | None:
    """Turn (radians) and shift (m) about and along the camera's axes, [6]."""
    formation: Formation = scene.formation
    draw = generator("pose", scene, camera).standard_normal(6)
    if formation.pose_noise_pixels:
        # Each of the six freedoms moves the mesh by the same share of the noise.
        return draw * formation.pose_noise_pixels / math.sqrt(6) / _pixels_per_unit(camera, mesh)
    sigma = np.repeat([math.radians(formation.pose_noise_degrees), formation.pose_noise_mm / 1000], 3)
    return draw * sigma if sigma.any() else None


def _pixels_per_unit(camera: Camera, mesh: Chart) -> np.ndarray:
    """How far the mesh moves in the picture per radian and metre: rms over its vertices and
    the two axes, [6]."""
    points = mesh.vertices.astype(float)
    still = camera.project(points)
    moved = [replace(camera, matrix=_moved(camera.matrix, _PROBE * unit)).project(points) for unit in np.eye(6)]
    return np.array([np.sqrt(np.mean((after - still) ** 2)) / _PROBE for after in moved])


def _moved(matrix: np.ndarray, error: np.ndarray) -> np.ndarray:
    step = np.eye(4)
    step[:3, :3] = Rotation.from_rotvec(error[:3]).as_matrix()
    step[:3, 3] = error[3:]
    return matrix @ step

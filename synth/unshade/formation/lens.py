"""The camera's optics: from a position on the film to a ray, through a real lens in motion."""

from __future__ import annotations

import math
from dataclasses import dataclass

import drjit as dr
import mitsuba as mi
import numpy as np

from ..camera.camera import Camera
from ..camera.distortion import Distortion
from ..scene_file import Formation, Scene
from .seeds import generator

EYES = np.array([0.0, 0.0, 0.08])
"""Between the corneas of a head at the origin (m): where a portrait is focused."""


@dataclass(frozen=True)
class Lens:
    """A thin lens on a camera that turns while the shutter is open.

    ``turn_axis`` is a unit vector across the optical axis in camera coordinates; the camera
    turns about it at constant speed by ``turn`` radians in all, and has its stated pose
    halfway. Radius and focus distance are metres.
    """

    camera: Camera
    aperture_radius: float = 0.0
    focus_distance: float = 1.0
    turn: float = 0.0
    turn_axis: tuple[float, float] = (0.0, 1.0)

    def ray(self, column, row, sampler):
        """World ray from a film position in pixels (x right, y down); draws from ``sampler``
        what aperture and exposure time need."""
        camera, plain = self.camera, opaque
        x = (column - plain(camera.width / 2)) / plain(camera.focal)
        y = (row - plain(camera.height / 2)) / plain(camera.focal)
        if camera.distortion is not None:
            terms = camera.distortion
            x, y = Distortion(*map(plain, (terms.k1, terms.k2, terms.p1, terms.p2))).undistort(x, y)
        origin, towards = mi.Vector3f(0), mi.Vector3f(x, -y, -1)
        if self.aperture_radius > 0:
            disk = mi.warp.square_to_uniform_disk_concentric(sampler.next_2d()) * plain(self.aperture_radius)
            origin = mi.Vector3f(disk.x, disk.y, 0)
            towards = towards * plain(self.focus_distance) - origin
        if self.turn > 0:
            # Stratified over the samples of a pixel, as the sampler's numbers are.
            angle = (sampler.next_1d() - 0.5) * plain(self.turn)
            origin, towards = self._rotated(origin, angle), self._rotated(towards, angle)
        rotation = [mi.Vector3f(*map(plain, axis)) for axis in camera.matrix[:3, :3].T]
        origin, towards = (v.x * rotation[0] + v.y * rotation[1] + v.z * rotation[2] for v in (origin, towards))
        position = mi.Point3f(*map(plain, camera.position))
        return mi.Ray3f(position + origin, dr.normalize(towards))

    def _rotated(self, vector, angle):
        """Rodrigues' rotation about the turn axis."""
        axis = mi.Vector3f(*map(opaque, self.turn_axis), 0)
        cosine, sine = dr.cos(angle), dr.sin(angle)
        return vector * cosine + dr.cross(axis, vector) * sine + axis * (dr.dot(axis, vector) * (1 - cosine))


def opaque(value: float):
    """A number that the compiler takes for unknown, so that all cameras share one kernel."""
    return dr.opaque(mi.Float, float(value)) if dr.is_jit_v(mi.Float) else float(value)


def needs_own_rendering(formation: Formation) -> bool:
    """Whether training pictures follow other rays than the pinhole's, so that the layers of
    the truth are not theirs."""
    return (
        formation.lens_distortion is not None
        or formation.aperture_radius_mm > 0
        or formation.motion_pixels > 0
        or formation.motion_degrees > 0
    )


def camera_lens(camera: Camera, scene: Scene) -> Lens | None:
    """The optics of a camera (as `capture_camera` gives it); ``None`` for a pinhole at rest."""
    formation = scene.formation
    if not camera.train or not needs_own_rendering(formation):
        return None
    turn = math.radians(formation.motion_degrees) + 2 * math.atan(formation.motion_pixels / 2 / camera.focal)
    direction = formation.motion_direction_degrees
    if direction is None:
        direction = generator("motion", scene, camera).uniform(0, 360)
    streak = math.radians(direction)
    focus = formation.focus_distance_metres
    if focus is None:
        focus = float((camera.position - EYES) @ camera.matrix[:3, 2])
    return Lens(
        camera,
        aperture_radius=formation.aperture_radius_mm / 1000,
        focus_distance=focus,
        turn=turn,
        # The picture moves across the axis that the camera turns about.
        turn_axis=(-math.sin(streak), math.cos(streak)),
    )

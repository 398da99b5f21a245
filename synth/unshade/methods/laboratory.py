"""Photographs of a capture's face, from its training views, in light of a method's own choice."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ..camera.camera import Camera
from ..files.array_store import ArrayStore
from ..heads import build_head
from ..render.layers import Layers
from ..render.lights.point import Ball
from ..render.meter import Meter
from ..render.passes import seed_of
from ..render.rigs import cameras
from ..render.scene import ChartMaps
from ..render.shots import Shots
from ..scene_file import Light, Scene

_FLASH_RADIUS = 0.004
"""Metres: an LED beside the lens of a telephone."""


class Laboratory:
    """Renders what a controlled set-up would photograph: perfect pinholes, and the exact split into layers where a
    set-up has polarisers. The truth stays in here."""

    def __init__(self, scene: Scene, progress: Callable[[int, int, str], None]) -> None:
        self._scene = scene
        self._progress = progress
        render = scene.render
        self._cameras = [camera for camera in cameras(scene.rig, render.width, render.height) if camera.train]
        self._face = build_head(scene.face)

    def in_lights(self, lights: list[Light], samples: int) -> dict[str, list[Layers]]:
        """The training views, in the capture's order, in each of the lights, with ``samples`` a pixel."""
        shots = self._shots(samples)
        taken = self._take(shots, [(light, camera) for light in lights for camera in self._cameras], samples)
        views = len(self._cameras)
        return {light.name: taken[i * views : (i + 1) * views] for i, light in enumerate(lights)}

    def with_flash(self, intensity: float, samples: int) -> list[np.ndarray]:
        """The training views (H, W, 3), each lit by a white flash at its own camera, of ``intensity``: radiance times
        projected area, m2."""
        shots = self._shots(samples)
        jobs = []
        for camera in self._cameras:
            light = Light(f"flash of {camera.name}", "point")
            shots.set_light(light.name, Ball(camera.position, _FLASH_RADIUS, intensity / (np.pi * _FLASH_RADIUS**2)))
            jobs.append((light, camera))
        return [layers.total for layers in self._take(shots, jobs, samples)]

    def _shots(self, samples: int) -> Shots:
        render = replace(self._scene.render, samples=samples)
        return Shots(self._face, ChartMaps.truth(self._face), render, ArrayStore.of_user())

    def _take(self, shots: Shots, jobs: list[tuple[Light, Camera]], samples: int) -> list[Layers]:
        render = self._scene.render
        meter = Meter(self._progress, len(jobs), render.width * render.height * samples)
        taken = []
        for light, camera in jobs:
            report = meter.begin(f"view {camera.name} in {light.name}")
            seed = seed_of("laboratory", render.seed, light.name, camera.name)
            taken.append(shots.layers(light, camera, seed, render.seed, report))
        return taken

"""Pictures of one head in any light from any camera, each rendered once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property

import numpy as np

from ..camera.camera import Camera
from ..face import Face
from ..files.array_store import ArrayStore
from ..files.content_key import content_key
from ..fingerprint import fingerprint
from ..formation import Lens
from ..scene_file import Light, Render
from . import lights
from .denoise import denoised
from .layers import Layers
from .lights.found import CellSphere
from .scene import ChartMaps, HeadScene, LitHead
from .tiers import render_tier


class Shots:
    """``face`` with ``maps`` on its chart. Nothing is loaded into the renderer before the
    first picture that the store does not hold."""

    def __init__(self, face: Face, maps: ChartMaps, render: Render, store: ArrayStore) -> None:
        self._face = face
        self.maps = maps
        self.render = render
        self._store = store
        self._models: dict[str, lights.AnyLight | CellSphere] = {}
        self._lit: dict[Light, LitHead] = {}
        self._shapes_key = content_key(fingerprint(__name__), face.surface, face.parts, render)
        self._maps_key = content_key(maps)

    @cached_property
    def head(self) -> HeadScene:
        return HeadScene(self._face.surface, self._face.parts, self.maps, self.render.material)

    def light(self, light: Light) -> lights.AnyLight | CellSphere:
        """The light, exposed for this face."""
        if light.to_head is not None:
            return lights.in_head_axes(self.light(replace(light, to_head=None)), light)
        if light.name not in self._models:
            chart = self._face.chart
            self._models[light.name] = lights.exposed(light, chart.vertices, chart.normals)
        return self._models[light.name]

    def set_light(self, name: str, model: lights.AnyLight | CellSphere) -> None:
        """Lights called ``name`` are ``model``, with the radiance that it has."""
        self._models[name] = model

    def set_diffuse_albedo(self, albedo: np.ndarray) -> None:
        """Replaces the diffuse albedo [N, N, 3] for the pictures to come."""
        self.maps = replace(self.maps, diffuse_albedo=albedo)
        self._maps_key = content_key(self.maps)
        if "head" in self.__dict__:
            self.head.set_diffuse_albedo(albedo)

    def layers(
        self,
        light: Light,
        camera: Camera,
        seed: int,
        shared_seed: int,
        report: Callable[[int, int], None],
        lens: Lens | None = None,
    ) -> Layers:
        """One picture, through ``lens`` if there is one.

        ``seed`` and ``shared_seed`` are those of `tiers.render_tier`; ``report`` gets the samples
        done and in all.
        """
        key = content_key(self._shapes_key, self._maps_key, self.light(light), camera, lens, seed, shared_seed)
        kept = self._store.get(key, Layers)
        if kept is None:
            kept = self._render_anew(light, camera, seed, shared_seed, report, lens)
            self._store.put(key, kept)
        report(1, 1)
        return kept

    def _render_anew(self, light, camera, seed, shared_seed, report, lens) -> Layers:
        if light not in self._lit:
            # One at a time: each has an acceleration structure of its own, gigabytes for relief as geometry.
            self._lit.clear()
            self._lit[light] = self.head.lit(self.light(light))
        sensor = camera.sensor(self.render.samples)
        layers = render_tier(
            self.head, self._lit[light], sensor, self.render, seed, report, lens=lens, shared_seed=shared_seed,
        )  # fmt: skip
        return denoised(layers, self.head, sensor, lens) if self.render.denoise == "oidn" else layers

"""Renders a scene into a capture folder: pictures, masks, labels, mesh, and the truth."""

from __future__ import annotations

import importlib.metadata
import json
from dataclasses import replace
from pathlib import Path

import drjit as dr
import mitsuba as mi
import numpy as np

from ..face import Face, build_face
from ..fingerprint import fingerprint
from ..scene_file import Light, Scene
from .folder import ResumableFolder, content_hash
from .layers import Layers
from .llvm import Choice
from .mesh_file import obj_text
from .meter import Meter, Progress
from .passes import seed_of
from .picture_store import PictureStore
from .pictures import read_gray, read_rgb, write_exr, write_gray, write_text
from .probes import TexelVisibility, nearest_texels, view_through_centres
from .camera import Camera
from .rigs import cameras
from .scene import ChartMaps
from .scene_text import scene_text, with_own_pictures
from .shots import Shots

_ENVIRONMENTS = Path("lights")
"""Where the environment maps of a capture lie, seen from its ``truth/scene.toml``."""


def synthesise(scene: Scene, out: Path, choice: Choice, progress: Progress) -> None:
    """Writes the capture of ``scene`` to ``out``.

    An interrupted call leaves ``out.partial`` behind; the next one with the same scene and
    renderer takes it up and ends with the same bytes.
    """
    Capture(scene, out, choice, progress).write()


class Capture:
    """One capture in the making."""

    def __init__(self, scene: Scene, out: Path, choice: Choice, progress: Progress) -> None:
        self.scene = scene
        self.stated = replace(
            with_own_pictures(scene, _ENVIRONMENTS),
            render=replace(scene.render, variant=choice.variant),
            versions=versions(choice),
        )
        environments = [content_hash(Path(light.path)) for light in scene.lights if light.path]
        self.folder = ResumableFolder(out, f"{scene_text(self.stated)}\n{fingerprint()}\n{environments}")
        self.path = self.folder.path
        self.truth = self.path / "truth"
        self.cameras = cameras(scene.rig, scene.render.width, scene.render.height)
        self.tests = [camera for camera in self.cameras if not camera.train]
        render = scene.render
        pictures = len(self.cameras) + len(self.tests) * len(scene.relight)
        self.meter = Meter(progress, pictures, render.width * render.height * render.samples)

    def write(self) -> None:
        self.meter.note("face")
        face = build_face(self.scene.face)
        shots = Shots(face, ChartMaps.truth(face), self.stated.render, PictureStore.of_user())
        self._write_mesh_and_maps(face)
        self._write_views(face, shots)
        for light in self.scene.relight:
            self._write_relit(shots, light)
        self.meter.note("visibility")
        self._write_coverage(face, shots)
        write_text(self.path / "transforms.json", transforms_text(self.cameras))
        write_text(self.truth / "scene.toml", scene_text(self.stated))
        self.folder.commit()
        self.meter.note("capture")

    def _write_mesh_and_maps(self, face: Face) -> None:
        maps = face.maps
        write_text(self.path / "mesh.obj", obj_text(face.chart))
        write_exr(self.truth / "diffuse_albedo.exr", {"": maps.diffuse_albedo})
        write_exr(self.truth / "specular_albedo.exr", {"Y": maps.specular_albedo})
        write_exr(self.truth / "diffuse_normal.exr", {"": maps.diffuse_normal})
        write_exr(self.truth / "specular_normal.exr", {"": maps.specular_normal})
        write_gray(self.truth / "labels.png", np.where(maps.inside, maps.labels, 0).astype(np.uint8))
        for light in self.scene.lights:
            if light.path:
                picture = read_rgb(light.path).clip(0)
                write_exr(self.truth / _ENVIRONMENTS / f"{light.name}.exr", {"": picture})

    def _write_views(self, face: Face, shots: Shots) -> None:
        own = self.scene.light
        write_exr(self.truth / "light.exr", {"": shots.light(own).latlong()})
        for camera in self.cameras:
            name = camera.name
            report = self.meter.begin(f"view {name}")
            image = self.path / "images" / f"{name}.exr"
            if image.exists():
                continue
            centres = view_through_centres(shots.head, camera)
            labels = np.where(centres.mask, nearest_texels(face.maps.labels, centres.uv), 0)
            write_gray(self.path / "masks" / f"{name}.png", np.where(centres.mask, 255, 0).astype(np.uint8))
            write_gray(self.path / "labels" / f"{name}.png", labels.astype(np.uint8))
            layers = shots.layers(own, camera, self._seed(own, camera), report)
            write_exr(self.truth / "layers" / f"{name}.exr", layers.channels())
            if not camera.train:
                self._write_true(own, camera, layers)
            # Last, since it marks the view as finished.
            write_exr(image, {"": layers.total})

    def _write_relit(self, shots: Shots, light: Light) -> None:
        for camera in self.tests:
            report = self.meter.begin(f"view {camera.name} in {light.name}")
            if not self._relit_path(light, camera).exists():
                self._write_true(light, camera, shots.layers(light, camera, self._seed(light, camera), report))

    def _write_true(self, light: Light, camera: Camera, layers: Layers) -> None:
        write_exr(self._relit_path(light, camera), {"": layers.total, **layers.channels()})

    def _seed(self, light: Light, camera: Camera) -> int:
        return seed_of("truth", self.scene.render.seed, light.name, camera.name)

    def _relit_path(self, light: Light, camera: Camera) -> Path:
        return self.truth / "relit" / light.name / f"{camera.name}.exr"

    def _write_coverage(self, face: Face, shots: Shots) -> None:
        visibility = TexelVisibility(shots.head, face.chart, self.scene.face.texture_size)
        views = sum(
            visibility.seen_by(camera, read_gray(self.path / "masks" / f"{camera.name}.png") > 0).astype(int)
            for camera in self.cameras
            if camera.train
        )
        write_gray(self.truth / "views.png", views.clip(0, 255).astype(np.uint8))
        write_gray(self.truth / "coverage.png", np.where(views > 0, 255, 0).astype(np.uint8))


def transforms_text(rig: list[Camera]) -> str:
    """``transforms.json`` in the manner of nerfstudio."""
    frames = [camera.frame() for camera in rig]
    document = {
        "camera_model": "PINHOLE",
        "mesh": "mesh.obj",
        "frames": frames,
        "train_filenames": [f["file_path"] for f, c in zip(frames, rig) if c.train],
        "test_filenames": [f["file_path"] for f, c in zip(frames, rig) if not c.train],
    }
    return json.dumps(document, indent=1) + "\n"


def versions(choice: Choice) -> dict[str, str]:
    """The ``[versions]`` of a capture's scene."""
    try:
        unshade = importlib.metadata.version("unshade")
    except importlib.metadata.PackageNotFoundError:
        unshade = "source tree"
    known = {
        "unshade": unshade,
        "mitsuba": mi.__version__,
        "drjit": dr.__version__,
        "variant": choice.variant,
    }
    return known | ({"llvm": choice.llvm.version} if choice.llvm else {})

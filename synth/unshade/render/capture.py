"""Renders a scene into a capture folder: pictures, masks, labels, mesh, and the truth.

The inputs of solvers (images, masks, labels, mesh, cameras) go through the scene's image
formation; everything under ``truth/`` is that of the perfect face and perfect pinholes.
"""

from __future__ import annotations

import importlib.metadata
from dataclasses import replace
from pathlib import Path

import drjit as dr
import mitsuba as mi
import numpy as np

from .. import formation
from ..camera.camera import Camera
from ..captured_mesh import degrade, deviation
from ..face import Chart, Face, FaceSpec, Label
from ..face.ita import face_ita
from ..files.array_store import ArrayStore
from ..files.folder import ResumableFolder, content_hash
from ..files.obj_text import obj_text
from ..files.pictures import ROUGHNESS_CHANNELS, read_gray, read_rgb, write_exr, write_gray, write_json, write_text
from ..fingerprint import fingerprint
from ..heads import build_head
from ..own_head import HeadFiles
from ..own_head.keep import keep
from ..scene_file import CapturedMesh, Light, Scene
from .layers import Layers
from .llvm import Choice
from .meter import Meter, Progress
from .passes import seed_of
from .probes import TexelVisibility, nearest_texels, view_through_centres
from .rigs import cameras, light_of_view
from .scene import ChartMaps
from .scene_text import scene_text, with_own_files
from .shots import Shots

_ENVIRONMENTS, _HEAD = Path("lights"), Path("head")
"""Where a capture keeps its environment maps and the files of your own head, seen from
its ``truth/scene.toml``."""


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
            with_own_files(scene, _ENVIRONMENTS, _HEAD),
            render=replace(scene.render, variant=choice.variant),
            versions=versions(choice),
        )
        files = [light.path for light in scene.single_lights if light.path]
        files += scene.face.files().values() if isinstance(scene.face, HeadFiles) else []
        contents = [content_hash(Path(path)) for path in files]
        self.folder = ResumableFolder(out, f"{scene_text(self.stated)}\n{fingerprint(__name__)}\n{contents}")
        self.path = self.folder.path
        self.truth = self.path / "truth"
        render = scene.render
        self.cameras = cameras(scene.rig, render.width, render.height)
        self.tests = [camera for camera in self.cameras if not camera.train]
        self.real = {camera.name: formation.capture_camera(camera, scene) for camera in self.cameras}
        self.lenses = {name: formation.camera_lens(camera, scene) for name, camera in self.real.items()}
        pictures = len(self.cameras) + len(self.tests) * len(scene.relight)
        pictures += sum(lens is not None for lens in self.lenses.values())
        self.meter = Meter(progress, pictures, render.width * render.height * render.samples)

    def write(self) -> None:
        self.meter.note("face")
        face = build_head(self.scene.face)
        shots = Shots(face, ChartMaps.truth(face), self.stated.render, ArrayStore.of_user())
        self._write_mesh(face.chart)
        self._write_maps(face)
        self._write_views(face, shots)
        for light in self.scene.relight:
            self._write_relit(shots, light)
        self.meter.note("visibility")
        self._write_coverage(face, shots)
        write_text(self.truth / "scene.toml", scene_text(self.stated))
        self.folder.commit()
        self.meter.finish("capture")

    def _write_mesh(self, perfect: Chart) -> None:
        """The mesh that solvers get, and the cameras that were fitted to it."""
        spec = self.scene.captured_mesh
        mesh = degrade(perfect, spec, seed_of("mesh", self.scene.render.seed))
        write_text(self.path / "mesh.obj", obj_text(mesh))
        if spec != CapturedMesh():
            write_json(self.truth / "captured_mesh.json", deviation(perfect, mesh))
        frames = [formation.stated_frame(camera, self.scene, mesh) for camera in self.cameras]
        if self.scene.light.lights:
            frames = [frame | {"light": self._own(camera).name} for frame, camera in zip(frames, self.cameras)]
        document = {
            "camera_model": formation.camera_model(self.scene),
            "mesh": "mesh.obj",
            "frames": frames,
            "train_filenames": [f["file_path"] for f, c in zip(frames, self.cameras) if c.train],
            "test_filenames": [f["file_path"] for f, c in zip(frames, self.cameras) if not c.train],
        }
        if self.scene.rig.light_frame != "head":
            document["light_frame"] = self.scene.rig.light_frame
        if self.scene.formation.hides_exposure:
            document["exposure"] = "unknown"
            gains = {c.name: formation.view_gain(c, self.scene).tolist() for c in self.cameras if c.train}
            write_json(self.truth / "gains.json", gains)
        if not self.scene.labels.omit:
            document["label_names"] = {int(label): label.name.lower() for label in Label if label}
        write_json(self.path / "transforms.json", document)

    def _write_maps(self, face: Face) -> None:
        maps = face.maps
        write_exr(self.truth / "diffuse_albedo.exr", {"": maps.diffuse_albedo})
        write_exr(self.truth / "specular_albedo.exr", {"Y": maps.specular_albedo})
        write_exr(self.truth / "diffuse_normal.exr", {"": maps.diffuse_normal})
        write_exr(self.truth / "specular_normal.exr", {"": maps.specular_normal})
        write_exr(self.truth / "roughness.exr", dict(zip(ROUGHNESS_CHANNELS, np.moveaxis(maps.roughness, -1, 0))))
        write_gray(self.truth / "labels.png", np.where(maps.inside, maps.labels, 0).astype(np.uint8))
        if isinstance(face.spec, FaceSpec):
            write_json(
                self.truth / "skin_tone.json",
                {"fitzpatrick": face.spec.fitzpatrick} | face_ita(maps, face.spec.chart).to_table(),
            )
        else:
            keep(face.spec, self.truth / _HEAD)
        for light in self.scene.single_lights:
            if light.path:
                picture = read_rgb(light.path).clip(0)
                write_exr(self.truth / _ENVIRONMENTS / f"{light.name}.exr", {"": picture})

    def _write_views(self, face: Face, shots: Shots) -> None:
        for light in self.scene.light.groups:
            file = f"light/{light.name}.exr" if self.scene.light.lights else "light.exr"
            write_exr(self.truth / file, {"": shots.light(light).latlong()})
        # Views in one light follow each other, since they share its acceleration structure.
        for camera in sorted(self.cameras, key=lambda camera: self._own(camera).name):
            name = camera.name
            report = self.meter.begin(f"view {name}")
            image = self.path / "images" / f"{name}.exr"
            if image.exists():
                continue
            centres = view_through_centres(shots.head, self.real[name])
            labels = np.where(centres.mask, nearest_texels(face.maps.labels, centres.uv), 0)
            write_gray(self.path / "masks" / f"{name}.png", np.where(centres.mask, 255, 0).astype(np.uint8))
            stated = formation.stated_labels(labels.astype(np.uint8), camera, self.scene)
            if stated is not None:
                write_gray(self.path / "labels" / f"{name}.png", stated)
            layers = self._layers(shots, self.scene.light, camera, report)
            write_exr(self.truth / "layers" / f"{name}.exr", layers.channels())
            if not camera.train:
                self._write_true(self.scene.light, camera, layers)
            # Last, since it marks the view as finished.
            write_exr(image, {"": self._photograph(shots, camera, layers)})

    def _photograph(self, shots: Shots, camera: Camera, perfect: Layers) -> np.ndarray:
        """The picture of a view [H, W, 3] that solvers get: the perfect one if it is withheld."""
        if not camera.train:
            return perfect.total
        seed = seed_of("photograph", self.scene.render.seed, camera.name)
        lens, taken = self.lenses[camera.name], perfect
        if lens is not None:
            report = self.meter.begin(f"view {camera.name} through its lens")
            shared = seed_of("photograph", self.scene.render.seed)
            taken = shots.layers(self._own(camera), self.real[camera.name], seed, shared, report, lens)
        gained = taken.total * formation.view_gain(camera, self.scene).astype(np.float32)
        return formation.expose(gained, self.scene.formation, seed)

    def _write_relit(self, shots: Shots, light: Light) -> None:
        # For readers that light other maps: no score uses it.
        write_exr(self.truth / "relit_lights" / f"{light.name}.exr", {"": shots.light(light).latlong()})
        for camera in self.tests:
            report = self.meter.begin(f"view {camera.name} in {light.name}")
            if not self._relit_path(light, camera).exists():
                self._write_true(light, camera, self._layers(shots, light, camera, report))

    def _write_true(self, light: Light, camera: Camera, layers: Layers) -> None:
        write_exr(self._relit_path(light, camera), {"": layers.total, **layers.channels()})

    def _layers(self, shots: Shots, light: Light, camera: Camera, report) -> Layers:
        seed, light = self.scene.render.seed, light_of_view(self.scene, light, camera)
        return shots.layers(light, camera, seed_of("truth", seed, light.name, camera.name), seed, report)

    def _own(self, camera: Camera) -> Light:
        """The light of a view's own picture."""
        return light_of_view(self.scene, self.scene.light, camera)

    def _relit_path(self, light: Light, camera: Camera) -> Path:
        return self.truth / "relit" / light.name / f"{camera.name}.exr"

    def _write_coverage(self, face: Face, shots: Shots) -> None:
        visibility = TexelVisibility(shots.head, face.surface, self.scene.face.texture_size)
        views = sum(
            visibility.seen_by(camera, read_gray(self.path / "masks" / f"{name}.png") > 0).astype(int)
            for name, camera in self.real.items()
            if camera.train
        )
        write_gray(self.truth / "views.png", views.clip(0, 255).astype(np.uint8))
        write_gray(self.truth / "coverage.png", np.where(views > 0, 255, 0).astype(np.uint8))


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

"""Differentiable path tracing of maps and environment, with known geometry, in two stages as Dib et al. 2021
("Practical Face Reconstruction via Differentiable Ray Tracing"): a small albedo basis first, then free maps.

Passive. Where theirs is a statistical basis of faces, here it is one colour for each label. The material is the skin
of all maps with its mean highlights; gradients come from path replay (Vicini, Speierer, Jakob 2021), as in Mitsuba.
"""

from __future__ import annotations

from types import SimpleNamespace

import drjit as dr
import mitsuba as mi
import numpy as np

from unshade import Capture, Maps

from ..camera.camera import Camera
from ..errors import SolveError
from ..render.lights.conventions import LUMINANCE, directions, solid_angles
from ..render.scene import ChartMaps, HeadScene
from ..scene_file import passes_for
from .regions import regions
from .texel_samples import TexelSamples, sample_texels

_SPECULAR = 0.028
"""Skin of index 1.4, which pictures constrain little."""

_DEPTH = 3
"""Path segments: direct light and one bounce."""

_DARKEST, _BRIGHTEST = 0.01, 0.95
"""Bounds of the albedo."""


def recover(
    capture: Capture, *, texture_size: int = 256, rows: int = 16, samples: int = 16,
    basis_steps: int = 200, free_steps: int = 400, seed: int = 0,
) -> tuple[Maps, np.ndarray]:  # fmt: skip
    """Diffuse albedo, the mesh's normals and a constant specular albedo; and the light (rows, 2 rows, 3).

    Each step takes one view, ``samples`` paths a pixel, and Adam; the loss is the squared error of linear radiance,
    whose gradients path replay gives without bias. ``rows`` of the environment, at infinity. One step of
    256 x 256 pixels takes some 1.2 s of processor time; 0.35 GB.
    """
    sizes = {"texture_size": texture_size, "rows": rows, "samples": samples}
    found = fit(capture, **sizes, basis_steps=basis_steps, free_steps=free_steps, seed=seed)
    return found.maps, found.light


def fit(
    capture: Capture, *, texture_size: int, samples: int, basis_steps: int, free_steps: int, rows: int = 16, seed: int = 0
) -> Fit:  # fmt: skip
    """The fitted scene, with its maps; see `recover`."""
    if passes_for(samples) is None:
        raise SolveError(f"path-traced: samples is {samples}, which stratified passes cannot share; use 4, 8 or 16")
    texels = sample_texels(capture, texture_size)
    region = texels.filled(regions(capture, texels)[:, None])[..., 0].astype(np.uint32)
    mesh = SimpleNamespace(**{key: np.asarray(value) for key, value in capture.mesh.items()}, uv=capture.mesh["uvs"])
    start = np.full((texture_size, texture_size, 3), 0.4, np.float32)
    head = HeadScene(mesh, [], ChartMaps(start, np.full((2, 2), _SPECULAR, np.float32)))
    sky = {"type": "envmap", "bitmap": mi.Bitmap(np.ones((rows, 2 * rows, 3), np.float32)), "scale": 1.0}
    integrator = {"type": "prb", "max_depth": _DEPTH, "hide_emitters": True}
    scene = mi.load_dict({"type": "scene", "chart": head.chart, "sky": sky, "integrator": integrator})
    found = Fit(scene, _views(capture, samples), samples, seed)

    colours = dr.full(mi.TensorXf, 0.4, (int(region.max()) + 1, 3))
    place = mi.UInt32(np.repeat(region.ravel() * 3, 3) + np.tile(np.arange(3, dtype=np.uint32), region.size))

    def painted(colours):
        return mi.TensorXf(dr.gather(mi.Float, colours.array, place), start.shape)

    colours = found.run(colours, painted, basis_steps, 0.02)
    albedo = found.run(dr.detach(painted(colours)), lambda albedo: albedo, free_steps, 0.01)
    found.maps, found.light = _scaled(texels, np.array(albedo), np.array(found.params[found.sky]))
    return found


class Fit:
    """The scene's albedo and light, moved towards the pictures."""

    maps: Maps
    light: np.ndarray

    def __init__(self, scene, views: list[tuple], samples: int, seed: int) -> None:
        self.scene, self.views, self.samples, self.seed = scene, views, samples, seed
        self.params = mi.traverse(scene)
        self.albedo, self.sky = (next(key for key, _ in self.params if key.endswith(end)) for end in
                                 ("diffuse.data", "sky.data"))  # fmt: skip
        self.step = 0

    def run(self, unknowns, albedo_of, steps: int, rate: float):
        """The unknowns after ``steps``; ``albedo_of`` makes the texture of them."""
        optimiser = mi.ad.Adam(lr=rate)
        optimiser["unknowns"], optimiser["sky"] = unknowns, self.params[self.sky]
        optimiser.set_learning_rate({"unknowns": rate, "sky": 2 * rate})
        for step in range(steps):
            if step == int(0.7 * steps):
                optimiser.set_learning_rate({"unknowns": rate / 5, "sky": rate / 5})
            self.params[self.albedo] = albedo_of(optimiser["unknowns"])
            self.params[self.sky] = optimiser["sky"]
            self.params.update()
            sensor, picture, mask = self.views[self.step % len(self.views)]
            render = mi.render(self.scene, self.params, sensor=sensor, spp=self.samples, seed=self.seed + self.step)
            dr.backward(dr.mean(dr.square(render - picture) * mask, axis=None))
            optimiser.step()
            optimiser["unknowns"] = dr.clip(dr.detach(optimiser["unknowns"]), _DARKEST, _BRIGHTEST)
            optimiser["sky"] = dr.maximum(dr.detach(optimiser["sky"]), 0)
            self.step += 1
        self.params[self.albedo] = albedo_of(dr.detach(optimiser["unknowns"]))
        self.params[self.sky] = dr.detach(optimiser["sky"])
        self.params.update()
        return dr.detach(optimiser["unknowns"])


def _views(capture: Capture, samples: int) -> list[tuple]:
    """Sensor, picture and mask (H, W, 1) of each training view."""
    views = []
    for name in capture.train:
        given = capture.camera(name)
        width, height = given["width"], given["height"]
        if not np.allclose(
            [given["focal"][0], *given["centre"]], [given["focal"][1], width / 2, height / 2], rtol=1e-4
        ):
            raise SolveError(
                f"{capture.path}: camera {name} is not a centred pinhole with square pixels; undistort its picture"
            )
        matrix = given["camera_to_world"].astype(float)
        sensor = Camera(name, width, height, given["focal"][0], matrix, True).sensor(samples)
        inside = capture.mask(name) > 127
        # Pixels that the face's edge runs through show what is behind it too.
        inside[1:-1, 1:-1] &= inside[:-2, 1:-1] & inside[2:, 1:-1] & inside[1:-1, :-2] & inside[1:-1, 2:]
        views.append((sensor, mi.TensorXf(capture.image(name)), mi.TensorXf(inside[..., None].astype(np.float32))))
    return views


def _scaled(texels: TexelSamples, albedo: np.ndarray, sky: np.ndarray) -> tuple[Maps, np.ndarray]:
    """Maps and light, scaled so that light is grey on average, and gives the front a largest irradiance of pi, as all lights here."""
    sky = sky[:, : 2 * sky.shape[0]]
    towards, _ = directions(*sky.shape[:2], 1)
    front = texels.normals[texels.normals[:, 2] > 0][::7]
    arriving = np.einsum("nd,hwd->nhw", front, towards).clip(0) * solid_angles(*sky.shape[:2])[None, :, None]
    irradiance = np.einsum("nhw,hwc->nc", arriving, sky) / np.pi
    tint = irradiance.mean(0) / (irradiance @ LUMINANCE).mean()
    factor = tint * np.percentile(irradiance / tint @ LUMINANCE, 99.9)
    normal = texels.normals_filled()
    size = len(albedo)
    maps = Maps(
        diffuse_albedo=(albedo * factor).clip(0, 1), specular_albedo=np.full((size, size), _SPECULAR),
        diffuse_normal=normal, specular_normal=normal, coverage=texels.coverage,
    )  # fmt: skip
    # Cells of equal angle, from the renderer's rows, whose first and last lie on the poles.
    place = (np.arange(len(sky)) + 0.5) / len(sky) * (len(sky) - 1)
    above = place.astype(int)
    below = (place - above)[:, None, None]
    return maps, (sky[above] * (1 - below) + sky[above + 1] * below) / factor

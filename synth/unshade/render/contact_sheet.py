"""A sheet of many sampled faces on one page, to see at a glance what the generator makes."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import mitsuba as mi
import numpy as np
from PIL import Image, ImageDraw, ImageFont

from ..camera.camera import Camera, look_at
from ..errors import SceneError
from ..face import FaceSpec, build_face
from ..face.spec import FITZPATRICK, stream
from ..files.pictures import replace_file
from ..scene_file import Light
from ..srgb import encoded
from ..vectors import away
from . import lights
from .passes import render_layers, seed_of
from .scene import ChartMaps, HeadScene

LIGHTS = {"studio": 1.8, "sun": 1.5, "dome": 1.15, "flash": 1.5}
"""Kinds of light that take turns, none of which needs a file, and the exposure of the page in each.

Lights make the brightest spot of the skin as bright as its albedo; where most of a face lies
in shade, a longer exposure reads better.
"""

SIDE = 256
"""Pixels along each edge of a face's picture."""

_SAMPLES, _DEPTH, _TEXTURE = 64, 6, 512
_CAPTION, _GAP = 34, 4
_AIM, _DISTANCE, _HALF_HEIGHT = np.array([0.0, -0.006, 0.02]), 1.0, 0.135
"""Point that the cameras look at, their distance, half the height that they show there (all m)."""

_BACKDROP = 0.10
"""Linear grey behind the heads."""

_COARSE = 4
"""Rays along each edge of a pixel that separate the head from the backdrop."""

_PAPER, _INK = 24, 215


@dataclass(frozen=True)
class SampledFace:
    """One face of a sheet: who, in which kind of light, and seen from where (degrees)."""

    spec: FaceSpec
    light: str
    azimuth: float
    elevation: float

    @property
    def caption(self) -> tuple[str, str]:
        spec = self.spec
        return f"seed {spec.seed} · type {spec.fitzpatrick}", f"{spec.years:.0f} years · {self.light}"


def sampled_faces(count: int, seed: int, detail: str = "smooth") -> list[SampledFace]:
    """The faces of a sheet: skin types take turns, ages are spread evenly from 20 to 70 years
    in an order of their own, lights take turns so that each meets every type; `detail` as of a `[face]`."""
    rng = stream(seed, "contact sheet")
    ages = (rng.permutation(count) + 0.5) / count
    seeds = rng.choice(100_000, count, replace=False)
    chosen = []
    for i in range(count):
        spec = FaceSpec.sample(
            int(seeds[i]),
            fitzpatrick=FITZPATRICK[i % len(FITZPATRICK)],
            age=float(ages[i]),
            texture_size=_TEXTURE,
            detail=detail,
        )
        light = tuple(LIGHTS)[(i + i // len(FITZPATRICK)) % len(LIGHTS)]
        chosen.append(SampledFace(spec, light, rng.uniform(-22, 22), rng.uniform(-4, 8)))
    return chosen


def contact_sheet(
    count: int,
    out: Path,
    seed: int = 0,
    progress: Callable[[int, int, str], None] = lambda done, total, what: None,
    detail: str = "smooth",
) -> None:
    """Renders `count` sampled faces to one PNG, captioned with seed, skin type, age and light.

    Equal counts and seeds give the same picture. Written beside `out` and renamed.
    Raises `SceneError` for a count below 1, `StorageError` if it cannot be written.
    """
    if count < 1:
        raise SceneError(f"a contact sheet of {count} faces has nothing to show; ask for 1 or more")
    pictures, captions = [], []
    for done, sitter in enumerate(sampled_faces(count, seed, detail)):
        progress(done, count, f"face {sitter.spec.name}")
        pictures.append(_portrait(sitter))
        captions.append(sitter.caption)
    page = _page(pictures, captions)
    replace_file(out, lambda partial: page.save(partial, format="PNG", optimize=True))
    progress(count, count, "contact sheet")


def _portrait(sitter: SampledFace) -> np.ndarray:
    """8-bit sRGB picture (SIDE, SIDE, 3)."""
    face = build_face(sitter.spec)
    head = HeadScene(face.surface, face.parts, ChartMaps.truth(face))
    light = lights.exposed(Light(sitter.light, sitter.light), face.chart.vertices, face.chart.normals)
    towards = away(*np.radians([sitter.azimuth, sitter.elevation]))
    matrix = look_at(_AIM + _DISTANCE * towards, _AIM)
    focal = SIDE / 2 * _DISTANCE / _HALF_HEIGHT
    camera = Camera("portrait", SIDE, SIDE, focal, matrix, True)
    seed = seed_of("contact sheet", sitter.spec.seed)
    layers = render_layers(head.lit(light), camera.sensor(_SAMPLES), samples=_SAMPLES, depth=_DEPTH, seed=seed)
    fine = Camera("cover", _COARSE * SIDE, _COARSE * SIDE, _COARSE * focal, matrix, True)
    return srgb(LIGHTS[sitter.light] * layers.total + (1 - _cover(head, fine))[..., None] * _BACKDROP)


def _cover(head: HeadScene, fine: Camera) -> np.ndarray:
    """Share (SIDE, SIDE) of each pixel that shows the head."""
    x, y, z = fine.pixel_directions().astype(np.float32).T
    if mi.variant().startswith("scalar"):
        rays = (mi.Ray3f(mi.Point3f(*fine.position), mi.Vector3f(*map(float, d))) for d in zip(x, y, z))
        hit = np.array([head.dark.ray_test(ray) for ray in rays])
    else:
        hit = np.array(head.dark.ray_test(mi.Ray3f(mi.Point3f(*map(float, fine.position)), mi.Vector3f(x, y, z))))
    return hit.reshape(SIDE, _COARSE, SIDE, _COARSE).mean(axis=(1, 3))


def srgb(linear: np.ndarray) -> np.ndarray:
    """8-bit sRGB (IEC 61966-2-1) of linear Rec.709; highlights roll off from 0.7 on instead of clipping."""
    x = np.maximum(linear, 0)
    x = np.where(x < 0.7, x, 1 - 0.3 * np.exp(-(x - 0.7) / 0.3))
    return np.round(255 * encoded(x)).astype(np.uint8)


def _columns(count: int) -> int:
    """Columns of the wide grid that wastes the fewest places: 6 (x 4) for 24."""
    widest = max(1, math.ceil(math.sqrt(1.6 * count)))
    return min(range(max(1, widest - 2), widest + 1), key=lambda n: (-count % n, -n))


def _page(pictures: list[np.ndarray], captions: list[tuple[str, str]]) -> Image.Image:
    columns = _columns(len(pictures))
    rows = math.ceil(len(pictures) / columns)
    page = Image.new("RGB", (columns * (SIDE + _GAP) + _GAP, rows * (SIDE + _CAPTION + _GAP) + _GAP), (_PAPER,) * 3)
    draw, font = ImageDraw.Draw(page), ImageFont.load_default(13)
    for i, (picture, lines) in enumerate(zip(pictures, captions)):
        x, y = _GAP + i % columns * (SIDE + _GAP), _GAP + i // columns * (SIDE + _CAPTION + _GAP)
        page.paste(Image.fromarray(picture), (x, y))
        for k, line in enumerate(lines):
            draw.text((x + SIDE / 2, y + SIDE + 9 + 15 * k), line, fill=(_INK,) * 3, font=font, anchor="mm")
    return page

"""Makes docs/wide-sheet.jpg: ``python docs/wide_picture.py``, a minute or two.

A wide chart's albedo, the face from in front and behind; then the cheek under a lamp from the side, with relief in
the normals alone, as geometry, and (relief in the normals) of the principled material.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from picture import srgb
from PIL import Image

from unshade.camera.camera import Camera, look_at
from unshade.face import Face, FaceSpec, build_face
from unshade.render import lights
from unshade.render.passes import render_layers
from unshade.render.scene import ChartMaps, HeadScene
from unshade.scene_file import Light

SIDE = 320
PERSON = FaceSpec.sample(7, name="wide", fitzpatrick="III", detail="natural", age=0.7, texture_size=1024)


def portrait(face: Face, light: str, eye: tuple, target: tuple, zoom: float, material: str = "skin") -> np.ndarray:
    """8-bit picture (SIDE, SIDE, 3) from `eye` (m) towards `target`; `zoom` is the focal length in sides."""
    head = HeadScene(face.surface, face.parts, ChartMaps.truth(face), material)
    lit = head.lit(lights.exposed(Light(light, light), face.chart.vertices, face.chart.normals))
    camera = Camera("sheet", SIDE, SIDE, zoom * SIDE, look_at(np.array(eye), np.array(target)), True)
    return srgb(1.6 * render_layers(lit, camera.sensor(64), samples=64, depth=5, seed=1).total)


def main() -> None:
    """Writes docs/wide-sheet.jpg."""
    face = {name: build_face(replace(PERSON, **keys)) for name, keys in
            (("wide", {"chart": "wide"}), ("plain", {}), ("raised", {"displacement": True}))}  # fmt: skip
    maps = face["wide"].maps
    chart = srgb(maps.diffuse_albedo * maps.inside[..., None])
    above = [np.asarray(Image.fromarray(chart).resize((SIDE, SIDE), Image.Resampling.LANCZOS))]
    above += [portrait(face["wide"], "studio", eye, (0, -0.06, 0), 1.5) for eye in ((0.2, 0, 0.72), (-0.2, 0.1, -0.72))]
    close = lambda name, material="skin": portrait(
        face[name], "key", (-0.12, 0, 0.45), (0.0, -0.015, 0.07), 2.6, material
    )
    below = [close("plain"), close("raised"), close("plain", "principled")]
    sheet = np.concatenate([np.concatenate(row, axis=1) for row in (above, below)])
    Image.fromarray(sheet).save(Path(__file__).with_name("wide-sheet.jpg"), quality=86)


if __name__ == "__main__":
    main()

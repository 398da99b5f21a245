"""A scene in words and numbers, before anything is rendered."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping

import numpy as np

from ..camera.camera import Camera
from ..face import Face
from ..heads import build_head
from ..scene_file import Light, Scene
from . import lights
from .colour_temperature import correlated_kelvin
from .lights.conventions import LUMINANCE, solid_angles
from .rigs import FACE_CENTRE, cameras

_SMALL_TEXTURE = 64
"""Maps are not described, so they need no detail."""


def describe(scene: Scene) -> str:
    """A text of the face, the cameras and, per light, of what it sends.

    Radiances are in the units of the pictures, after exposure; means are over all
    directions, weighed by solid angle. Raises what building the face or the lights raises.
    """
    face = build_head(dataclasses.replace(scene.face, texture_size=_SMALL_TEXTURE))
    views = cameras(scene.rig, scene.render.width, scene.render.height)
    blocks = [
        f"scene {scene.name}",
        "\n".join(["face", *_face(scene, face)]),
        "\n".join([f"rig {scene.rig.name} ({scene.rig.kind})", *_cameras(views)]),
        "\n".join(["lights", *_lights(scene, face)]),
        "\n".join(["render", *_render(scene, views)]),
        "\n".join(["what solvers get of the training views", *_faults(scene)]),
    ]
    return "\n\n".join(blocks) + "\n"


def _face(scene: Scene, face: Face) -> list[str]:
    head = scene.face
    size = 1000 * np.ptp(face.chart.vertices, axis=0)
    lines = [f"  {key:<16} {_words(value)}" for key, value in head.to_table().items()]
    return [
        *lines,
        (
            f"  chart            {len(face.chart.vertices)} vertices, {len(face.chart.triangles)} triangles, "
            f"{size[0]:.0f} x {size[1]:.0f} x {size[2]:.0f} mm"
        ),
        f"  other parts      {', '.join(part.name for part in face.parts) or 'none'}",
    ]


def _words(value: object) -> str:
    """One value of a table on one line."""
    if isinstance(value, Mapping):
        return ", ".join(f"{key} {_words(v)}" for key, v in value.items()) or "none"
    if isinstance(value, (list, tuple)):
        return ", ".join(map(_words, value))
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _cameras(views: list[Camera]) -> list[str]:
    rows = [("view", "use", "azimuth", "elevation", "distance", "field of view")]
    for view in views:
        x, y, z = view.position - FACE_CENTRE
        distance = math.sqrt(x * x + y * y + z * z)
        wide, high = (math.degrees(2 * math.atan(side / 2 / view.focal)) for side in (view.width, view.height))
        azimuth, elevation = math.degrees(math.atan2(x, z)), math.degrees(math.asin(y / distance))
        use = "training" if view.train else "withheld"
        rows.append(
            (
                view.name,
                use,
                f"{azimuth:+.1f}°",
                f"{elevation:+.1f}°",
                f"{distance:.3f} m",
                f"{wide:.1f}° x {high:.1f}°",
            )
        )
    return _table(rows)


def _lights(scene: Scene, face: Face) -> list[str]:
    rows = [("light", "use", "kind", "mean radiance", "maximum", "max/mean", "colour R:G:B", "CCT", "most on face")]
    for light in scene.single_lights:
        use = "capture" if light in scene.light.groups else "relit"
        rows.append((light.name, use, light.kind, *_light(light, face)))
    return _table(rows)


def _light(light: Light, face: Face) -> tuple[str, ...]:
    """Mean and maximum radiance (luminance), their ratio, the mean's colour, and the largest irradiance."""
    model = lights.exposed(light, face.chart.vertices, face.chart.normals)
    mean = mean_radiance(model)
    # Parts of a light stage's sphere share its exposure; all other lights have theirs.
    irradiance = light.exposure * math.pi
    if isinstance(model, lights.StagePattern):
        irradiance = lights.largest_irradiance(model, face.chart.vertices, face.chart.normals)
    brightest = float(model.brightest() @ LUMINANCE)
    level = float(mean @ LUMINANCE)
    kelvin = correlated_kelvin(mean)
    return (
        f"{level:.4g}",
        f"{brightest:.4g}",
        f"{brightest / level:.4g}",
        ":".join(f"{c:.3f}" for c in mean / mean[1]) if mean[1] > 0 else "-",
        f"{kelvin:.0f} K" if kelvin else "-",
        f"{irradiance / math.pi:.3f} pi",
    )


def mean_radiance(model: lights.AnyLight) -> np.ndarray:
    """Mean radiance [3] over all directions from the head's centre, weighed by solid angle."""
    picture = model.latlong().astype(np.float64)
    height, width = picture.shape[:2]
    return np.einsum("jic,j->c", picture, solid_angles(height, width)) / (4 * math.pi)


def _render(scene: Scene, views: list[Camera]) -> list[str]:
    render = scene.render
    withheld = sum(not view.train for view in views)
    pictures = len(views) + withheld * len(scene.relight)
    settings = render.to_table()
    size = f"{settings.pop('width')} x {settings.pop('height')} pixels"
    return [
        f"  pictures         {pictures} of {size}: {len(views)} views, {withheld} withheld ones in {len(scene.relight)} other lights",
        f"  camera rays      {pictures * render.width * render.height * render.samples:.3g}",
        *(f"  {key:<16} {_words(value)}" for key, value in settings.items()),
    ]


def _faults(scene: Scene) -> list[str]:
    """Lines on the faults of pictures, cameras, mesh and labels in the scene."""
    fraction = scene.labels.boundary_error
    labels = (
        f"{100 * fraction:.3g} % of the boundary pixels have the label of the other side" if fraction else "perfect"
    )
    if scene.labels.one:
        labels = "one for everything"
    if scene.labels.hair_is_skin:
        labels = "hair is called skin" + (f"; {labels}" if fraction else "")
    formation, mesh = (
        _words(table) if table else "perfect" for table in (scene.formation.to_table(), scene.captured_mesh.to_table())
    )
    return [
        f"  image formation  {formation}",
        f"  mesh             {mesh}",
        f"  labels           {'none' if scene.labels.omit else labels}",
    ]


def _table(rows: list[tuple[str, ...]]) -> list[str]:
    widths = [max(map(len, column)) for column in zip(*rows)]
    return ["  " + "  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows]

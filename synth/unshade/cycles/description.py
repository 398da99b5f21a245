"""A scene for Cycles, as a JSON file and plain arrays and pictures beside it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..camera.camera import Camera
from ..face import Part
from ..files.pictures import write_exr, write_json
from ..render.lights import AnyLight, Ball, Dome, Environment, Panels, SunSky
from ..render.lights.sun import APERTURE_DEGREES
from ..render.scene import WET_ALPHA
from ..render.skin_bsdf import LOBE_ALPHAS, LOBE_WEIGHTS
from ..surface import Surface
from ..vectors import frame, twice_areas

_STANDARD = [*LOBE_ALPHAS, LOBE_WEIGHTS[0]]
_SUN_METRES = 1000.0
_SIDES = 96


def write_meshes(folder: Path, surface: Surface, parts: Sequence[Part]) -> list[dict[str, Any]]:
    """The face with its maps and the other parts of the head; writes their files to a folder."""
    face = {
        "diffuse": _picture(folder / "diffuse.exr", surface.maps.diffuse_albedo),
        "specular": _picture(folder / "specular.exr", surface.specular_albedo),
        "roughness": _STANDARD
        if surface.maps.roughness is None
        else _picture(folder / "roughness.exr", surface.roughness),
        "diffuse_normal": _picture(folder / "diffuse_normal.exr", surface.diffuse_normal),
        "specular_normal": _picture(folder / "specular_normal.exr", surface.specular_normal),
    }
    for layer in ("diffuse", "specular"):
        # The mesh's own normal needs no picture.
        if getattr(surface.maps, f"{layer}_normal") is None:
            del face[f"{layer}_normal"]
    mesh = surface.mesh
    meshes = [
        _mesh(folder, "face", face, vertices=mesh.vertices, normals=mesh.normals, triangles=mesh.triangles, uv=mesh.uv)
    ]
    return meshes + [write_part(folder, part) for part in parts]


def write_part(folder: Path, part: Part) -> dict[str, Any]:
    """One of the other parts of a head."""
    shape = {"vertices": part.vertices, "normals": part.normals, "triangles": part.triangles}
    material: dict[str, Any]
    if part.texture is not None:
        names = ("diffuse", "specular", "diffuse_normal", "specular_normal", "roughness")
        material = {name: _picture(folder / f"{part.name}_{name}.exr", getattr(part.texture, name)) for name in names}
        return _mesh(folder, part.name, material, **shape, uv=part.texture.uv)
    if part.uv is None:
        material = {name: {"attribute": name} for name in ("diffuse", "specular")}
        return _mesh(
            folder,
            part.name,
            {**material, "roughness": _STANDARD},
            **shape,
            diffuse=part.diffuse,
            specular=part.specular,
        )
    material = {
        "diffuse": _picture(folder / f"{part.name}_diffuse.exr", part.diffuse),
        "specular": _picture(folder / f"{part.name}_specular.exr", part.specular),
        "roughness": [WET_ALPHA, WET_ALPHA, LOBE_WEIGHTS[0]],
    }
    return _mesh(folder, part.name, material, **shape, uv=part.uv)


def _mesh(folder: Path, name: str, material: dict[str, Any] | None, **arrays: np.ndarray) -> dict[str, Any]:
    path = folder / f"{name}.npz"
    np.savez(path, **arrays)  # type: ignore[arg-type]
    return {"name": name, "file": str(path.resolve()), "material": material}


def _picture(path: Path, values: np.ndarray) -> dict[str, str]:
    write_exr(path, {"": np.repeat(values[..., None], 3, -1) if values.ndim == 2 else values})
    return {"file": str(path.resolve())}


def write_light(folder: Path, name: str, light: AnyLight) -> dict[str, Any]:
    """The description of a light: its background, and its lamps as emissive meshes."""
    said: dict[str, Any] = {"name": name, "lamps": []}

    def lamp(number: int, vertices: np.ndarray, triangles: np.ndarray, radiance: Any) -> None:
        mesh = _mesh(folder, f"{name}_{number}", None, vertices=vertices, triangles=triangles)
        said["lamps"].append({**mesh, "radiance": np.broadcast_to(np.asarray(radiance, float), 3).tolist()})

    if isinstance(light, Dome):
        said["background"] = {"radiance": [light.radiance] * 3}
    elif isinstance(light, Environment):
        said["background"] = _picture(folder / f"{name}.exr", equirectangular(light.latlong()))
    elif isinstance(light, Panels):
        for number, panel in enumerate(light.panels):
            c, r, u = panel.centre, panel.right, panel.up
            lamp(
                number,
                np.array([c - r - u, c + r - u, c + r + u, c - r + u]),
                np.array([[0, 1, 2], [0, 2, 3]]),
                panel.radiance,
            )
    elif isinstance(light, SunSky):
        said["background"] = _picture(folder / f"{name}.exr", equirectangular(light.sky.latlong()))
        radius = _SUN_METRES * np.tan(np.radians(APERTURE_DEGREES / 2))
        lamp(0, *_disc(light.direction, radius), light.sun)
    elif isinstance(light, Ball):
        lamp(0, *_ball(light), light.radiance)
    return said


def equirectangular(picture: np.ndarray) -> np.ndarray:
    """A lat-long picture of ours (rows on the poles) as Blender has it: texel centres, Z up, twice as fine.

    Blender's direction of (u, v), v up, has azimuth 2 pi (1/2 - u) from +X towards +Y and elevation pi (v - 1/2).
    """
    height, width = 2 * picture.shape[0], 2 * picture.shape[1]
    v = 1 - (np.arange(height) + 0.5) / height
    turn = 2 * np.pi * (0.5 - (np.arange(width) + 0.5) / width)
    # Its (X, Y, Z) is our (X, Z, -Y): theirs x = cos a, y = sin a is ours x = cos a, z = -sin a.
    phi = np.arctan2(np.cos(turn), np.sin(turn)) % (2 * np.pi)
    rows, columns = (1 - v) * (picture.shape[0] - 1), phi / (2 * np.pi) * picture.shape[1] - 0.5
    top = np.floor(rows).astype(int).clip(0, picture.shape[0] - 2)
    left = np.floor(columns).astype(int)
    down, across = (rows - top)[:, None, None], (columns - left)[None, :, None]
    a, b = left % picture.shape[1], (left + 1) % picture.shape[1]
    lines = picture[top] * (1 - down) + picture[top + 1] * down
    return (lines[:, a] * (1 - across) + lines[:, b] * across).astype(np.float32)


def _disc(direction: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """A polygon of a disc's area that faces the origin."""
    side, other = frame(direction)
    turn = 2 * np.pi * np.arange(_SIDES) / _SIDES
    radius *= np.sqrt(2 * np.pi / _SIDES / np.sin(2 * np.pi / _SIDES))
    ring = radius * (np.cos(turn)[:, None] * side + np.sin(turn)[:, None] * other)
    vertices = np.vstack([np.zeros(3), ring]) + _SUN_METRES * direction
    after = np.arange(_SIDES)
    return vertices, np.stack([np.zeros(_SIDES, int), (after + 1) % _SIDES + 1, after + 1], 1)


def _ball(ball: Ball) -> tuple[np.ndarray, np.ndarray]:
    """A sphere of facets whose mean outline has the area of the ball's."""
    rows, columns = 24, 48
    theta, phi = np.meshgrid(
        np.pi * np.arange(rows + 1) / rows, 2 * np.pi * np.arange(columns) / columns, indexing="ij"
    )
    points = np.stack([np.sin(theta) * np.sin(phi), np.cos(theta), np.sin(theta) * np.cos(phi)], -1).reshape(-1, 3)
    corner = np.arange(rows * columns).reshape(rows, columns)
    right = np.roll(corner, -1, 1)
    quads = [(corner, corner + columns, right + columns), (corner, right + columns, right)]
    triangles = np.concatenate([np.stack([part.ravel() for part in quad], 1) for quad in quads])
    # The mean outline of a convex body is a quarter of its surface (Cauchy).
    area = twice_areas(points, triangles)
    radius = ball.radius * np.sqrt(4 * np.pi / (area.sum() / 2))
    return ball.centre + radius * points, triangles[area > 1e-12]


def view(camera: Camera, seeds: dict[str, list[int]]) -> dict[str, Any]:
    """A camera, and the seeds of its pictures in each light."""
    return {
        "name": camera.name,
        "width": camera.width,
        "height": camera.height,
        "focal": camera.focal,
        "matrix": camera.matrix.tolist(),
        "seeds": seeds,
    }


def write_job(folder: Path, **job: Any) -> Path:
    """The description itself: ``meshes``, ``lights``, ``views``, ``samples``, ``depth``, and ``out``, or ``save``.

    ``open`` names a .blend to take light and camera from.
    """
    path = folder / "job.json"
    write_json(path, job)
    return path

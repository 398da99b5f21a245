"""A Mitsuba scene that renders as it is: ``scene.xml`` with stock plugins, ``exact.xml`` with the skin itself.

``exact.xml`` needs the plugin ``skin``, which comes along as a Python file; ``render.py`` registers it. ``scene.xml``
is the same model out of blends: Lambert under its normal map, and two rough conductors without absorption and with
a glass's index of refraction under theirs. The difference is glass's Fresnel term in place of Schlick's, and that
normal maps are read between texels in a triangle's frame.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import mitsuba as mi
import numpy as np

from ..camera.camera import Camera
from ..files.obj_text import obj_text
from ..files.pictures import ROUGHNESS_CHANNELS, write_exr, write_text
from ..render import skin_bsdf
from ..render.lights import AnyLight, Environment, SunSky
from ..render.skin_bsdf import F0
from ..surface import Surface
from .tangents import mitsuba_normals
from .texture_files import encoded_normals

STOCK, EXACT = "scene.xml", "exact.xml"

_IOR = (1 + math.sqrt(F0)) / (1 - math.sqrt(F0))
_SAMPLES = 144
"""A full grid of the sampler."""

_RENDER = '''"""Renders the face: python render.py [exact.xml | scene.xml] picture.exr"""

import sys

import mitsuba as mi

scene, picture = (["exact.xml"] + sys.argv[1:])[-2:]
mi.set_variant("llvm_ad_rgb")
from skin import SkinBSDF  # noqa: E402, its classes belong to the variant

mi.register_bsdf("skin", SkinBSDF)
mi.util.write_bitmap(picture, mi.render(mi.load_file(scene)))
'''


def write_mitsuba(surface: Surface, folder: Path, light: AnyLight, camera: Camera, depth: int) -> dict[str, Any]:
    """Writes both scenes and all that they name; returns the asset's description."""
    textures = folder / "textures"
    maps = surface.maps
    write_text(folder / "face.obj", obj_text(surface.mesh))
    write_exr(textures / "diffuse_albedo.exr", {"": maps.diffuse_albedo})
    write_exr(textures / "specular_albedo.exr", {"Y": surface.specular_albedo})
    write_exr(textures / "diffuse_normal.exr", {"": _or_zero(maps.diffuse_normal)})
    write_exr(textures / "specular_normal.exr", {"": _or_zero(maps.specular_normal)})
    roughness = surface.roughness
    # Three channels that are not a colour, by the names that every reader takes.
    write_exr(textures / "roughness.exr", {"": roughness})
    _write_stock_textures(surface, textures)
    common = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": depth},
        "camera": _camera(camera),
        **_light(light, textures),
    }
    face = {"type": "obj", "filename": "face.obj"}
    for name, bsdf in ((STOCK, _stock()), (EXACT, _exact())):
        write_text(folder / name, scene_text({**common, "face": {**face, "bsdf": bsdf}}))
    write_text(folder / "skin.py", Path(skin_bsdf.__file__).read_text())
    write_text(folder / "render.py", _RENDER)
    return {
        "file": STOCK,
        "exact_file": EXACT,
        "maps": "float EXR as they are, object-space normals; roughness: alphas of both lobes and the share of the first",
        "stock": "blends of diffuse and roughconductor under normalmap, tangent space of Mitsuba 3.9's triangles",
        "channels_of_roughness": list(ROUGHNESS_CHANNELS),
        "left_out": [f"{STOCK}: Schlick's approximation is glass's Fresnel term", f"{EXACT}: nothing"],
    }


def _write_stock_textures(surface: Surface, textures: Path) -> None:
    for name, normals in (("diffuse", surface.diffuse_normal), ("specular", surface.specular_normal)):
        write_exr(textures / f"{name}_tangent_normal.exr", {"": encoded_normals(mitsuba_normals(surface, normals))})
    # A blend halves what it joins.
    write_exr(textures / "twice_diffuse.exr", {"": 2 * surface.maps.diffuse_albedo})
    write_exr(textures / "twice_specular.exr", {"Y": 2 * surface.specular_albedo / F0})
    for i, name in enumerate(("alpha1", "alpha2", "share1")):
        write_exr(textures / f"{name}.exr", {"Y": np.ascontiguousarray(surface.roughness[..., i])})


def _or_zero(normals: np.ndarray | None) -> np.ndarray:
    # A texel without direction means the mesh's own normal.
    return np.zeros((2, 2, 3), np.float32) if normals is None else normals


def _texture(name: str) -> dict[str, Any]:
    return {
        "type": "bitmap",
        "filename": f"textures/{name}.exr",
        "raw": True,
        "filter_type": "bilinear",
        "wrap_mode": "clamp",
    }


def _exact() -> dict[str, Any]:
    return {
        "type": "skin",
        "diffuse": _texture("diffuse_albedo"),
        "specular": _texture("specular_albedo"),
        "diffuse_normal": _texture("diffuse_normal"),
        "specular_normal": _texture("specular_normal"),
        "roughness": _texture("roughness"),
    }


def _stock() -> dict[str, Any]:
    def lobe(name: str) -> dict[str, Any]:
        return {
            "type": "roughconductor",
            "distribution": "ggx",
            "eta": _IOR,
            "k": 0.0,
            "alpha": _texture(name),
            "specular_reflectance": _texture("twice_specular"),
        }

    def bumped(name: str, bsdf: dict[str, Any]) -> dict[str, Any]:
        return {"type": "normalmap", "normalmap": _texture(f"{name}_tangent_normal"), "bsdf": bsdf}

    lambert = {"type": "diffuse", "reflectance": _texture("twice_diffuse")}
    lobes = {"type": "blendbsdf", "weight": _texture("share1"), "bsdf_0": lobe("alpha2"), "bsdf_1": lobe("alpha1")}
    both = {
        "type": "blendbsdf",
        "weight": 0.5,
        "bsdf_0": bumped("diffuse", lambert),
        "bsdf_1": bumped("specular", lobes),
    }
    return both


def _camera(camera: Camera) -> dict[str, Any]:
    to_world = camera.matrix @ np.diag([-1.0, 1.0, -1.0, 1.0])
    return {
        "type": "perspective",
        "fov": math.degrees(2 * math.atan(camera.width / 2 / camera.focal)),
        "fov_axis": "x",
        "to_world": mi.ScalarTransform4f(to_world),
        "near_clip": 0.01,
        "far_clip": 100.0,
        "film": {"type": "hdrfilm", "width": camera.width, "height": camera.height, "rfilter": {"type": "box"}},
        "sampler": {"type": "multijitter", "sample_count": _SAMPLES},
    }


def _light(light: AnyLight, textures: Path) -> dict[str, Any]:
    emitters = light.emitters()
    if isinstance(light, (Environment, SunSky)):
        sky = light.sky.latlong() if isinstance(light, SunSky) else light.latlong()
        write_exr(textures / "environment.exr", {"": sky})
        emitters["environment"] = {"type": "envmap", "filename": "textures/environment.exr"}
    return emitters


def scene_text(scene: dict[str, Any]) -> str:
    """The XML of a scene's dictionary of plain values, nested plugins and transforms."""
    lines = ['<?xml version="1.0" encoding="utf-8"?>', '<scene version="3.0.0">']
    for name, plugin in scene.items():
        if name != "type":
            lines += _plugin(name, plugin, 1)
    return "\n".join([*lines, "</scene>"]) + "\n"


_TAGS = {
    "path": "integrator",
    "perspective": "sensor",
    "hdrfilm": "film",
    "box": "rfilter",
    "multijitter": "sampler",
    "bitmap": "texture",
    "area": "emitter",
    "constant": "emitter",
    "envmap": "emitter",
    "obj": "shape",
    "rectangle": "shape",
    "sphere": "shape",
    "disk": "shape",
}


def _plugin(name: str, plugin: dict[str, Any], depth: int) -> list[str]:
    tag, pad = _TAGS.get(plugin["type"], "bsdf"), "    " * depth
    # Mitsuba names nested plugins by ``name``, and those of the scene by ``id``.
    lines = [f'{pad}<{tag} type="{plugin["type"]}" {"id" if depth == 1 else "name"}="{name}">']
    for key, value in plugin.items():
        if key != "type":
            lines += _value(key, value, depth + 1)
    return [*lines, f"{pad}</{tag}>"]


def _value(key: str, value: Any, depth: int) -> list[str]:
    pad = "    " * depth
    if isinstance(value, dict) and value["type"] == "rgb":
        numbers = ", ".join(repr(float(v)) for v in np.broadcast_to(value["value"], 3))
        return [f'{pad}<rgb name="{key}" value="{numbers}"/>']
    if isinstance(value, dict):
        return _plugin(key, value, depth)
    if isinstance(value, (bool, np.bool_)):
        return [f'{pad}<boolean name="{key}" value="{str(bool(value)).lower()}"/>']
    if isinstance(value, int):
        return [f'{pad}<integer name="{key}" value="{value}"/>']
    if isinstance(value, float):
        return [f'{pad}<float name="{key}" value="{value!r}"/>']
    if isinstance(value, str):
        return [f'{pad}<string name="{key}" value="{value}"/>']
    if isinstance(value, list):
        x, y, z = (repr(float(v)) for v in value)
        return [f'{pad}<point name="{key}" x="{x}" y="{y}" z="{z}"/>']
    numbers = " ".join(repr(float(v)) for v in np.array(value.matrix).ravel())
    return [f'{pad}<transform name="{key}">', f'{pad}    <matrix value="{numbers}"/>', f"{pad}</transform>"]


def mitsuba_shapes(folder: Path) -> dict[str, Any]:
    """The face of both scenes, as Mitsuba loads them."""
    found = {}
    for name in (EXACT, STOCK):
        # Shapes come in any order, lamps among them.
        shapes = mi.load_file(str(folder / name)).shapes()
        found[Path(name).stem] = next(shape for shape in shapes if shape.id() == "face")
    return found

"""MaterialX: one OpenPBR surface with its textures, as Blender (4 and newer), USD and Unreal read it.

Written against MaterialX 1.39. Specular weight 1 with index of refraction 1.5 reflects 0.04 at normal incidence,
and the weight scales that; grazing reflectance stays a dielectric's, where ours is scaled as well.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from ..files.obj_text import obj_text
from ..files.pictures import write_text
from ..render.skin_bsdf import F0
from ..surface import Surface
from . import lobe
from .tangents import mikktspace_normals, with_tangents
from .texture_files import encoded_normals, srgb, write_png

FILE = "face.mtlx"

WEIGHT_RANGE = 1.25
"""Specular weight of a white texel: a specular albedo of 0.05."""


def write_materialx(surface: Surface, folder: Path, bits: int) -> dict[str, Any]:
    """Writes ``face.mtlx`` and its textures; returns the asset's description."""
    single = lobe.fit(surface.roughness)
    normals = mikktspace_normals(surface, with_tangents(surface.mesh), surface.specular_normal)
    inside = surface.texels.inside
    textures = folder / "textures"
    write_png(textures / "base_color.png", srgb(surface.maps.diffuse_albedo), 8)
    write_png(textures / "specular_weight.png", surface.specular_albedo / (F0 * WEIGHT_RANGE), 16)
    write_png(textures / "specular_roughness.png", np.sqrt(single.alpha), 16)
    write_png(textures / "normal.png", encoded_normals(normals), bits)
    write_text(folder / FILE, document())
    write_text(folder / "face.obj", obj_text(surface.mesh))
    return {
        "file": FILE,
        "base_color": "diffuse albedo, sRGB (srgb_texture), 8 bit",
        "specular_weight": f"specular albedo / {F0}, a white texel is {WEIGHT_RANGE}; 16 bit",
        "specular_ior": 1.5,
        "specular_roughness": "root of the GGX alpha of one lobe in place of two, 16 bit",
        "geometry_normal": f"specular normal, tangent space (MikkTSpace, +Y), {bits} bit",
        "clipped_base_colours": int((surface.maps.diffuse_albedo[inside] > 1).sum()),
        "lobe_energy_misplaced_mean": float(single.misplaced[inside].mean()),
        "lobe_energy_misplaced_largest": float(single.misplaced[inside].max()),
        "left_out": [
            "diffuse normal: one normal serves both layers",
            "second lobe",
            "the specular albedo's scale of grazing reflectance",
            "diffuse light is reduced by what the surface reflects",
        ],
    }


def document() -> str:
    """The document; equal for all assets, since all that differs is in the textures."""
    root = ElementTree.Element("materialx", version="1.39", colorspace="lin_rec709")
    graph = ElementTree.SubElement(root, "nodegraph", name="face_maps")

    def image(name: str, kind: str, **file: str) -> None:
        node = ElementTree.SubElement(graph, "image", name=name, type=kind)
        ElementTree.SubElement(node, "input", name="file", type="filename", value=f"textures/{name}.png", **file)
        for mode in ("uaddressmode", "vaddressmode"):
            ElementTree.SubElement(node, "input", name=mode, type="string", value="clamp")

    def output(name: str, kind: str, node: str) -> None:
        ElementTree.SubElement(graph, "output", name=f"{name}_out", type=kind, nodename=node)

    image("base_color", "color3", colorspace="srgb_texture")
    image("specular_weight", "float")
    image("specular_roughness", "float")
    image("normal", "vector3")
    scale = ElementTree.SubElement(graph, "multiply", name="weight", type="float")
    ElementTree.SubElement(scale, "input", name="in1", type="float", nodename="specular_weight")
    ElementTree.SubElement(scale, "input", name="in2", type="float", value=str(WEIGHT_RANGE))
    normal_map = ElementTree.SubElement(graph, "normalmap", name="geometry_normal", type="vector3")
    ElementTree.SubElement(normal_map, "input", name="in", type="vector3", nodename="normal")
    output("base_color", "color3", "base_color")
    output("specular_weight", "float", "weight")
    output("specular_roughness", "float", "specular_roughness")
    output("geometry_normal", "vector3", "geometry_normal")

    shader = ElementTree.SubElement(root, "open_pbr_surface", name="skin", type="surfaceshader")
    kinds = {
        "base_color": "color3",
        "specular_weight": "float",
        "specular_roughness": "float",
        "geometry_normal": "vector3",
    }
    for name, kind in kinds.items():
        ElementTree.SubElement(shader, "input", name=name, type=kind, nodegraph="face_maps", output=f"{name}_out")
    for name, value in (("base_weight", 1.0), ("base_metalness", 0.0), ("specular_ior", 1.5)):
        ElementTree.SubElement(shader, "input", name=name, type="float", value=str(value))
    material = ElementTree.SubElement(root, "surfacematerial", name="face", type="material")
    ElementTree.SubElement(material, "input", name="surfaceshader", type="surfaceshader", nodename="skin")
    ElementTree.indent(root)
    return '<?xml version="1.0"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"

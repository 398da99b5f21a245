"""Reads a GLB of one material as a shape for Mitsuba, from its bytes alone, by the specification.

Material: glTF 2.0, appendix B, with KHR_materials_ior and KHR_materials_specular. Nothing of the exporter is
used but the shape of its file: one mesh, textures inside.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import mitsuba as mi
import numpy as np

from ..files import glb
from ..own_head.gltf_accessor import Accessors
from ..render.scene import mesh_shape
from ..srgb import decoded
from ..surface import Mesh
from .layered_bsdf import texture


def gltf_shape(path: Path) -> Any:
    """The face of ``path`` as a Mitsuba mesh with its material."""
    document, binary = glb.unpacked(path.read_bytes())
    accessors = Accessors(document, [binary])
    primitive = document["meshes"][0]["primitives"][0]
    attributes = primitive["attributes"]
    uv = accessors.read(attributes["TEXCOORD_0"], 2)
    mesh = Mesh(
        accessors.read(attributes["POSITION"], 3),
        accessors.read(attributes["NORMAL"], 3),
        np.stack([uv[:, 0], 1 - uv[:, 1]], 1),
        accessors.read_indices(primitive["indices"]).reshape(-1, 3),
    )
    material = document["materials"][primitive["material"]]
    plain, extensions = material["pbrMetallicRoughness"], material["extensions"]
    glint = extensions["KHR_materials_specular"]

    def codes(reference: dict[str, int]) -> np.ndarray:
        image = document["images"][document["textures"][reference["index"]]["source"]]
        view = document["bufferViews"][image["bufferView"]]
        start = view.get("byteOffset", 0)
        return _picture(bytes(binary[start : start + view["byteLength"]]))

    rough = codes(plain["metallicRoughnessTexture"])[..., 1] * plain["roughnessFactor"]
    ior = extensions["KHR_materials_ior"]["ior"]
    bsdf = mi.load_dict(
        {
            "type": "layered",
            "reflectance": ((ior - 1) / (ior + 1)) ** 2,
            "diffuse": texture(decoded(codes(plain["baseColorTexture"]))),
            "specular": texture(codes(glint["specularTexture"])[..., 3] * glint["specularFactor"]),
            # The material's alpha is the square of what the texture holds, filtered before.
            "perceptual_roughness": texture(rough),
            "tangent_normal": texture(codes(material["normalTexture"])),
            "tangent": {"type": "mesh_attribute", "name": "vertex_tangent"},
            "tangent_sign": {"type": "mesh_attribute", "name": "vertex_tangent_sign"},
        }
    )
    shape = mesh_shape("chart", mesh, bsdf, uv=mesh.uv)
    tangents = accessors.read(attributes["TANGENT"], 4).astype(np.float32)
    shape.add_attribute("vertex_tangent", 3, np.ascontiguousarray(tangents[:, :3]).ravel())
    shape.add_attribute("vertex_tangent_sign", 1, np.ascontiguousarray(tangents[:, 3]))
    return shape


def _picture(data: bytes) -> np.ndarray:
    """Codes 0 to 1 (N,N,C) of a PNG of 8 or 16 bits."""
    stream = mi.MemoryStream()
    stream.write(data)
    stream.seek(0)
    samples = np.array(mi.Bitmap(stream))
    return samples.astype(np.float32) / np.iinfo(samples.dtype).max

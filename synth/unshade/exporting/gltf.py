"""glTF 2.0 as one GLB, with KHR_materials_ior and KHR_materials_specular.

Base colour 8 bit sRGB, perceptual roughness (the root of alpha) in green, specular strength in alpha, and a
normal map against the MikkTSpace tangents that stand in the file. Texture row 0 is at v = 0 there, so v is
turned; the bitangent's sign and green keep meaning up the picture.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..files import glb
from ..files.pictures import write_bytes
from ..surface import Surface
from ..vectors import unit
from . import lobe
from .dielectric import dielectric
from .tangents import TangentMesh, mikktspace_normals, with_tangents
from .texture_files import encoded_normals, png_bytes, srgb

FILE = "face.glb"

_FLOAT, _UNSIGNED = 5126, 5125
_VERTICES, _INDICES = 34962, 34963
_LINEAR, _LINEAR_MIPMAPS, _CLAMP = 9729, 9987, 33071


def write_gltf(surface: Surface, folder: Path, bits: int, generator: str) -> dict[str, Any]:
    """Writes ``face.glb``; ``bits`` of its normal map. Returns the asset's description."""
    mesh = with_tangents(surface.mesh)
    glint = dielectric(surface.specular_albedo, surface.texels.inside)
    single = lobe.fit(surface.roughness)
    inside = surface.texels.inside
    ones = np.ones((surface.size, surface.size, 3), np.float32)
    rough = np.stack([np.zeros_like(single.alpha), np.sqrt(single.alpha), np.zeros_like(single.alpha)], -1)
    normals = mikktspace_normals(surface, mesh, surface.specular_normal)
    base = surface.maps.diffuse_albedo / (1 - glint.taken[..., None])
    textures = {
        "base_colour": png_bytes(srgb(base), 8),
        "roughness": png_bytes(rough, 8),
        "normal": png_bytes(encoded_normals(normals), bits),
        "specular": png_bytes(np.concatenate([ones, glint.strength[..., None]], -1), 8),
    }
    write_bytes(folder / FILE, _glb(mesh, textures, glint.ior, generator))
    return {
        "file": FILE,
        "extensions": ["KHR_materials_ior", "KHR_materials_specular"],
        "base_colour": "diffuse albedo / (1 - the share that glTF reflects before), sRGB, 8 bit",
        "clipped_base_colours": int((base[inside] > 1).sum()),
        "ior": glint.ior,
        "specular_strength": f"specular albedo / {glint.reflectance:.4f}, in alpha, 8 bit",
        "roughness": "root of the GGX alpha of one lobe in place of two, 8 bit",
        "lobe_energy_misplaced_mean": float(single.misplaced[inside].mean()),
        "lobe_energy_misplaced_largest": float(single.misplaced[inside].max()),
        "normal": f"specular normal, tangent space (MikkTSpace, +Y), {bits} bit",
        "left_out": ["diffuse normal: one normal serves both layers", "second lobe"],
    }


def _glb(mesh: TangentMesh, textures: dict[str, bytes], ior: float, generator: str) -> bytes:
    binary = bytearray()
    views: list[dict[str, Any]] = []

    def view(data: bytes, **more: int) -> int:
        binary.extend(b"\0" * (-len(binary) % 4))
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data), **more})
        binary.extend(data)
        return len(views) - 1

    def accessor(values: np.ndarray, kind: str, **more: Any) -> dict[str, Any]:
        index = values.dtype.kind == "u"
        data = np.ascontiguousarray(values, "<u4" if index else "<f4").tobytes()
        number = view(data, target=_INDICES if index else _VERTICES)
        return {
            "bufferView": number,
            "componentType": _UNSIGNED if index else _FLOAT,
            "count": len(values),
            "type": kind,
            **more,
        }

    shape = mesh.mesh
    ends = {"min": shape.vertices.min(0).tolist(), "max": shape.vertices.max(0).tolist()}
    accessors = [
        accessor(shape.vertices, "VEC3", **ends),
        accessor(unit(shape.normals.astype(np.float64)), "VEC3"),
        accessor(
            np.column_stack([unit(mesh.tangents[:, :3].astype(np.float64)).astype(np.float32), mesh.tangents[:, 3]]),
            "VEC4",
        ),
        accessor(np.column_stack([shape.uv[:, 0], 1 - shape.uv[:, 1]]), "VEC2"),
        accessor(shape.triangles.astype(np.uint32).ravel(), "SCALAR"),
    ]
    images = [{"name": name, "mimeType": "image/png", "bufferView": view(data)} for name, data in textures.items()]
    number = {name: {"index": i} for i, name in enumerate(textures)}
    document = {
        "asset": {"version": "2.0", "generator": generator},
        "extensionsUsed": ["KHR_materials_ior", "KHR_materials_specular"],
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "face", "mesh": 0}],
        "meshes": [
            {
                "name": "face",
                "primitives": [
                    {
                        "attributes": {"POSITION": 0, "NORMAL": 1, "TANGENT": 2, "TEXCOORD_0": 3},
                        "indices": 4,
                        "material": 0,
                    }
                ],
            }
        ],
        "materials": [
            {
                "name": "skin",
                "pbrMetallicRoughness": {
                    "baseColorTexture": number["base_colour"],
                    "metallicFactor": 0.0,
                    "roughnessFactor": 1.0,
                    "metallicRoughnessTexture": number["roughness"],
                },
                "normalTexture": number["normal"],
                "extensions": {
                    "KHR_materials_ior": {"ior": ior},
                    "KHR_materials_specular": {"specularFactor": 1.0, "specularTexture": number["specular"]},
                },
            }
        ],
        "textures": [{"sampler": 0, "source": i} for i in range(len(textures))],
        "samplers": [{"magFilter": _LINEAR, "minFilter": _LINEAR_MIPMAPS, "wrapS": _CLAMP, "wrapT": _CLAMP}],
        "images": images,
        "accessors": accessors,
        "bufferViews": views,
    }
    return glb.packed(document, bytes(binary))

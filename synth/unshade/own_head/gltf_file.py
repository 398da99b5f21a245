"""The triangles of a glTF 2.0 file, as its scene shows them: the shape of the default morph weights, in the pose of the
joints or under the nodes' transforms."""

from __future__ import annotations

import base64
import json
import warnings
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..face.spec import FaceError
from ..files import glb
from .gltf_accessor import Accessors, item
from .gltf_node import local_transform
from .gltf_skin import Skins
from .gltf_uv import UvPlacement, uv_placement
from .piece import Piece
from .spec import MeshWarning

_NO_GEOMETRY = (
    "KHR_mesh_quantization",
    "KHR_materials_",
    "KHR_texture_",
    "EXT_texture_",
    "MSFT_texture_",
    "KHR_lights_",
    "EXT_lights_",
    "KHR_xmp",
)
"""Beginnings of extensions that a reader of shapes may leave out; `KHR_mesh_quantization` and
`KHR_texture_transform` are read."""

_FIXES = {
    "KHR_draco_mesh_compression": "export it without compression",
    "EXT_meshopt_compression": "export it without compression (gltfpack without -c)",
}

_MAX_VERTICES = 1 << 25
"""Most vertices of all objects together: instances may ask for more than any memory holds."""

_TRIANGLES, _STRIP, _FAN = 4, 5, 6


def read_gltf(path: Path) -> list[Piece]:
    """All objects of a file; several of one name where a node's mesh has several primitives.

    Raises `FaceError` for what is named there, and anything for files that are damaged.
    """
    document, binary = _binary(path) if path.suffix.lower() == ".glb" else (json.loads(path.read_bytes()), None)
    if not isinstance(document, dict):
        raise FaceError(f"{path}: is not glTF 2.0; export it again")
    _check_extensions(path, document)
    accessors = Accessors(document, _buffers(path, document, binary))
    skins = Skins(document, accessors)
    pieces, vertices = [], 0
    for name, transform, node in _nodes(document):
        if "EXT_mesh_gpu_instancing" in node.get("extensions", {}):
            raise FaceError(f"{path}: object {name!r} is drawn by EXT_mesh_gpu_instancing; export single objects")
        mesh = item(document, "meshes", node["mesh"])
        weights = node.get("weights", mesh.get("weights", []))
        for primitive in mesh["primitives"]:
            if primitive.get("mode", _TRIANGLES) not in (_TRIANGLES, _STRIP, _FAN):
                warnings.warn(f"{path}: points and lines of object {name!r} are left out", MeshWarning, stacklevel=2)
                continue
            vertices += item(document, "accessors", primitive["attributes"]["POSITION"])["count"]
            if vertices > _MAX_VERTICES:
                raise FaceError(f"{path}: has more than {_MAX_VERTICES} vertices; export a smaller mesh")
            material = item(document, "materials", primitive["material"]) if "material" in primitive else {}
            placement = uv_placement(path, material, primitive.get("material"))
            shape = _shape(path, name, primitive, weights, placement, accessors)
            if "skin" in node:
                shape = skins.posed(path, name, node["skin"], primitive, shape)
            else:
                shape = _moved(name, transform, shape)
            words = (
                f"material {json.dumps(material.get('name', primitive['material']))}"
                if material
                else f"object {json.dumps(name)}"
            )
            pieces.append(Piece(name, *shape, [words], np.zeros(len(shape.triangles), np.int64)))
    return pieces


def _check_extensions(path: Path, document: dict[str, Any]) -> None:
    """Refuses required extensions that would change the shape, and names others that are not read."""
    required = document.get("extensionsRequired", [])
    unknown = [name for name in map(str, document.get("extensionsUsed", [])) if not name.startswith(_NO_GEOMETRY)]
    for name in required:
        if not str(name).startswith(_NO_GEOMETRY):
            raise FaceError(
                f"{path}: requires the extension {name}, which is not read; {_FIXES.get(name, 'export it without')}"
            )
    for name in unknown:
        if name not in _FIXES:  # whose fallback, if there is none, is found empty
            text = f"{path}: uses the extension {name[:80]}, which is not read; the mesh is taken without it"
            warnings.warn(text, MeshWarning, stacklevel=3)


def _binary(path: Path) -> tuple[Any, bytes | None]:
    """The document and the buffer of a GLB."""
    try:
        return glb.unpacked(path.read_bytes())
    except ValueError as error:
        raise FaceError(f"{path}: {error}; copy or export it again") from error


def _buffers(path: Path, document: dict[str, Any], binary: bytes | None) -> list[bytes | None]:
    """The bytes of every buffer; None for one that a compression leaves empty."""
    buffers = []
    for number, buffer in enumerate(document.get("buffers", [])):
        uri = buffer.get("uri")
        if uri is None:
            buffers.append(binary if number == 0 else None)
        elif uri.startswith("data:"):
            buffers.append(base64.b64decode(uri.partition(",")[2]))
        else:
            # One file is what a capture copies and a run hashes.
            raise FaceError(f"{path}: keeps its data in other files; export it as one .glb")
    return buffers


def _nodes(document: dict[str, Any]) -> list[tuple[str, np.ndarray, dict[str, Any]]]:
    """Name, transform [4, 4] to the scene, and node, of all nodes with a mesh that the scene shows."""
    nodes = document.get("nodes", [])
    names: list[str] = []
    counts: dict[str, int] = {}
    for number, node in enumerate(nodes):
        name = str(node.get("name", number))
        while name in counts:
            counts[name] += 1
            name = f"{name}_{counts[name]}"
        counts[name] = 0
        names.append(name)
    if document.get("scenes"):
        roots = item(document, "scenes", document.get("scene", 0)).get("nodes", [])
    else:
        children = {child for node in nodes for child in node.get("children", [])}
        roots = [number for number in range(len(nodes)) if number not in children]
    shown, seen = [], set()
    waiting = [(number, np.eye(4)) for number in reversed(roots)]
    while waiting:
        number, above = waiting.pop()
        node = item(document, "nodes", number)
        if number in seen:
            raise ValueError(f"node {number} stands in the scene twice")
        seen.add(number)
        transform = above @ local_transform(node)
        if "mesh" in node:
            shown.append((names[number], transform, node))
        waiting += [(child, transform) for child in reversed(node.get("children", []))]
    return shown


class Shape(NamedTuple):
    """`vertices` (V,3), `triangles` (F,3), `uv` (V,2) v up, `normals` (V,3)."""

    vertices: np.ndarray
    triangles: np.ndarray
    uv: np.ndarray | None
    normals: np.ndarray | None


def _shape(
    path: Path, name: str, primitive: dict[str, Any], weights: list[float], placement: UvPlacement, accessors: Accessors
) -> Shape:
    """A primitive in its own space, in the shape of its morph weights."""
    attributes = primitive["attributes"]
    if accessors.is_empty(attributes["POSITION"]):
        known = [extension for extension in primitive.get("extensions", {}) if extension in _FIXES]
        fix = _FIXES[known[0]] if known else "export it again"
        raise FaceError(f"{path}: object {name!r} holds no positions{f' but {known[0]}' if known else ''}; {fix}")
    targets = [(target, weight) for target, weight in zip(primitive.get("targets", []), weights) if weight]

    def morphed(key: str, width: int) -> np.ndarray | None:
        if key not in attributes:
            return None
        values = accessors.read(attributes[key], width).astype(np.float64)
        for target, weight in targets:
            if key in target:
                values = values + weight * accessors.read(target[key], width)
        return values

    vertices, normals, uv = morphed("POSITION", 3), morphed("NORMAL", 3), morphed(f"TEXCOORD_{placement.number}", 2)
    if uv is None and placement.number:
        raise FaceError(
            f"{path}: the textures of object {name!r} lie on TEXCOORD_{placement.number}, which it lacks; export it again"
        )
    if uv is not None:
        uv = placement.applied(uv)
        uv[:, 1] = 1 - uv[:, 1]  # glTF counts v downwards
    for what, values in (("normals", normals), ("uvs", uv)):
        if values is not None and len(values) != len(vertices):
            raise ValueError(f"object {name!r} has {len(vertices)} vertices, but {len(values)} {what}")
    corners = accessors.read_indices(primitive["indices"]) if "indices" in primitive else np.arange(len(vertices))
    if len(corners) and corners.max() >= len(vertices):
        raise ValueError(f"object {name!r} has {len(vertices)} vertices, but an index of {corners.max()}")
    return Shape(vertices, _triangles(corners, primitive.get("mode", _TRIANGLES)), uv, normals)


def _moved(name: str, transform: np.ndarray, shape: Shape) -> Shape:
    """A shape under the transform [4, 4] of its node."""
    linear = transform[:3, :3]
    determinant = np.linalg.det(linear)
    if not (np.isfinite(transform).all() and determinant != 0):
        raise ValueError(f"the nodes above object {name!r} scale it to nothing")
    triangles = shape.triangles[:, ::-1] if determinant < 0 else shape.triangles
    normals = None if shape.normals is None else shape.normals @ np.linalg.inv(linear)
    return Shape(shape.vertices @ linear.T + transform[:3, 3], triangles, shape.uv, normals)


def _triangles(corners: np.ndarray, mode: int) -> np.ndarray:
    if mode == _TRIANGLES:
        if len(corners) % 3:
            raise ValueError(f"{len(corners)} indices do not form triangles")
        return corners.reshape(-1, 3)
    count = max(len(corners) - 2, 0)
    if mode == _FAN:
        return np.stack([np.broadcast_to(corners[:1], count), corners[1 : 1 + count], corners[2 : 2 + count]], 1)
    strip = np.stack([corners[k : k + count] for k in range(3)], 1)
    strip[1::2] = strip[1::2, [1, 0, 2]]
    return strip

"""The triangles of a glTF 2.0 file, as its scene shows them: the shape of the default morph weights, under the nodes' transforms."""

from __future__ import annotations

import base64
import json
import struct
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..face.spec import FaceError
from .gltf_accessor import Accessors, item

_JSON_CHUNK, _BINARY_CHUNK = 0x4E4F534A, 0x004E4942
"""Types of a GLB's chunks (glTF 2.0 specification, 4.4.3)."""

_NO_GEOMETRY = (
    "KHR_mesh_quantization",
    "KHR_materials_",
    "KHR_texture_",
    "EXT_texture_",
    "KHR_lights_",
    "EXT_lights_",
    "KHR_xmp",
)
"""Beginnings of extensions that a reader of shapes may leave out; the first one is read."""

_MENDS = {
    "KHR_draco_mesh_compression": "export it without compression",
    "EXT_meshopt_compression": "export it without compression (gltfpack without -c)",
}

_MAX_VERTICES = 1 << 25
"""Most vertices of all objects together: instances may ask for more than any memory holds."""

_TRIANGLES, _STRIP, _FAN = 4, 5, 6


class Surface(NamedTuple):
    """Triangles of a primitive: the node's name, `vertices` (V,3), `triangles` (F,3), `uv` (V,2) v up, `normals` (V,3)."""

    name: str
    vertices: np.ndarray
    triangles: np.ndarray
    uv: np.ndarray | None
    normals: np.ndarray | None


def read_gltf(path: Path) -> list[Surface]:
    """All surfaces of a file; several of one name where a node's mesh has several primitives.

    Raises `FaceError` for what is named there, and anything for files that are damaged.
    """
    document, binary = _binary(path) if path.suffix.lower() == ".glb" else (json.loads(path.read_bytes()), None)
    if not isinstance(document, dict):
        raise FaceError(f"{path}: is no glTF 2.0; export it again")
    for name in document.get("extensionsRequired", []):
        if not str(name).startswith(_NO_GEOMETRY):
            raise FaceError(
                f"{path}: requires the extension {name}, which is not read; {_MENDS.get(name, 'export it without')}"
            )
    accessors = Accessors(document, _buffers(path, document, binary))
    surfaces, vertices = [], 0
    for name, transform, node in _nodes(document):
        mesh = item(document, "meshes", node["mesh"])
        weights = node.get("weights", mesh.get("weights", []))
        for primitive in mesh["primitives"]:
            if primitive.get("mode", _TRIANGLES) not in (_TRIANGLES, _STRIP, _FAN):
                continue  # points and lines are no surface
            vertices += item(document, "accessors", primitive["attributes"]["POSITION"])["count"]
            if vertices > _MAX_VERTICES:
                raise FaceError(f"{path}: has more than {_MAX_VERTICES} vertices; export a smaller mesh")
            surfaces.append(_surface(path, name, transform, primitive, weights, accessors))
    return surfaces


def _binary(path: Path) -> tuple[Any, bytes | None]:
    """The document and the buffer of a GLB."""
    data = path.read_bytes()
    if data[:4] != b"glTF" or len(data) < 20 or struct.unpack_from("<I", data, 4)[0] != 2:
        raise FaceError(f"{path}: is no binary glTF 2.0; export it again")
    chunks, at = {}, 12
    while at + 8 <= len(data):
        length, kind = struct.unpack_from("<II", data, at)
        if at + 8 + length > len(data):
            raise FaceError(f"{path}: ends within a chunk of {length} bytes; copy or export it again")
        chunks.setdefault(kind, data[at + 8 : at + 8 + length])
        at += 8 + length
    if _JSON_CHUNK not in chunks:
        raise FaceError(f"{path}: is no binary glTF 2.0; export it again")
    return json.loads(chunks[_JSON_CHUNK]), chunks.get(_BINARY_CHUNK)


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
        transform = above @ _transform(node)
        if "mesh" in node:
            shown.append((names[number], transform, node))
        waiting += [(child, transform) for child in reversed(node.get("children", []))]
    return shown


def _transform(node: dict[str, Any]) -> np.ndarray:
    matrix = np.eye(4)
    if "matrix" in node:
        matrix = np.array(node["matrix"], np.float64).reshape(4, 4).T
    if "translation" in node:
        moved = np.eye(4)
        moved[:3, 3] = node["translation"]
        matrix = matrix @ moved
    if "rotation" in node:
        x, y, z, w = np.array(node["rotation"], np.float64) / np.linalg.norm(node["rotation"])
        rotated = np.eye(4)
        rotated[:3, :3] = [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
        matrix = matrix @ rotated
    if "scale" in node:
        matrix = matrix @ np.diag([*node["scale"], 1.0])
    return matrix


def _surface(
    path: Path, name: str, transform: np.ndarray, primitive: dict[str, Any], weights: list[float], accessors: Accessors
) -> Surface:
    attributes = primitive["attributes"]
    if accessors.is_empty(attributes["POSITION"]):
        known = [extension for extension in primitive.get("extensions", {}) if extension in _MENDS]
        mend = _MENDS[known[0]] if known else "export it again"
        raise FaceError(f"{path}: object {name!r} holds no positions{f' but {known[0]}' if known else ''}; {mend}")
    vertices = accessors.read(attributes["POSITION"], 3).astype(np.float64)
    normals = accessors.read(attributes["NORMAL"], 3).astype(np.float64) if "NORMAL" in attributes else None
    for target, weight in zip(primitive.get("targets", []), weights):
        if weight and "POSITION" in target:
            vertices = vertices + weight * accessors.read(target["POSITION"], 3)
        if weight and "NORMAL" in target and normals is not None:
            normals = normals + weight * accessors.read(target["NORMAL"], 3)
    uv = None
    if "TEXCOORD_0" in attributes:
        uv = accessors.read(attributes["TEXCOORD_0"], 2).copy()
        uv[:, 1] = 1 - uv[:, 1]  # glTF counts v downwards
        uv = uv.astype(np.float64)
    for what, values in (("normals", normals), ("uvs", uv)):
        if values is not None and len(values) != len(vertices):
            raise ValueError(f"object {name!r} has {len(vertices)} vertices, but {len(values)} {what}")
    corners = accessors.read_indices(primitive["indices"]) if "indices" in primitive else np.arange(len(vertices))
    if len(corners) and corners.max() >= len(vertices):
        raise ValueError(f"object {name!r} has {len(vertices)} vertices, but an index of {corners.max()}")
    triangles = _triangles(corners, primitive.get("mode", _TRIANGLES))
    linear = transform[:3, :3]
    determinant = np.linalg.det(linear)
    if not (np.isfinite(transform).all() and determinant != 0):
        raise ValueError(f"the nodes above object {name!r} scale it to nothing")
    if determinant < 0:
        triangles = triangles[:, ::-1]
    if normals is not None:
        normals = normals @ np.linalg.inv(linear)
    return Surface(name, vertices @ linear.T + transform[:3, 3], triangles, uv, normals)


def _triangles(corners: np.ndarray, mode: int) -> np.ndarray:
    if mode == _TRIANGLES:
        if len(corners) % 3:
            raise ValueError(f"{len(corners)} indices are no triangles")
        return corners.reshape(-1, 3)
    count = max(len(corners) - 2, 0)
    if mode == _FAN:
        return np.stack([np.broadcast_to(corners[:1], count), corners[1 : 1 + count], corners[2 : 2 + count]], 1)
    strip = np.stack([corners[k : k + count] for k in range(3)], 1)
    strip[1::2] = strip[1::2, [1, 0, 2]]
    return strip

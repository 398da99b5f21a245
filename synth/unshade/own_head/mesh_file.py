"""Reads OBJ and glTF files into triangle meshes with one uv per vertex."""

from __future__ import annotations

import dataclasses
import io
import json
import re
import struct
from pathlib import Path
from typing import Any

import numpy as np
import trimesh

from ..face.spec import FaceError

_JSON_CHUNK = 0x4E4F534A
"""Type of a GLB's JSON chunk (glTF 2.0 specification, 4.4.3)."""


@dataclasses.dataclass(frozen=True)
class Piece:
    """One object of a file, in the file's units and axes.

    `vertices` (V,3) f64, `triangles` (F,3) i64, `uv` (V,2) f64 (v up) and `normals` (V,3)
    f64 where the file has them. Vertices are split where uvs or normals are.
    """

    name: str
    vertices: np.ndarray
    triangles: np.ndarray
    uv: np.ndarray | None
    normals: np.ndarray | None


def read_pieces(path: Path) -> list[Piece]:
    """All objects of a mesh file in order of their names; quads and polygons become triangles.

    Raises `FaceError` for files that are no mesh.
    """
    try:
        scene = _load_obj(path) if path.suffix.lower() == ".obj" else _load_gltf(path)
        pieces = [_piece(scene, node) for node in sorted(scene.graph.nodes_geometry)]
    except FaceError:
        raise
    except Exception as error:  # whatever a loader meets in a broken file
        raise FaceError(f"{path}: cannot be read as a mesh: {_line(error)}; export it again") from error
    if not pieces:
        raise FaceError(f"{path}: holds no faces; export the mesh with its polygons")
    for piece in pieces:
        if not np.isfinite(piece.vertices).all():
            bad = int((~np.isfinite(piece.vertices).all(axis=1)).sum())
            raise FaceError(f"{path}: {bad} vertices of {piece.name!r} are not finite; remove them")
    return pieces


def _load_obj(path: Path) -> trimesh.Scene:
    text = path.read_text(encoding="utf-8", errors="replace")
    first_face = re.search(r"^f\s", text, re.MULTILINE)
    relative = re.search(r"^f\s.*(?:\s|/)-\d", text, re.MULTILINE)
    if first_face and relative and re.search(r"^vt?n?\s", text[first_face.start() :], re.MULTILINE):
        # The loader counts negative indices from the end of the file, not from the face.
        raise FaceError(f"{path}: has negative indices between its vertices; export it with absolute ones")
    return trimesh.load_scene(
        io.StringIO(text), file_type="obj", process=False,
        # With maintain_order, the loader would join the two sides of every seam of the UVs.
        maintain_order=False, skip_materials=True, group_material=False, split_objects=True,
    )  # fmt: skip


def _load_gltf(path: Path) -> trimesh.Scene:
    data = path.read_bytes()
    binary = path.suffix.lower() == ".glb"
    if binary:
        length, kind = struct.unpack("<II", data[12:20])
        if kind != _JSON_CHUNK:
            raise FaceError(f"{path}: is no binary glTF 2.0; export it again")
        text = _plain(path, json.loads(data[20 : 20 + length]))
        text += b" " * (-len(text) % 4)
        rest = data[20 + length :]
        head = struct.pack("<4sII", b"glTF", 2, 20 + len(text) + len(rest))
        data = head + struct.pack("<II", len(text), _JSON_CHUNK) + text + rest
    else:
        data = _plain(path, json.loads(data))
    return trimesh.load_scene(io.BytesIO(data), file_type="glb" if binary else "gltf", process=False)


def _plain(path: Path, document: dict[str, Any]) -> bytes:
    """The document with one bare material for all.

    The loader drops the uvs of primitives that have none, and would decode pictures that
    nobody asked for.
    """
    for mesh in document.get("meshes", []):
        for primitive in mesh.get("primitives", []):
            primitive["material"] = 0
    if any("uri" in buffer and not buffer["uri"].startswith("data:") for buffer in document.get("buffers", [])):
        # One file is what a capture copies and a run hashes.
        raise FaceError(f"{path}: keeps its data in other files; export it as one .glb")
    kept = {key: value for key, value in document.items() if key not in ("images", "textures", "samplers")}
    return json.dumps(kept | {"materials": [{"name": "plain"}]}).encode()


def _piece(scene: trimesh.Scene, node: str) -> Piece:
    transform, key = scene.graph[node]
    mesh = scene.geometry[key]
    if not isinstance(mesh, trimesh.Trimesh):
        raise FaceError(f"object {node!r} holds no polygons but {type(mesh).__name__}; remove it")
    linear = transform[:3, :3]
    triangles = np.asarray(mesh.faces, dtype=np.int64)
    if np.linalg.det(linear) < 0:
        triangles = triangles[:, ::-1]
    # Only normals of the file lie in the cache so early; the property would compute them unwelded.
    normals = mesh.vertex_normals @ np.linalg.inv(linear) if "vertex_normals" in mesh._cache else None
    uv = getattr(mesh.visual, "uv", None)
    vertices = np.asarray(mesh.vertices) @ linear.T + transform[:3, 3]
    return Piece(node if node != "world" else key, vertices, triangles, None if uv is None else np.asarray(uv, dtype=np.float64), normals)


def _line(error: Exception) -> str:
    text = " ".join(str(error).split())
    return text[:160] or type(error).__name__

"""The mesh of an imported capture: read, cut to the face's objects, moved, and written again."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .. import _native
from ..errors import CaptureError
from ..vectors import triangle_normals
from .source import Matrix
from .unwrap import unwrap


@dataclass(frozen=True)
class ChartMesh:
    """Triangles with a UV at every vertex; ``normals`` are None where the file has none.

    ``verbatim`` are the file's bytes while nothing of it was changed; ``has_own_uv`` is False if it has no texture
    coordinates (``uv`` is 0), or they were made here. ``parts`` are its materials (or objects)
    in words, ``part_of`` (F,) which of them each triangle is of.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64]
    uv: NDArray[np.float64]
    normals: NDArray[np.float64] | None
    verbatim: bytes | None
    parts: tuple[str, ...]
    part_of: NDArray[np.int64]
    has_own_uv: bool = True

    def moved(self, similarity: Matrix) -> ChartMesh:
        """The mesh after a similarity (4, 4)."""
        linear = similarity[:3, :3]
        scale = np.cbrt(abs(np.linalg.det(linear)))
        normals = None if self.normals is None else self.normals @ (linear / scale).T
        vertices = self.vertices @ linear.T + similarity[:3, 3]
        return replace(self, vertices=vertices, normals=normals, verbatim=None)

    def unwrapped(self) -> ChartMesh:
        """The same surface with new texture coordinates in few islands."""
        rows, triangles, uv = unwrap(self.vertices, self.triangles)
        normals = None if self.normals is None else self.normals[rows]
        return replace(
            self,
            vertices=self.vertices[rows],
            triangles=triangles,
            uv=uv,
            normals=normals,
            verbatim=None,
            has_own_uv=False,
        )

    def layout_faults(self, used: NDArray[np.bool_] | None = None) -> tuple[str | None, str | None, bool, int]:
        """The fault of the UV layout of the triangles that are ``used`` (F,), a warning, whether
        materials lie over each other, and the number of islands that hold most of the area."""
        used = np.ones(len(self.triangles), bool) if used is None else used
        triangles, part_of = (np.ascontiguousarray(values[used]) for values in (self.triangles, self.part_of))
        return _native.examine_layout(self.vertices, self.uv, triangles, part_of, self.parts)

    def text(self) -> bytes:
        """An OBJ file."""
        if self.verbatim is not None:
            return self.verbatim
        lines = ["# imported: metres, +Y up, looking along +Z"]
        normals = np.zeros((0, 3)) if self.normals is None else self.normals
        for keyword, values in (("v", self.vertices), ("vt", self.uv), ("vn", normals)):
            form = keyword + " %.9g" * values.shape[1]
            lines += [form % tuple(row) for row in values.tolist()]
        corner = "%d/%d" if self.normals is None else "%d/%d/%d"
        form = " ".join(["f", corner, corner, corner])
        each = 2 if self.normals is None else 3
        corners = np.repeat(self.triangles + 1, each, axis=1)
        lines += [form % tuple(row) for row in corners.tolist()]
        return ("\n".join(lines) + "\n").encode()


def read_mesh(path: Path, objects: tuple[str, ...] = ()) -> ChartMesh:
    """Reads an OBJ file; of its objects those named, or all. Raises `CaptureError`."""
    if path.suffix.lower() != ".obj":
        raise CaptureError(f"{path}: is not an OBJ file; export the mesh as OBJ with its texture coordinates")
    try:
        data = path.read_bytes()
        pieces = _native.read_obj(data)
    except OSError as error:
        raise CaptureError(f"{path}: cannot be read: {error.strerror}; name the mesh, an OBJ file") from error
    except ValueError as error:
        raise CaptureError(f"{path}: {error}; export the mesh again") from error
    names = [piece["name"] for piece in pieces]
    for name in objects:
        if name not in names:
            raise CaptureError(f"{path}: has no object {name!r}; there are {', '.join(map(repr, names))}")
    chosen = [piece for piece in pieces if not objects or piece["name"] in objects]
    if not any(len(piece["triangles"]) for piece in chosen):
        raise CaptureError(f"{path}: has no triangles; export the mesh with its surface")
    vertices, uvs, triangles, normals, part_of, start = [], [], [], [], [], 0
    parts: dict[str, int] = {}
    has_own_uv = any(piece["uv"] is not None for piece in chosen)
    for piece in chosen:
        uv = piece["uv"] if has_own_uv else np.zeros((len(piece["vertices"]), 2))
        if uv is None:
            raise CaptureError(
                f"{path}: object {piece['name']!r} has no texture coordinates; unwrap it, or name the objects of the face"
            )
        vertices.append(piece["vertices"])
        uvs.append(uv)
        triangles.append(piece["triangles"] + start)
        normals.append(piece["normals"])
        numbers = np.array([parts.setdefault(part, len(parts)) for part in piece["parts"]], np.int64)
        part_of.append(numbers[piece["part_of"]])
        start += len(piece["vertices"])
    given = [n for n in normals if n is not None]
    joined = np.concatenate(vertices)
    if not np.isfinite(joined).all():
        raise CaptureError(f"{path}: has a vertex that is not finite; export the mesh again")
    return ChartMesh(
        joined,
        np.concatenate(triangles),
        np.concatenate(uvs),
        np.concatenate(given) if len(given) == len(normals) else None,
        data if len(chosen) == len(pieces) else None,
        tuple(parts),
        np.concatenate(part_of),
        has_own_uv,
    )


def smooth_normals(vertices: NDArray[np.float64], triangles: NDArray[np.int64]) -> NDArray[np.float64]:
    """Normals (V,3) by area, one for all vertices of one place: seams of the UV are none of the surface. Not unit."""
    place = np.unique(vertices, axis=0, return_inverse=True)[1].ravel()
    facing, normals = triangle_normals(vertices, triangles), np.zeros_like(vertices)
    for corner in range(3):
        np.add.at(normals, place[triangles[:, corner]], facing)
    return normals[place]

"""A head in no way like the generated one, written by hand as OBJ and as GLB.

Centimetres, z up, looking along -y, far from the origin; three UV islands, one turned and
one mirrored; quads, triangles and a hexagon; a collar without UV.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

from unshade.files import glb

STEPS = 24
OFFSET = np.array([4.0, -30.0, 150.0])
"""Where the file has what is to become the world's origin (cm)."""

TABLE = {
    "name": "scan",
    "units": "cm",
    "up": "+z",
    "forward": "-y",
    "origin": OFFSET.tolist(),
    "chart": ["head"],
    "texture_size": 128,
}

MARKS = {
    # place on the head (s, t from 0 to 1) and sRGB colour of its texels; two on every island
    (0.22, 0.30): (220, 40, 40), (0.38, 0.74): (40, 220, 40),
    (0.64, 0.78): (40, 40, 220), (0.80, 0.62): (220, 220, 40),
    (0.62, 0.26): (40, 220, 220), (0.78, 0.38): (220, 40, 220),
}  # fmt: skip


def place(s, t) -> np.ndarray:
    """World position (m) of a place on the head: s from its right to its left, t upwards."""
    s, t = np.asarray(s, float), np.asarray(t, float)
    azimuth, elevation = (s - 0.5) * 2.6, (t - 0.5) * 2.2
    level = np.cos(elevation)
    nose = 1 + 0.25 * np.exp(-((azimuth / 0.25) ** 2) - (elevation / 0.3) ** 2)
    return np.stack(
        [0.08 * level * np.sin(azimuth) * nose, 0.11 * np.sin(elevation) * nose, 0.09 * level * np.cos(azimuth) * nose],
        -1,
    )


def uv_of(island: int, s, t) -> np.ndarray:
    """UV (v up) of a place on one of the islands: right half, upper left, lower left."""
    s, t = np.asarray(s, float), np.asarray(t, float)
    if island == 0:
        return np.stack([0.05 + 0.8 * s, 0.05 + 0.9 * t], -1)
    if island == 1:  # turned by 90 degrees
        return np.stack([0.55 + 0.8 * (1 - t), 0.55 + 0.8 * (s - 0.5)], -1)
    return np.stack([0.95 - 0.8 * (s - 0.5), 0.05 + 0.8 * t], -1)  # mirrored


def island_of(s: float, t: float) -> int:
    return 0 if s < 0.5 else 1 if t > 0.5 else 2


def in_file(world: np.ndarray) -> np.ndarray:
    """Metres, y up, looking along +z, to the file's units, axes and place."""
    return 100 * np.stack([world[..., 0], -world[..., 2], world[..., 1]], -1) + OFFSET


def polygons() -> tuple[np.ndarray, list[tuple[int, list[int]]]]:
    """Grid places (V, 2) and faces: island and corners, counter-clockwise from outside."""
    line = np.linspace(0, 1, STEPS + 1)
    grid = np.stack(np.meshgrid(line, line), -1).reshape(-1, 2)
    faces = []
    for j in range(STEPS):
        for i in range(STEPS):
            a = j * (STEPS + 1) + i
            quad = [a, a + 1, a + STEPS + 2, a + STEPS + 1]
            island = island_of((i + 0.5) / STEPS, (j + 0.5) / STEPS)
            if (i, j) == (3, 3):  # two quads in one hexagon
                faces.append((island, [a, a + 1, a + 2, a + STEPS + 3, a + STEPS + 2, a + STEPS + 1]))
            elif (i, j) == (4, 3):
                continue
            elif island == 1 or (island == 2 and (i + j) % 2):
                faces += [(island, quad[:3]), (island, [quad[0], *quad[2:]])]
            else:
                faces.append((island, quad))
    return grid, faces


def write_obj(path: Path, edit=lambda text: text) -> None:
    grid, faces = polygons()
    lines = ["# cm, z up", "o head", *("v %.9g %.9g %.9g" % tuple(v) for v in in_file(place(*grid.T)))]
    lines += ["vt %.9g %.9g" % tuple(uv) for island in range(3) for uv in uv_of(island, *grid.T)]
    lines += ["f " + " ".join(f"{k + 1}/{island * len(grid) + k + 1}" for k in face) for island, face in faces]
    lines += ["o collar", *("v %.9g %.9g %.9g" % tuple(v) for v in in_file(COLLAR))]
    lines += ["f " + " ".join(str(len(grid) + k + 1) for k in face) for face in ([0, 1, 2, 3],)]
    path.write_text(edit("\n".join(lines) + "\n"))


COLLAR = np.array([[-0.12, -0.14, 0.1], [0.12, -0.14, 0.1], [0.12, -0.14, -0.1], [-0.12, -0.14, -0.1]])


CUTS = {3: [(0, 1, 2)], 4: [(0, 1, 2), (0, 2, 3)], 6: [(0, 1, 3), (1, 2, 3), (3, 4, 0), (4, 5, 0)]}
"""Triangles of polygons, as a reader of OBJ files cuts them: of the hexagon none lies on a line of the UVs."""


def write_glb(path: Path) -> None:
    """In metres and y up, as glTF has it, under nodes that turn and move it to the OBJ's place."""
    grid, faces = polygons()
    corners = [(k, island) for island, face in faces for k in face]
    number = {corner: i for i, corner in enumerate(dict.fromkeys(corners))}
    head = np.array([place(*grid[k]) for k, _ in number])
    uv = np.array([uv_of(island, *grid[k]) for k, island in number])
    indices = [[number[face[k], island] for k in cut] for island, face in faces for cut in CUTS[len(face)]]
    matrix = np.eye(4)
    matrix[:3, :3] = 100 * np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    matrix[:3, 3] = OFFSET
    packed = Packed(
        {
            "asset": {"version": "2.0"},
            "meshes": [
                {"name": "m0", "primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2}]},
                {"name": "m1", "primitives": [{"attributes": {"POSITION": 3}, "indices": 4}]},
            ],
            "nodes": [
                {"name": "all", "matrix": matrix.T.ravel().tolist(), "children": [1, 2]},
                {"name": "head", "mesh": 0},
                {"name": "collar", "mesh": 1},
            ],
            "scenes": [{"nodes": [0]}],
            "scene": 0,
        }
    )
    for values in (head, np.stack([uv[:, 0], 1 - uv[:, 1]], 1)):
        packed.add(values.astype("<f4"), 5126)
    packed.add(np.array(indices, "<u4").reshape(-1, 1), 5125)
    packed.add(COLLAR.astype("<f4"), 5126)
    packed.add(np.array([[0], [1], [2], [0], [2], [3]], "<u4"), 5125)
    packed.write(path)


class Packed:
    """A glTF document whose arrays can be replaced and added to."""

    def __init__(self, document, blob=b""):
        self.document, self.blob = {"accessors": [], "bufferViews": []} | document, blob

    @classmethod
    def read(cls, path):
        return cls(*glb.unpacked(path.read_bytes()))

    def write(self, path):
        path.write_bytes(glb.packed(self.document, self.blob))

    def values(self, number):
        accessor = self.document["accessors"][number]
        view = self.document["bufferViews"][accessor["bufferView"]]
        kind = {5126: "<f4", 5125: "<u4"}[accessor["componentType"]]
        values = np.frombuffer(self.blob, kind, view["byteLength"] // 4, view["byteOffset"])
        return values.reshape(accessor["count"], -1)

    def view(self, values, **more):
        self.blob += b"\0" * (-len(self.blob) % 4)
        data = np.ascontiguousarray(values).tobytes()
        self.document["bufferViews"].append({"buffer": 0, "byteOffset": len(self.blob), "byteLength": len(data)} | more)
        self.blob += data
        return len(self.document["bufferViews"]) - 1

    def add(self, values, component, **more):
        shape = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}[values.shape[1]]
        accessor = {"bufferView": self.view(values), "componentType": component, "count": len(values), "type": shape}
        self.document["accessors"].append(accessor | more)
        return len(self.document["accessors"]) - 1

    @property
    def head(self):
        return self.document["meshes"][0]["primitives"][0]


def write_albedo(path: Path, size: int = 256) -> None:
    """A grey PNG on a glaring background, with a coloured spot of texels at each mark."""
    picture = np.full((size, size, 3), (255, 0, 255), np.uint8)
    line = np.linspace(0, 1, 4 * size)
    s, t = (a.ravel() for a in np.meshgrid(line, line))
    for island in range(3):
        here = (s <= 0.5) if island == 0 else (s >= 0.5) & ((t >= 0.5) if island == 1 else (t <= 0.5))
        picture[_texel(uv_of(island, s[here], t[here]), size)] = 120
    for (s, t), colour in MARKS.items():
        row, column = _texel(uv_of(island_of(s, t), s, t), size)
        picture[row - 4 : row + 5, column - 4 : column + 5] = colour
    Image.fromarray(picture).save(path)


def _texel(uv: np.ndarray, size: int):
    return ((1 - uv[..., 1]) * size).astype(int).clip(0, size - 1), (uv[..., 0] * size).astype(int).clip(0, size - 1)

"""Maps of ours in the form of other methods: another UV layout, their names, their encodings."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
from scipy.ndimage import map_coordinates

import unshade
from unshade import _native
from unshade.face.texels import Texels, rasterise
from unshade.files.pictures import write_exr

Array = np.ndarray


def rotation(degrees: float) -> Array:
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, -s], [s, c]])


LEFT = (rotation(25) * 0.42, np.array([0.25, 0.5]))
RIGHT = (rotation(-40) * 0.42, np.array([0.75, 0.5]))
"""Where the halves of the chart go: a matrix about the chart's middle, and the middle's new place."""


class Layout:
    """The face cut along its middle, both halves turned and put side by side; or the capture's own layout.

    ``down`` has the pictures' first row at v = 0.
    """

    def __init__(self, capture: unshade.Capture, size: int, *, own: bool = False, down: bool = False) -> None:
        self.mesh, self.size, self.own, self.down = capture.mesh, size, own, down
        self._frames: list[tuple[Texels, Array]] = []
        self.normals = self.mesh["normals"].astype(float)
        uv, triangles = self.mesh["uvs"].astype(float), self.mesh["triangles"].astype(int)
        self.vertices, self.uv, self.triangles = self.mesh["vertices"].astype(float), uv, triangles
        if own:
            return
        left = uv[triangles].mean(1)[:, 0] < 0.5
        # Every vertex twice: once for each half.
        count = len(uv)
        self.vertices, self.normals = np.tile(self.vertices, (2, 1)), np.tile(self.normals, (2, 1))
        self.uv = np.concatenate([(uv - 0.5) @ matrix.T + place for matrix, place in (LEFT, RIGHT)])
        self.triangles = np.where(left[:, None], triangles, triangles + count)

    def texture(self, ours: Array) -> Array:
        """A map (N,N[,C]) of the capture's layout as a picture of this one, row 0 at v = 1."""
        n, size = len(ours), self.size
        column, row = np.meshgrid(np.arange(size), np.arange(size))
        place = np.stack([(column + 0.5) / size, 1 - (row + 0.5) / size], -1)
        if not self.own:
            back = [(place - middle) @ np.linalg.inv(matrix).T + 0.5 for matrix, middle in (LEFT, RIGHT)]
            place = np.where(place[..., :1] < 0.5, *back)
        at = [(1 - place[..., 1]) * n - 0.5, place[..., 0] * n - 0.5]
        planes = np.atleast_3d(ours)
        found = [map_coordinates(planes[..., c], at, order=1, mode="nearest") for c in range(planes.shape[-1])]
        return np.stack(found, -1)[..., 0] if ours.ndim == 2 else np.stack(found, -1)

    def tangent(self, normals: Array) -> Array:
        """Object-space normals (size,size,3) in this layout's tangent space, green up the picture."""
        if not self._frames:
            texels = rasterise(self.uv, self.triangles, self.size)
            parts = (values.astype(np.float32) for values in (self.vertices, self.normals, self.uv))
            corners = _native.mikktspace(*parts, self.triangles)[texels.triangle]
            t = np.einsum("mk,mkc->mc", texels.weights, corners[..., :3])
            n = texels.sample(self.normals)
            self._frames.append((texels, np.stack([t, corners[:, 0, 3:] * np.cross(n, t), n], -1)))
        texels, frames = self._frames[0]
        local = np.linalg.solve(frames, normals[texels.inside][..., None])[..., 0]
        flat = np.broadcast_to([0.0, 0.0, 1.0], normals.shape).copy()
        flat[texels.inside] = local / np.linalg.norm(local, axis=1, keepdims=True)
        return flat

    def write_mesh(self, path: Path, scale: float = 1.0, turn: Array | None = None) -> None:
        vertices = self.vertices * scale @ (np.eye(3) if turn is None else turn).T
        uv = self.uv * [1, -1] + [0, 1] if self.down else self.uv
        lines = ["v %.9g %.9g %.9g" % tuple(v) for v in vertices] + ["vt %.9g %.9g" % tuple(t) for t in uv]
        lines += ["f %d/%d %d/%d %d/%d" % tuple(np.repeat(f + 1, 2)) for f in self.triangles]
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("\n".join(lines) + "\n")


def srgb(x: Array) -> Array:
    x = np.clip(x, 0, 1)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.maximum(x, 1e-9) ** (1 / 2.4) - 0.055)


def write_png(path: Path, codes: Array, bits: int = 8) -> None:
    """Codes 0 to 1: (N,N) or (N,N,3), R, G, B."""
    path.parent.mkdir(parents=True, exist_ok=True)
    samples = np.rint(np.clip(codes, 0, 1) * (2**bits - 1)).astype(np.uint8 if bits == 8 else np.uint16)
    assert cv2.imwrite(str(path), samples[..., ::-1] if samples.ndim == 3 else samples)


def nextface(maps: unshade.Maps, layout: Layout, folder: Path) -> None:
    power = lambda x: np.clip(x, 0, 1) ** (1 / 2.2)
    layout.write_mesh(folder / "mesh_0.obj")
    write_png(folder / "diffuseMap_0.png", power(layout.texture(maps.diffuse_albedo)))
    write_png(folder / "specularMap_0.png", power(layout.texture(maps.specular_albedo)))
    write_png(folder / "roughnessMap_0.png", power(np.full((layout.size,) * 2, 0.3**2)))


def nvdiffrec(maps: unshade.Maps, layout: Layout, folder: Path) -> None:
    layout.write_mesh(folder / "mesh.obj")
    write_png(folder / "texture_kd.png", srgb(layout.texture(maps.diffuse_albedo)))
    # What holds light back, roughness, metalness: F0 = 0.04 (1 - held back).
    blocked = 1 - layout.texture(maps.specular_albedo) / 0.04
    arm = np.stack([blocked, np.full(blocked.shape, 0.3**0.5), np.zeros(blocked.shape)], -1)
    write_png(folder / "texture_ks.png", arm)
    write_png(folder / "texture_n.png", layout.tangent(layout.texture(maps.specular_normal)) / 2 + 0.5)


def ffhq_uv(maps: unshade.Maps, layout: Layout, folder: Path) -> None:
    layout.write_mesh(folder / "head.obj")
    write_png(folder / "id_diffuse_albedo.png", srgb(layout.texture(maps.diffuse_albedo)))
    write_png(folder / "id_specular_intensity.png", layout.texture(maps.specular_albedo) / 0.08)
    write_png(folder / "id_normal.png", layout.tangent(layout.texture(maps.specular_normal)) / 2 + 0.5)


def opendelight(maps: unshade.Maps, layout: Layout, folder: Path) -> None:
    layout.write_mesh(folder / "head.obj")
    write_png(folder / "diff_sr_4x.png", srgb(layout.texture(maps.diffuse_albedo)))
    write_png(folder / "spec_sr_4x.png", layout.texture(maps.specular_albedo) / 0.08)
    write_png(folder / "normal_sr_4x.png", layout.tangent(layout.texture(maps.specular_normal)) / 2 + 0.5)


def wildcap(maps: unshade.Maps, layout: Layout, folder: Path) -> None:
    layout.write_mesh(folder / "head.obj")
    write_png(folder / "diff_sr.png", np.clip(layout.texture(maps.diffuse_albedo), 0, 1) ** (1 / 2.2))
    write_png(folder / "spec_sr.png", layout.texture(maps.specular_albedo))
    write_png(folder / "normal_sr.png", layout.tangent(layout.texture(maps.specular_normal)) / 2 + 0.5)


def avatarme(maps: unshade.Maps, layout: Layout, folder: Path) -> None:
    layout.write_mesh(folder / "head.obj")
    write_png(folder / "s_diff_albedo.png", srgb(layout.texture(maps.diffuse_albedo)))
    write_png(folder / "s_spec_albedo.png", layout.texture(maps.specular_albedo) / 0.08)
    write_png(folder / "s_diff_normals.png", layout.texture(maps.diffuse_normal) / 2 + 0.5, 16)
    write_png(folder / "s_spec_normals.png", layout.tangent(layout.texture(maps.specular_normal)) / 2 + 0.5)


LOBES = (0.2, 0.4, 0.6)


def own(maps: unshade.Maps, layout: Layout, folder: Path) -> None:
    """As `unshade solve` writes them, with lobes, a standard deviation and a part of the record."""
    names = ("diffuse_albedo", "specular_albedo", "diffuse_normal", "specular_normal")
    textures = {name: layout.texture(getattr(maps, name)).astype(np.float32) for name in names}
    for name in names[2:]:
        textures[name] /= np.linalg.norm(textures[name], axis=-1, keepdims=True)
    lobes = np.broadcast_to(np.float32(LOBES), (layout.size, layout.size, 3))
    unshade.Maps(**textures, roughness=lobes).write(folder)
    layout.write_mesh(folder / "mesh.obj")
    write_exr(folder / "diffuse_albedo_std.exr", {"Y": np.full((layout.size,) * 2, 0.25, np.float32)})
    (folder / "solve.json").write_text('{"solver": "unshade", "config": {}, "seed": 7}')


WRITERS = {
    "nextface": nextface,
    "nvdiffrec": nvdiffrec,
    "ffhq-uv": ffhq_uv,
    "opendelight": opendelight,
    "wildcap": wildcap,
    "avatarme": avatarme,
    "unshade": own,
}
"""By the adapter that reads what each writes."""

"""Teeth, gums and tongue of an open mouth.

The head data holds bands where the teeth are and a coarse tongue, all moved by its morph
targets. Teeth are shaped one by one along the bands' biting edges.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from ..vectors import unit
from .geometry import Geometry, Part, textured_part
from .head import Head
from .noise import smooth_noise
from .spec import FaceSpec, stream
from .subdivide import subdivide, triangulate

# Mean widths and crown heights (mm) of permanent teeth from the midline back, after
# Wheeler's Dental Anatomy, table 1-1; both arches with the third molar.
_UPPER = np.array([[8.5, 10.5], [6.5, 9.0], [7.5, 10.0], [7.0, 8.5], [7.0, 8.5], [10.0, 7.5], [9.0, 7.0], [8.5, 6.5]])
_LOWER = np.array([[5.0, 9.0], [5.5, 9.5], [7.0, 11.0], [7.0, 8.5], [7.0, 8.0], [11.0, 7.5], [10.5, 7.0], [10.0, 7.0]])
_TALLEST = 10.5
_CROWN_FRACTION = 0.55
"""Fraction of a band's height that the tallest crown takes; gum covers the rest."""

_ARCH_WIDTH = 0.80
"""The bands stand 62 mm apart, wider than any arch (Wheeler: 60 mm over the cheek side of the molars on a large skull), and meet the cheeks."""

_INCISORS, _FRONT = 2, 3
_RINGS, _SEGMENTS = 14, 20
_GUM_STEPS, _GUM_SEGMENTS = 192, 20

_ENAMEL = np.array([0.60, 0.51, 0.40])
"""Linear Rec.709 albedo of enamel, about shade A2."""

_GUM, _TONGUE = np.array([0.44, 0.19, 0.17]), np.array([0.40, 0.165, 0.15])
"""Linear Rec.709 albedo of mucous membrane, which is alike in all skin types."""

_ENAMEL_SPECULAR, _MUCOSA_SPECULAR = 0.045, 0.025
"""Reflectance at normal incidence of enamel (n = 1.62; wet: less) and of wet mucous membrane."""


def make_mouth(head: Head, geometry: Geometry, spec: FaceSpec) -> list[Part]:
    """Parts `teeth`, `gums` and `tongue`, in the world; smooth and wet, hence with textures (`uv`)."""
    teeth, gums = [], []
    for rims, table, down in zip(head.arches, (_UPPER, _LOWER), (True, False)):
        arch = _Arch(geometry.base[rims[0]], geometry.base[rims[1]], table, down)
        teeth += arch.teeth()
        gums.append(arch.gum())
    rng = stream(spec.seed, "teeth")
    shade = _ENAMEL * rng.uniform(0.85, 1.08) * (1 - spec.age * np.array([0.08, 0.14, 0.28]))
    return [
        _part("teeth", teeth, _enamel(shade), _ENAMEL_SPECULAR),
        _part("gums", gums, _mottled(_GUM, rng), _MUCOSA_SPECULAR),
        _tongue(head, geometry, _mottled(_TONGUE, rng)),
    ]


class _Arch:
    """One dental arch: its biting edge and gum rim as curves over the share of its length, right to left."""

    def __init__(self, gum: np.ndarray, edge: np.ndarray, table: np.ndarray, down: bool) -> None:
        # The bands' front teeth lean back, far behind the lips: set them upright.
        front = np.clip(1 - np.abs(np.linspace(-1, 1, len(edge))) / 0.7, 0, 1)[:, None] * [0, 0, 1]
        gum, edge = gum - 0.001 * down * front, edge + (0.0035 if down else 0.002) * front
        gum, edge = (_narrowed(rim, (edge[0, 0] + edge[-1, 0]) / 2) for rim in (gum, edge))
        way = np.r_[0, np.cumsum(np.linalg.norm(np.diff(edge, axis=0), axis=1))]
        self.edge, self.rim = CubicSpline(way / way[-1], edge), CubicSpline(way / way[-1], gum)
        widths = np.r_[table[::-1, 0], table[:, 0]]
        self.bounds = np.r_[0, np.cumsum(widths)] / widths.sum()
        self.heights = np.r_[table[::-1, 1], table[:, 1]] / _TALLEST * _CROWN_FRACTION
        self.length, self.down = way[-1], down

    def frame(self, s: np.ndarray) -> tuple[np.ndarray, ...]:
        """Origin on the biting edge, and axes along the arch, outward and towards the gum (its length the band's)."""
        origin, along = self.edge(s), unit(self.edge(s, 1))
        root = self.rim(s) - origin
        outward = unit(np.cross(root, along) if not self.down else np.cross(along, -root))
        return origin, along, outward, root

    def teeth(self) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """Position, uv and triangles of every tooth; v runs from the biting edge to the neck."""
        count = len(self.heights)
        return [self._tooth(i, abs(i - (count - 1) / 2) - 0.5) for i in range(count)]

    def _tooth(self, i: int, place: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        middle, width = (self.bounds[i] + self.bounds[i + 1]) / 2, (self.bounds[i + 1] - self.bounds[i]) * self.length
        origin, along, outward, root = self.frame(middle)
        front = place < _FRONT
        t = np.linspace(0, 1, _RINGS) ** 1.3
        # Front teeth are blades that thicken towards the neck and taper to it; those behind are blocks.
        half = 0.5 * width * np.interp(t, [0, 0.04, 0.25, 1], [0.80, 0.94, 1.0, 0.80])
        deep = np.interp(
            t, [0, 0.04, 0.4, 1], [0.0004, 0.0007, 0.0022, 0.0032] if front else [0.0026, 0.0034, 0.0042, 0.0038]
        )
        phi = np.arange(_SEGMENTS) / _SEGMENTS * 2 * np.pi
        square = 2 / 3.2
        a = np.sign(np.cos(phi)) * np.abs(np.cos(phi)) ** square
        b = np.sign(np.sin(phi)) * np.abs(np.sin(phi)) ** square
        # The labial face bulges a little between edge and neck; canines end in a blunt point.
        bulge = 0.0007 * np.sin(np.pi * t) - 0.0002
        point = 0.0011 if place == _INCISORS else 0.0004
        lift = point * (a[None] ** 2) * np.clip(1 - t[:, None] / 0.3, 0, 1) + 0.0003 * (place == 1)
        height = (t * self.heights[i] * 1.12)[:, None] * np.linalg.norm(root) + lift
        ring = (
            origin
            + (half[:, None] * a)[..., None] * along
            + (deep[:, None] * (b - 1) + bulge[:, None])[..., None] * outward
            + height[..., None] * unit(root)
        )
        tip = ring[0].mean(axis=0)
        positions = np.vstack([ring.reshape(-1, 3), tip])
        uv = np.column_stack([np.tile(phi / (2 * np.pi), _RINGS), np.repeat(t, _SEGMENTS)])
        triangles = _tube(_RINGS, _SEGMENTS)
        k = np.arange(_SEGMENTS)
        cap = np.stack([np.full(_SEGMENTS, len(positions) - 1), (k + 1) % _SEGMENTS, k], axis=1)
        return positions, np.vstack([uv, [0.5, 0.0]]), _outward(positions, np.vstack([triangles, cap]))

    def gum(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """A tube along the arch that holds the necks; its edge rises between the teeth."""
        s = np.linspace(0, 1, _GUM_STEPS)
        origin, _, outward, root = self.frame(s)
        tooth = np.clip(np.searchsorted(self.bounds, s, side="right") - 1, 0, len(self.heights) - 1)
        across = (s - self.bounds[tooth]) / (self.bounds[tooth + 1] - self.bounds[tooth])
        centre = (self.bounds[:-1] + self.bounds[1:]) / 2
        neck = np.interp(s, centre, self.heights) - 0.11 * (2 * np.abs(across - 0.5)) ** 2.5
        phi = np.arange(_GUM_SEGMENTS) / _GUM_SEGMENTS * 2 * np.pi
        low, high = neck[:, None], 0.95
        height = (low + high) / 2 - (high - low) / 2 * np.cos(phi)
        # Thin at the edge, where it lies on the crown.
        deep = -0.0030 + 0.0034 * np.sin(phi) * (1 - 0.12 * np.cos(phi))
        ring = origin[:, None] + height[..., None] * root[:, None] + deep[None, :, None] * outward[:, None]
        positions = ring.reshape(-1, 3)
        uv = np.column_stack([np.repeat(s, _GUM_SEGMENTS), np.tile(phi / (2 * np.pi), _GUM_STEPS)])
        return positions, uv, _outward(positions, _tube(_GUM_STEPS, _GUM_SEGMENTS))


def _narrowed(rim: np.ndarray, middle: float) -> np.ndarray:
    return rim * [_ARCH_WIDTH, 1, 1] + [(1 - _ARCH_WIDTH) * middle, 0, 0]


def _tube(rings: int, segments: int) -> np.ndarray:
    """Triangles of rings of vertices, each closed on itself."""
    i, k = (grid.ravel() for grid in np.meshgrid(np.arange(rings - 1), np.arange(segments), indexing="ij"))
    a, b = i * segments + k, i * segments + (k + 1) % segments
    c, d = a + segments, b + segments
    return np.concatenate([np.stack([a, b, d], 1), np.stack([a, d, c], 1)])


def _outward(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Triangles [F, 3] of a closed solid, all turned over if its signed volume is negative."""
    a, b, c = (positions[triangles[:, k]] - positions.mean(axis=0) for k in range(3))
    return triangles if (a * np.cross(b, c)).sum() > 0 else triangles[:, [0, 2, 1]]


def _part(
    name: str, pieces: list[tuple[np.ndarray, np.ndarray, np.ndarray]], diffuse: np.ndarray, specular: float
) -> Part:
    starts = np.cumsum([0, *(len(positions) for positions, _, _ in pieces[:-1])])
    positions, uv = (np.concatenate([piece[k] for piece in pieces]) for k in (0, 1))
    triangles = np.concatenate([piece[2] + start for piece, start in zip(pieces, starts)])
    return textured_part(name, positions, triangles, uv, diffuse, specular)


def _tongue(head: Head, geometry: Geometry, diffuse: np.ndarray) -> Part:
    own, quads = np.unique(head.tongue, return_inverse=True)
    refine, fine = subdivide(quads.reshape(-1, 4), len(own), 2)
    positions = refine @ geometry.base[own]
    low, high = positions.min(axis=0), positions.max(axis=0)
    uv = ((positions - low) / (high - low))[:, [0, 2]]
    return _part("tongue", [(positions, uv, triangulate(fine))], diffuse, _MUCOSA_SPECULAR)


def _enamel(shade: np.ndarray) -> np.ndarray:
    """Texture (64,8,3): greyer and clearer at the biting edge (v = 0), yellower at the neck (v = 1)."""
    v = 1 - (np.arange(64) + 0.5) / 64
    edge, neck = np.clip(1 - v / 0.22, 0, 1)[:, None], np.clip((v - 0.45) / 0.55, 0, 1)[:, None]
    colour = shade * (1 - edge * [0.24, 0.18, 0.08]) * (1 - neck * [0.06, 0.14, 0.30])
    return np.repeat(colour[:, None], 8, axis=1)


def _mottled(colour: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Texture (64,64,3) of mucous membrane."""
    y, x = (grid.ravel() for grid in np.mgrid[:64, :64])
    noise = smooth_noise(np.column_stack([x, y, 0 * x]).astype(np.float32), 6.0, rng).reshape(64, 64, 1)
    return np.clip(colour * (1 + 0.08 * noise), 0, 1)

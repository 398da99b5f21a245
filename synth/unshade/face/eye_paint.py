"""Paint of natural eyes: sclera with vessels in the lids' shade, limbus, an iris of fibres and crypts.

Angles are in degrees from the optical axis. Only the front of an eye, which lids leave open, has detail.
"""

from __future__ import annotations

import dataclasses

import numpy as np
from scipy.ndimage import gaussian_filter
from scipy.spatial import cKDTree

from .eyeball import IRIS
from .geometry import Part
from .noise import smooth_noise
from .opening import Opening
from .pigment import MELANOSOMES
from .regions import smoothstep
from .spec import FaceSpec, stream

_ROWS = (320, 1024)
"""Fewest and most rows of the texture; 5 for each 8 texels of the chart's side."""

_FRONT = 105.0
"""Lids hide all that lies farther from the axis."""

_SCLERA = np.array([0.53, 0.455, 0.39])
"""Albedo of the sclera of the young and pale; age and melanin make it yellower."""

_SHADE = ((0.55, 1.9), (0.30, 1.0))
"""Light that is lost at the upper and the lower lid, and the way (mm) over which: lids are moist and lashes dense, nearer
to the eyeball than the mesh is."""

_PLICA, _PLICA_REACH = np.array([0.44, 0.23, 0.195]), (6.5, 2.2)
"""The fold of conjunctiva in the inner corner, and where (mm from the corner) it begins and is whole."""

_VESSEL = np.array([0.10, 0.60, 0.56])
"""Log albedo that a vessel of the conjunctiva takes away."""


@dataclasses.dataclass(frozen=True)
class _Grid:
    """Directions of the texture's front texels: `theta` and `phi` (R,W) radians, `places` (R,W,3) m in the world."""

    theta: np.ndarray
    phi: np.ndarray
    places: np.ndarray

    @classmethod
    def of(cls, rows: int, opening: Opening) -> _Grid:
        columns, front = rows * 8 // 5, int(np.ceil(rows * _FRONT / 180))
        theta, phi = np.meshgrid(
            (np.arange(front) + 0.5) / rows * np.pi, (np.arange(columns) + 0.5) / columns * 2 * np.pi, indexing="ij"
        )
        local = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
        return cls(theta, phi, opening.sphere[:3] + opening.sphere[3] * local @ opening.turn.T)


def paint_eyes(eyes: list[Part], openings: list[Opening], spec: FaceSpec) -> list[Part]:
    """The eyeballs (left, right) with natural paint."""
    rows = int(np.clip(5 * spec.texture_size // 8, *_ROWS))
    painted = []
    for part, opening in zip(eyes, openings):
        grid = _Grid.of(rows, opening)
        degrees = np.degrees(grid.theta)[..., None]
        # Sclera runs on over the iris a little and lets it through: the limbus is soft and greyish.
        edge = smoothstep(IRIS - 1.6, IRIS + 2.2, degrees)
        front = _iris(grid, _mean_iris(part), spec) * (1 - edge) + _sclera(grid, opening, spec) * edge
        diffuse = np.broadcast_to(front[-1].mean(axis=0), (rows, front.shape[1], 3)).copy()
        diffuse[: len(front)] = front * (1 - _shade(grid, opening))
        specular = np.full(diffuse.shape[:2], part.specular.flat[0], dtype=np.float32)
        painted.append(
            dataclasses.replace(part, diffuse=np.clip(diffuse, 0.002, 1).astype(np.float32), specular=specular)
        )
    return painted


def _noise(columns: list[np.ndarray], wavelength: float, spec: FaceSpec, *names: str) -> np.ndarray:
    points = np.stack([np.broadcast_to(column, columns[0].shape).ravel() for column in columns], axis=1)
    return smooth_noise(points.astype(np.float32), wavelength, stream(spec.seed, *names)).reshape(columns[0].shape)


def _mean_iris(part: Part) -> np.ndarray:
    """Colour (3,) of the iris of a smooth face, so that the natural one is the same person's."""
    rows = np.array([10.0, 15.0]) / 180 * len(part.diffuse)
    return part.diffuse[slice(*rows.astype(int))].mean(axis=(0, 1)) / 1.25


def _iris(grid: _Grid, colour: np.ndarray, spec: FaceSpec) -> np.ndarray:
    """Albedo (R,W,3): radial fibres, crypts round the collarette, a warmer inner zone and a dark rim."""
    there = np.degrees(grid.theta[:, 0]) < IRIS + 4
    degrees, x, y = np.degrees(grid.theta[there]), np.cos(grid.phi[there]), np.sin(grid.phi[there])
    own = stream(spec.seed, "iris")
    pupil = IRIS * own.uniform(0.28, 0.38)
    collarette = pupil + 4.2 + 0.9 * _noise([4 * x, 4 * y, 0 * x], 1.0, spec, "collarette")
    zone = smoothstep(-0.8, 0.8, collarette - degrees)
    # Fibres wave as they run outward, and part round crypts.
    wave = 0.05 * _noise([3 * x, 3 * y, degrees / 5], 1.0, spec, "iris wave")
    u, v = np.cos(grid.phi[there] + wave), np.sin(grid.phi[there] + wave)
    coarse = _noise([13 * u, 13 * v, degrees / 10], 1.0, spec, "iris fibres")
    fine = _noise([34 * u, 34 * v, degrees / 8], 1.0, spec, "fine iris fibres")
    crypts = smoothstep(0.9, 1.8, _noise([5 * u, 5 * v, degrees / 3.5], 1.0, spec, "crypts"))
    crypts = crypts * smoothstep(pupil, pupil + 2, degrees) * smoothstep(IRIS - 1, IRIS - 5, degrees)
    light = 1 + 0.24 * coarse + 0.22 * fine - 0.55 * crypts + 0.35 * np.exp(-(((degrees - collarette) / 0.7) ** 2))
    light = np.clip(light, 0.25, 2.2) * (1 - 0.72 * smoothstep(IRIS - 4.5, IRIS + 0.5, degrees))
    warm = colour * np.array([1.15, 0.85, 0.55])
    tone = colour + (0.75 * zone)[..., None] * (warm - colour)
    values = 0.002 + tone * light[..., None] * smoothstep(pupil - 0.4, pupil + 0.4, degrees)[..., None]
    whole = np.zeros((*grid.theta.shape, 3))
    whole[there] = values
    return whole


def _sclera(grid: _Grid, opening: Opening, spec: FaceSpec) -> np.ndarray:
    """Albedo (R,W,3) with vessels, yellowing and the pink fold of the inner corner."""
    theta = np.degrees(grid.theta)
    x, y = theta * np.cos(grid.phi), theta * np.sin(grid.phi)
    dark = min(1.0, MELANOSOMES[spec.fitzpatrick] / MELANOSOMES["VI"])
    patches = _noise([x, y, 0 * x], 14.0, spec, "sclera", str(opening.side))
    yellow = 0.35 * spec.age + dark * (0.55 + 0.25 * np.clip(patches, -1, 2)) * smoothstep(20.0, 45.0, theta)
    white = _SCLERA * np.exp(-yellow[..., None] * np.array([0.10, 0.20, 0.42]))
    # Under thin conjunctiva the choroid makes it bluish, beside the cornea most.
    white = white * (1 - 0.10 * np.exp(-(((theta - IRIS) / 5) ** 2))[..., None] * np.array([1.3, 1.0, 0.7]))
    flush = smoothstep(22.0, 52.0, theta)[..., None] * (1 + 0.35 * patches[..., None])
    white = white * np.exp(-flush * np.array([0.06, 0.26, 0.25]))
    white = white * np.exp(-_vessels(grid, opening, spec)[..., None] * _VESSEL)
    corner = 1000 * np.linalg.norm(grid.places - opening.corner, axis=-1)
    return white + smoothstep(*_PLICA_REACH, corner)[..., None] * (_PLICA - white)


def _vessels(grid: _Grid, opening: Opening, spec: FaceSpec) -> np.ndarray:
    """Optical depth (R,W) of vessels that wind from both corners towards the cornea, and branch."""
    rng = stream(spec.seed, "eye vessels", "left" if opening.side > 0 else "right")
    red = rng.uniform(0.5, 1.3)
    rows, columns = grid.theta.shape
    depth = np.zeros(rows * columns)
    per_degree = rows / _FRONT
    starts = rng.uniform(44, 62, 44), rng.choice([0.0, np.pi], 44) + rng.normal(0, 0.38, 44)
    place = np.stack([starts[0] * np.cos(starts[1]), starts[0] * np.sin(starts[1])], axis=1)
    heading = np.arctan2(-place[:, 1], -place[:, 0]) + rng.normal(0, 0.35, 44)
    width = rng.uniform(0.5, 1.3, 44)
    for generation in range(3):
        step, count = 0.25, len(place)
        length = rng.uniform(12, 40, count) * 0.6**generation
        end = rng.uniform(IRIS + 2, IRIS + 12, count)
        branch_place, branch_heading, branch_width = [], [], []
        drift = np.zeros(count)
        for k in range(int(length.max() / step)):
            radius = np.linalg.norm(place, axis=1)
            alive = (k * step < length) & (radius > end) & (radius < 104)
            if not alive.any():
                break
            thin = width * (1 - 0.6 * k * step / length) * alive
            angle = np.arctan2(place[:, 1], place[:, 0]) % (2 * np.pi)
            row, column = radius * per_degree, angle / (2 * np.pi) * columns
            # Texels along a parallel are narrower than those along a meridian.
            across = np.maximum(np.sin(np.radians(radius)) * 360 / columns, 1e-6)
            amount = thin * step / (across / per_degree)
            for dy in (0, 1):
                for dx in (0, 1):
                    r, c = np.floor(row - 0.5) + dy, np.floor(column - 0.5) + dx
                    foot = (1 - np.abs(row - 0.5 - r)) * (1 - np.abs(column - 0.5 - c))
                    index = np.clip(r, 0, rows - 1).astype(int) * columns + c.astype(int) % columns
                    np.add.at(depth, index, amount * foot)
            drift = 0.93 * drift + rng.normal(0, 0.12, count)
            heading = heading + 0.10 * drift
            turned = rng.random(count) < 0.012 * (generation < 2)
            for many, values in ((branch_place, place), (branch_heading, heading), (branch_width, width)):
                many.append(values[turned & alive])
            place = place + step * np.stack([np.cos(heading), np.sin(heading)], axis=1)
        place = np.concatenate(branch_place)
        heading = np.concatenate(branch_heading) + rng.choice([-0.6, 0.6], len(place))
        width = 0.65 * np.concatenate(branch_width)
        if not len(place):
            break
    # A vessel is some hundredths of a millimetre deep in the conjunctiva, a third of a degree wide.
    drawn = gaussian_filter(depth.reshape(rows, columns), 0.16 * per_degree, mode=("nearest", "wrap"))
    return red * np.minimum(0.55 * drawn, 1.6)


def _shade(grid: _Grid, opening: Opening) -> np.ndarray:
    """Share (R,W,1) of the light that is lost beside the lids' edges."""
    lost = np.zeros(grid.theta.shape)
    for lid, (most, reach) in zip((opening.upper, opening.lower), _SHADE):
        distance = 1000 * cKDTree(lid).query(grid.places.reshape(-1, 3))[0].reshape(lost.shape)
        lost = 1 - (1 - lost) * (1 - most * np.exp(-distance / reach))
    return lost[..., None]

"""`build_face`: from a specification to everything a renderer needs."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np

from .cache import load_head
from .canvas import Canvas, has_surround
from .caruncle import make_caruncles
from .displacement import displaced
from .eye_paint import paint_eyes
from .eyes import make_eyes
from .geometry import Chart, Geometry, Part, SkinTexture, place
from .hair import HairStyle, hair_style
from .head import Head
from .identity import pose, shape
from .lashes import make_lashes
from .lids import sunken_fold
from .opening import openings
from .paint import Maps, paint_maps
from .pigment import skin_colour
from .regions import find_regions
from .skin import base_pigments, head_colour
from .spec import FaceSpec
from .teeth import make_mouth
from .wet_line import make_wet_lines

_LARGEST_SURROUND = 1024
"""Texels along the side of the paint round the chart; pictures show little of it, and at grazing angles."""


@dataclasses.dataclass(frozen=True)
class Face:
    """A face in the world: metres, right-handed, +Y up, looking along +Z.

    The origin lies 70 mm behind the midpoint of the eyes' centres, near the centre of
    the head. `parts` are the occluders: `rest` (of head, neck and shoulders), `mouth`,
    `sockets`, `teeth`, `gums`, `tongue`, `eye_left`, `eye_right` (the person's own left:
    +X), `wet_line_left`, `wet_line_right`; of natural faces also `caruncle_left`, `caruncle_right`, `lashes`.
    """

    spec: FaceSpec
    chart: Chart
    parts: list[Part]
    paint: Callable[[], Maps]
    keep: Callable[[str, type, Callable[[], Any]], Any] = lambda name, kind, make: make()
    """Gives the arrays of a name, of a kind (a dataclass), from an earlier build or by making them."""

    @cached_property
    def maps(self) -> Maps:
        """Painted when first asked for: relighting needs the shapes alone."""
        return self.keep("maps", Maps, self.paint)

    @cached_property
    def surface(self) -> Chart:
        """The rendered surface: the chart, or with `displacement` a finer one that is raised by the painted relief."""
        if not getattr(self.spec, "displacement", False):
            return self.chart
        return self.keep("surface", Chart, lambda: displaced(self.chart, self.maps.height))


def build_face(spec: FaceSpec) -> Face:
    """Shape one face, to be painted. Equal specifications give equal bytes.

    Raises `FaceError` where the head data is missing.
    """
    head = load_head(spec.chart == "wide")
    geometry = place(head, shape(head, spec), pose(head, spec))
    style = hair_style(spec)
    return Face(
        spec=spec,
        chart=Chart(
            vertices=geometry.positions[head.chart_vertices].astype(np.float32),
            normals=geometry.normals[head.chart_vertices].astype(np.float32),
            uv=head.chart_uv.astype(np.float32),
            triangles=head.chart_triangles.astype(np.uint32),
        ),
        parts=[
            *_occluders(head, geometry, style, spec),
            *make_mouth(head, geometry, spec),
            *_eyes(head, geometry, style, spec),
            *make_wet_lines(head, geometry),
        ],
        paint=lambda: paint_maps(Canvas.face(head), geometry, style, spec),
    )


def _eyes(head: Head, geometry: Geometry, style: HairStyle, spec: FaceSpec) -> list[Part]:
    """Eyeballs; of a natural face lashes and caruncles too."""
    folds = [sunken_fold(geometry.positions, head.part_chart, *eye) for eye in zip(geometry.eyes, geometry.gaze)]
    eyes = make_eyes(geometry.eyes, geometry.gaze, folds, spec)
    if spec.detail == "smooth":
        return eyes
    lids = openings(head, geometry)
    return [
        *paint_eyes(eyes, lids, spec),
        *make_caruncles(lids),
        *make_lashes(head, geometry, lids, 0.7 * style.brow, spec),
    ]


def _occluders(head: Head, geometry: Geometry, style: HairStyle, spec: FaceSpec) -> list[Part]:
    """Rest of the head, mouth cavity and eye sockets, one colour per vertex."""
    parts = []
    for name in ("rest", "mouth", "sockets"):
        triangles, vertices = getattr(head, f"part_{name}"), np.arange(len(head.template))
        if not len(triangles):
            continue  # a wide chart leaves no rest
        surround = name == "rest" and has_surround(spec)
        if surround:
            triangles, vertices = head.surround_triangles[head.surround_rest], head.surround_vertices
        used, local = np.unique(triangles, return_inverse=True)
        used, uv = vertices[used], head.surround_uv[used] if surround else None
        regions = find_regions(head.template[used].astype(np.float32))
        if name == "rest":
            diffuse, specular = head_colour(regions, style, spec)
        else:
            # Mucous membrane: little melanin over much blood.
            pigments = base_pigments(regions, spec)
            diffuse = skin_colour(0.5 * pigments.melanin, 3.0 * pigments.blood)
            specular = np.full(len(used), 0.02, dtype=np.float32)
        parts.append(
            Part(
                name=name,
                vertices=geometry.positions[used].astype(np.float32),
                normals=geometry.normals[used].astype(np.float32),
                triangles=local.reshape(-1, 3).astype(np.uint32),
                diffuse=diffuse,
                specular=specular,
                texture=_surround_texture(head, uv, geometry, style, spec) if surround else None,
            )
        )
    return parts


def _surround_texture(head: Head, uv: np.ndarray, geometry: Geometry, style: HairStyle, spec: FaceSpec) -> SkinTexture:
    """Paint of the head round the chart, whose vertices lie at `uv`."""
    size = min(spec.texture_size, _LARGEST_SURROUND)
    maps = paint_maps(Canvas.surround(head), geometry, style, dataclasses.replace(spec, texture_size=size))
    return SkinTexture(
        uv.astype(np.float32),
        maps.diffuse_albedo,
        maps.specular_albedo,
        maps.diffuse_normal,
        maps.specular_normal,
        maps.roughness,
    )

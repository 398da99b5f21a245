"""`build_face`: from a specification to everything a renderer needs."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import cached_property

import numpy as np

from .cache import load_head
from .displacement import displaced
from .eyes import make_eyes
from .geometry import Chart, Geometry, Part, part_mesh, place
from .hair import HairStyle, hair_style
from .head import Head
from .identity import pose, shape
from .lids import sunken_fold
from .paint import Maps, paint_maps
from .pigment import skin_colour
from .regions import find_regions
from .skin import base_pigments, head_colour
from .spec import FaceSpec
from .teeth import make_mouth
from .wet_line import make_wet_lines


@dataclasses.dataclass(frozen=True)
class Face:
    """A face in the world: metres, right-handed, +Y up, looking along +Z.

    The origin lies 70 mm behind the midpoint of the eyes' centres, near the centre of
    the head. `parts` are the occluders: `rest` (of head, neck and shoulders), `mouth`,
    `sockets`, `teeth`, `gums`, `tongue`, `eye_left`, `eye_right` (the person's own left:
    +X), `wet_line_left`, `wet_line_right`.
    """

    spec: FaceSpec
    chart: Chart
    parts: list[Part]
    paint: Callable[[], Maps]

    @cached_property
    def maps(self) -> Maps:
        """Painted when first asked for: relighting needs the shapes alone."""
        return self.paint()

    @cached_property
    def surface(self) -> Chart:
        """The rendered surface: the chart, or with `displacement` a finer one that is raised by the painted relief."""
        if not getattr(self.spec, "displacement", False):
            return self.chart
        return displaced(self.chart, self.maps.height)


def build_face(spec: FaceSpec) -> Face:
    """Shape one face, to be painted. Equal specifications give equal bytes.

    Raises `FaceError` where the head data is missing.
    """
    head = load_head(spec.chart == "wide")
    geometry = place(head, shape(head, spec), pose(head, spec))
    folds = [sunken_fold(geometry.positions, head.part_chart, *eye) for eye in zip(geometry.eyes, geometry.gaze)]
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
            *make_eyes(geometry.eyes, geometry.gaze, folds, spec),
            *make_wet_lines(head, geometry),
        ],
        paint=lambda: paint_maps(head, geometry, style, spec),
    )


def _occluders(head: Head, geometry: Geometry, style: HairStyle, spec: FaceSpec) -> list[Part]:
    """Rest of the head, mouth cavity and eye sockets, one colour per vertex."""
    parts = []
    for name in ("rest", "mouth", "sockets"):
        used, mesh = part_mesh(geometry, getattr(head, f"part_{name}"))
        if not len(used):
            continue  # a wide chart leaves no rest
        regions = find_regions(head.template[used].astype(np.float32))
        if name == "rest":
            diffuse, specular = head_colour(regions, style, spec)
        else:
            # Mucous membrane: little melanin over much blood.
            pigments = base_pigments(regions, spec)
            diffuse = skin_colour(0.5 * pigments.melanin, 3.0 * pigments.blood)
            specular = np.full(len(used), 0.02, dtype=np.float32)
        parts.append(Part(name=name, diffuse=diffuse, specular=specular, **mesh))
    return parts

"""What is painted texel by texel: the chart, and around it the surround on which paint runs on across the rim."""

from __future__ import annotations

import dataclasses
import functools

import numpy as np

from ..vectors import twice_areas
from .chart import signed_areas
from .head import Head
from .regions import Regions, find_regions, sample_masks
from .spec import FaceSpec
from .strands import Ground


def has_surround(spec: FaceSpec) -> bool:
    """Whether the head round the chart is painted like it: natural skin must not end at a rim."""
    return spec.detail == "natural" and spec.chart == "face"


@dataclasses.dataclass(frozen=True)
class Canvas:
    """A chart of a head: `vertices` (C,) its subdivided vertices, `triangles` (F,3), `uv` and `native_uv` (C,2),
    `rim_mm` (C,) distance to the outer rim of the face's chart, `is_face`: it has eyes, brows and a mouth; `scale` mm of
    the template per unit of UV."""

    head: Head
    vertices: np.ndarray
    triangles: np.ndarray
    uv: np.ndarray
    native_uv: np.ndarray
    rim_mm: np.ndarray
    is_face: bool
    scale: float

    @classmethod
    def face(cls, head: Head) -> Canvas:
        """The chart itself."""
        scale = float(
            np.sqrt(
                0.5
                * twice_areas(head.template, head.part_chart).sum()
                / signed_areas(head.chart_uv, head.chart_triangles).sum()
            )
        )
        return cls(
            head,
            head.chart_vertices,
            head.chart_triangles,
            head.chart_uv,
            head.native_uv,
            head.rim_mm,
            True,
            scale,
        )

    @classmethod
    def surround(cls, head: Head) -> Canvas:
        """The surround; its scale is that of the scalp."""
        vertices, triangles, uv = head.surround_vertices, head.surround_triangles, head.surround_uv
        ratio = 0.5 * twice_areas(head.template[vertices], triangles) / signed_areas(uv, triangles)
        scale = float(np.sqrt(np.median(ratio)))
        return cls(head, vertices, triangles, uv, head.surround_native_uv, head.surround_rim_mm, False, scale)

    @functools.cached_property
    def sites(self) -> Regions:
        """The vertices."""
        template = self.head.template[self.vertices].astype(np.float32)
        return find_regions(template, sample_masks(self.native_uv))

    def grounds(self) -> list[Ground]:
        """Where strands are rooted: on the chart, and off it."""
        head, area = self.head, 0.5 * twice_areas(self.head.template, self.head.part_chart)
        if self.is_face:
            return [Ground(self.uv[self.triangles], self.triangles, area, self.sites)]
        # The chart's own strands, so that those which cross its rim go on.
        corners = np.zeros((len(area), 3, 2))
        corners[head.surround_band] = self.uv[self.triangles[~head.surround_rest]]
        chart = Ground(corners, head.chart_triangles, area, Canvas.face(head).sites, elsewhere=~head.surround_band)
        behind = self.triangles[head.surround_rest]
        area = 0.5 * twice_areas(head.template[self.vertices], behind)
        return [chart, Ground(self.uv[behind], behind, area, self.sites, " behind")]

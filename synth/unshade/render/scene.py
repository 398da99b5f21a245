"""The head in Mitsuba: chart with its maps, the other parts, and one scene per light."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import mitsuba as mi
import numpy as np

from ..face import Chart, Face, Part
from .lights import AnyLight
from .principled_skin import principled_roughness
from .split import LambertLight

WET_ALPHA = 0.06
"""GGX alpha of the eyes, which are smoother than any skin."""


@dataclass(frozen=True)
class ChartMaps:
    """Maps of the chart; square arrays of any size, texel row 0 at v = 1.

    ``diffuse_albedo`` [N, N, 3] linear Rec.709, ``specular_albedo`` [N, N] (0 to 0.05),
    normals [N, N, 3] in object space, ``roughness`` [N, N, 3]: GGX alpha of lobe 1, of lobe 2,
    share of lobe 1. Without ``specular_albedo`` there are no highlights; without a normal map
    the mesh's own normal serves, without ``roughness`` the standard lobes of the skin.
    """

    diffuse_albedo: np.ndarray
    specular_albedo: np.ndarray | None = None
    diffuse_normal: np.ndarray | None = None
    specular_normal: np.ndarray | None = None
    roughness: np.ndarray | None = None

    @classmethod
    def truth(cls, face: Face) -> ChartMaps:
        maps = face.maps
        return cls(maps.diffuse_albedo, maps.specular_albedo, maps.diffuse_normal, maps.specular_normal, maps.roughness)


@dataclass(frozen=True)
class LitHead:
    """A head in a light, the same head without it (what cameras see), and how to sample it."""

    scene: Any
    dark: Any
    lambert_light: LambertLight


class HeadScene:
    """All shapes of a head, built once and shared by a scene without light and one per light.

    ``dark`` answers what a camera or a texel sees; pictures are traced in ``lit``. ``material`` of the chart is one
    of `scene_file.render.MATERIALS`; the other parts are always ``skin``.
    """

    def __init__(self, chart: Chart, parts: list[Part], maps: ChartMaps, material: str = "skin") -> None:
        skin = {
            "type": "skin",
            "diffuse": _texture(maps.diffuse_albedo),
            "specular": _texture(_or_zero(maps.specular_albedo, 1)),
            # A texel without direction means the mesh's own normal.
            "diffuse_normal": _texture(_or_zero(maps.diffuse_normal, 3)),
            "specular_normal": _texture(_or_zero(maps.specular_normal, 3)),
        }
        if maps.roughness is not None:
            skin["roughness"] = _texture(maps.roughness)
        if material == "principled":
            skin |= {
                "type": "principled_skin",
                "principled_roughness": _texture(principled_roughness(maps.roughness)),
            }
        self.skin = mi.load_dict(skin)
        self._join(mesh_shape("chart", chart, self.skin, uv=chart.uv), parts)

    @classmethod
    def around(cls, chart: Any, parts: list[Part]) -> HeadScene:
        """The head whose chart is a Mitsuba shape with a material of its own."""
        head = cls.__new__(cls)
        head.skin = chart.bsdf()
        head._join(chart, parts)
        return head

    def _join(self, chart: Any, parts: list[Part]) -> None:
        self.chart = chart
        self._shapes = {"chart": chart} | {part.name: _part(part) for part in parts}
        self.dark = mi.load_dict({"type": "scene", **self._shapes})

    def lit(self, light: AnyLight) -> LitHead:
        """The head in a light."""
        # Made one by one: those of one dictionary come in any order, and so would their samples.
        emitters = {
            name: mi.load_dict(emitter) if isinstance(emitter, dict) else emitter
            for name, emitter in light.emitters().items()
        }
        scene = mi.load_dict({"type": "scene", **self._shapes, **emitters})
        return LitHead(scene, self.dark, light.lambert_light)

    def set_diffuse_albedo(self, albedo: np.ndarray) -> None:
        """Replaces the diffuse albedo [N, N, 3] in all scenes of this head."""
        parameters = mi.traverse(self.skin)
        parameters["diffuse.data"] = mi.TensorXf(np.ascontiguousarray(albedo, dtype=np.float32))
        parameters.update()


def _part(part: Part):
    if part.uv is None:
        texture = part.texture
        if texture is None:
            bsdf = {
                "diffuse": {"type": "mesh_attribute", "name": "vertex_diffuse"},
                "specular": {"type": "mesh_attribute", "name": "vertex_specular"},
            }
        else:
            names = ("diffuse", "specular", "diffuse_normal", "specular_normal", "roughness")
            bsdf = {name: _texture(getattr(texture, name)) for name in names}
        skin = mi.load_dict({"type": "skin", **bsdf})
        mesh = mesh_shape(part.name, part, skin, uv=None if texture is None else texture.uv)
        mesh.add_attribute("vertex_diffuse", 3, _flat(part.diffuse))
        mesh.add_attribute("vertex_specular", 1, _flat(part.specular))
        return mesh
    bsdf = {
        "type": "skin",
        "diffuse": _texture(part.diffuse),
        "specular": _texture(part.specular),
        "alpha": WET_ALPHA,
    }
    return mesh_shape(part.name, part, mi.load_dict(bsdf), uv=part.uv)


def mesh_shape(name: str, shape: Any, bsdf: Any, uv: np.ndarray | None = None) -> Any:
    """A Mitsuba mesh of anything with ``vertices``, ``normals`` and ``triangles``; UV with v up."""
    properties = mi.Properties()
    properties["bsdf"] = bsdf
    mesh = mi.Mesh(
        name,
        len(shape.vertices),
        len(shape.triangles),
        props=properties,
        has_vertex_normals=True,
        has_vertex_texcoords=uv is not None,
    )
    parameters = mi.traverse(mesh)
    parameters["vertex_positions"] = _flat(shape.vertices)
    parameters["vertex_normals"] = _flat(shape.normals)
    parameters["faces"] = np.ascontiguousarray(shape.triangles, dtype=np.uint32).ravel()
    if uv is not None:
        # Mitsuba's texture row 0 lies at v = 0, ours at v = 1.
        parameters["vertex_texcoords"] = _flat(np.stack([uv[:, 0], 1 - uv[:, 1]], 1))
    parameters.update()
    return mesh


def _flat(values: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(values, dtype=np.float32).ravel()


def _or_zero(picture: np.ndarray | None, channels: int) -> np.ndarray:
    return np.zeros((2, 2, channels), np.float32) if picture is None else picture


def _texture(picture: np.ndarray) -> dict[str, Any]:
    picture = picture[..., None] if picture.ndim == 2 else picture
    return {
        "type": "bitmap",
        "bitmap": mi.Bitmap(np.ascontiguousarray(picture, dtype=np.float32)),
        "raw": True,
        "filter_type": "bilinear",
        "wrap_mode": "clamp",
    }

"""Maps resampled onto another mesh of the same face, such as the one that was imported, with its own UV."""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path

import numpy as np

from ..errors import MapsError
from ..face.texels import rasterise
from ..importing.chart_mesh import ChartMesh
from ..importing.maps.alignment import align, moved, source_to_capture
from ..importing.maps.counterpart import find_counterparts
from ..importing.maps.texture import padded, sampled
from ..render.scene import ChartMaps
from ..surface import Mesh, Surface, read_shape
from ..vectors import unit

LIMIT = 0.005
"""How far (m) a point of the other mesh may be from the maps' surface and still be the same."""

NORMALS = ("diffuse_normal", "specular_normal")


def onto_mesh(surface: Surface, capture: Path, mesh: Path) -> Surface:
    """Returns the maps of ``surface`` in the UV of the OBJ ``mesh``, which is moved to where the capture's lies.

    A texel takes the maps, bilinearly, at the surface's nearest point that faces its way; texels further than `LIMIT`
    take those of the nearest texel with such a point. Raises `CaptureError`, and `MapsError` if the meshes differ.
    """
    shape = read_shape(mesh)
    vertices = shape.vertices.astype(np.float64)
    place = align(
        (vertices, shape.triangles),
        surface.mesh.vertices.astype(np.float64),
        how="auto",
        unit=None,
        source=source_to_capture(capture),
        limit=LIMIT,
        shown=str(mesh),
    )
    turn = place.matrix[:3, :3] / np.cbrt(np.linalg.det(place.matrix[:3, :3]))
    shape = replace(
        shape,
        vertices=moved(place.matrix, vertices).astype(np.float32),
        normals=unit(shape.normals.astype(np.float64) @ turn.T).astype(np.float32),
    )
    if shape.uv.min() < -1e-4 or shape.uv.max() > 1 + 1e-4:
        raise MapsError(f"{mesh}: its UV leave the unit square; name a mesh whose UV lie on one tile")
    shape = replace(shape, uv=shape.uv.clip(0, 1))
    return Surface(shape, _resampled(surface, shape, mesh))


def _resampled(surface: Surface, shape: Mesh, mesh: Path) -> ChartMaps:
    ours = surface.mesh
    from_ = ChartMesh(
        ours.vertices.astype(np.float64),
        ours.triangles,
        ours.uv.astype(np.float64),
        None,
        None,
        (),
        np.zeros(0, np.int64),
    )
    counterparts = find_counterparts(
        shape.vertices,
        shape.normals,
        shape.uv,
        shape.triangles.astype(np.uint32),
        from_,
        size=surface.size,
        limit=LIMIT,
    )
    texels = counterparts.texels
    if not counterparts.found.any():
        raise MapsError(f"{mesh}: no texel lies on the maps' surface; name a mesh of the same face")
    uv = counterparts.at(from_.uv, from_.triangles)
    nearest = replace(texels, inside=texels.image(counterparts.found).astype(bool)).nearest_inside()
    result = dict[str, np.ndarray]()
    for field in fields(ChartMaps):
        values = getattr(surface.maps, field.name)
        if values is None:
            continue
        with np.errstate(divide="ignore", invalid="ignore"):
            chart = rasterise(from_.uv, from_.triangles, len(values))
        there = sampled(padded(values, chart), uv)
        if field.name in NORMALS:
            length = np.linalg.norm(there, axis=-1, keepdims=True)
            there = there / np.where(length > 1e-4, length, 1)
        result[field.name] = texels.image(there.astype(np.float32))[nearest]
    return ChartMaps(**result)

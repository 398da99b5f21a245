"""`build_own_head`: from files to everything a renderer needs."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np

from .. import _native
from ..face import Chart, Face, Label, Maps, Part
from ..face.chart import signed_areas
from ..face.normals import tangents
from ..face.spec import FaceError
from ..face.texels import Texels, rasterise
from ..vectors import triangle_normals, unit
from .map_files import linear, read_labels, read_normals, read_picture, resampled
from .mesh_file import read_pieces
from .outward import oriented_outwards
from .piece import Piece
from .placement import axes, in_metres, origin, smooth_normals
from .spec import SKIN_REFLECTANCE, HeadFiles, MeshWarning

_LARGEST_SPECULAR = 0.05


def build_own_head(head: HeadFiles) -> Face:
    """Builds the face from the files of your own head; the same files give equal bytes.

    Raises `FaceError` (or `PictureError`) for what cannot be rendered.
    """
    pieces = read_pieces(Path(head.mesh))
    inside, outside = _divide(pieces, head)
    joined = _joined(inside, head)
    start = origin(joined["points"], head)
    points = joined["points"] - start
    normals, triangles, uv = joined["normals"], joined["triangles"], joined["uv"]
    _check_outward(points, triangles, head)
    chart = Chart(
        vertices=points.astype(np.float32),
        normals=normals.astype(np.float32),
        uv=uv.astype(np.float32),
        triangles=triangles.astype(np.uint32),
    )
    parts = [_occluder(number, piece, head, start) for number, piece in enumerate(outside)]
    maps = _Painter(head, points, normals, uv, triangles).maps()  # now, since it checks the files
    return Face(spec=head, chart=chart, parts=parts, paint=lambda: maps)


def _divide(pieces: list[Piece], head: HeadFiles) -> tuple[list[Piece], list[Piece]]:
    """The pieces of the chart and the occluders."""
    if head.chart is None:
        return pieces, []
    names = [piece.name for piece in pieces]
    for name in head.chart:
        if name not in names:
            raise FaceError(
                f"{head.mesh}: there is no object {name!r} for chart; there are {', '.join(map(repr, names))}"
            )
    return [p for p in pieces if p.name in head.chart], [p for p in pieces if p.name not in head.chart]


def _joined(pieces: list[Piece], head: HeadFiles) -> dict[str, np.ndarray]:
    """One mesh of the chart's pieces, in metres along the world's axes, checked."""
    for piece in pieces:
        if piece.uv is None:
            raise FaceError(
                f"{head.mesh}: object {piece.name!r} has no UV, or some of its faces have none; unwrap it, or leave it out of chart"
            )
    points = np.concatenate([in_metres(piece, head) for piece in pieces])
    uv = np.concatenate([piece.uv for piece in pieces])
    starts = np.cumsum([0, *(len(piece.vertices) for piece in pieces[:-1])])
    triangles = np.concatenate([piece.triangles + first for piece, first in zip(pieces, starts)])
    _, areas = _areas(points, triangles)
    with_area = areas > 0
    triangles = triangles[with_area]  # without area, without a normal
    used, triangles = np.unique(triangles, return_inverse=True)
    triangles = triangles.reshape(-1, 3)
    points, uv = points[used], uv[used]
    _check_uv(points, uv, triangles, pieces, with_area, head)
    # Normals of the file only if it has all of them.
    given = [piece.normals for piece in pieces]
    normals = None if any(n is None for n in given) else np.concatenate(given)[used] @ axes(head).T
    if normals is not None and not (np.linalg.norm(normals, axis=1) > 1e-6).all():
        normals = None
    triangles, normals = oriented_outwards(points, triangles, normals, head)
    if normals is None:
        normals = smooth_normals(points, triangles)
    return {"points": points, "normals": unit(normals), "uv": uv, "triangles": triangles}


def _check_uv(
    points: np.ndarray,
    uv: np.ndarray,
    triangles: np.ndarray,
    pieces: list[Piece],
    with_area: np.ndarray,
    head: HeadFiles,
) -> None:
    """Refuses a layout that cannot carry maps; ``with_area`` (F,) are the pieces' triangles that are left."""
    names = [name for piece in pieces for name in piece.parts]
    starts = np.cumsum([0, *(len(piece.parts) for piece in pieces[:-1])])
    part_of = np.concatenate([piece.part_of + first for piece, first in zip(pieces, starts)])[with_area]
    fault, warning, *_ = _native.examine_layout(points, uv, triangles, part_of, names)
    if fault is not None:
        raise FaceError(f"{head.mesh}: {fault}")
    if warning is not None:
        warnings.warn(f"{head.mesh}: {warning}", MeshWarning, stacklevel=2)


def _unwrapped(uv: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Which triangles have an area in UV (F,) bool."""
    return np.abs(signed_areas(uv, triangles)) > 1e-14


def _check_outward(points: np.ndarray, triangles: np.ndarray, head: HeadFiles) -> None:
    normals, areas = _areas(points, triangles)
    outward = (areas * (normals * points[triangles].mean(axis=1)).sum(axis=1)).sum()
    if outward <= 0:
        raise FaceError(
            f"{head.mesh}: its triangles face inwards as seen from the origin; "
            "put origin inside the head, and state the axes up and forward that the head has"
        )


def _areas(points: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Unit normals (F,3) and areas (F,) of triangles."""
    crossed = triangle_normals(points, triangles)
    return unit(crossed), 0.5 * np.linalg.norm(crossed, axis=1)


def _occluder(number: int, piece: Piece, head: HeadFiles, start: np.ndarray) -> Part:
    points = in_metres(piece, head) - start
    triangles = piece.triangles[_areas(points, piece.triangles)[1] > 0]
    count = len(points)
    return Part(
        name=f"occluder{number}",
        vertices=points.astype(np.float32),
        normals=smooth_normals(points, triangles).astype(np.float32),
        triangles=triangles.astype(np.uint32),
        diffuse=np.tile(np.array(head.occluder_albedo, np.float32), (count, 1)),
        specular=np.full(count, SKIN_REFLECTANCE, np.float32),
    )


class _Painter:
    """The maps of one head: read, resampled, checked where the chart is."""

    def __init__(
        self, head: HeadFiles, points: np.ndarray, normals: np.ndarray, uv: np.ndarray, triangles: np.ndarray
    ) -> None:
        self._head = head
        # Slivers without texels also have no tangents.
        triangles = triangles[_unwrapped(uv, triangles)]
        self._mesh = points, uv, triangles
        self._texels: Texels = rasterise(uv, triangles, head.texture_size)
        if not self._texels.inside.any():
            raise FaceError(
                f"{head.mesh}: no texel of {head.texture_size} x {head.texture_size} lies in the UVs; raise texture_size"
            )
        self._nearest_inside: dict[int, tuple[np.ndarray, np.ndarray]] = {
            head.texture_size: self._texels.nearest_inside()
        }
        self._smooth = unit(self._texels.sample(normals))

    def maps(self) -> Maps:
        return Maps(
            diffuse_albedo=self._filled(self._albedo()),
            specular_albedo=self._filled(self._specular()),
            specular_normal=self._filled(self._normal("specular_normal")),
            diffuse_normal=self._filled(self._normal("diffuse_normal")),
            roughness=self._filled(self._roughness()),
            labels=self._labels(),
            inside=self._texels.inside,
        )

    def _nearest(self, side: int) -> tuple[np.ndarray, np.ndarray]:
        """Row and column of the nearest texel inside, for maps of ``side`` x ``side``."""
        if side not in self._nearest_inside:
            _, uv, triangles = self._mesh
            self._nearest_inside[side] = rasterise(uv, triangles, side).nearest_inside()
        return self._nearest_inside[side]

    def _filled(self, values: np.ndarray) -> np.ndarray:
        """Values of the chart's texels as a picture, the rest as their nearest."""
        return self._texels.image(values.astype(np.float32))[self._nearest(self._head.texture_size)]

    def _texel_values(self, key: str, space: str | None = None) -> np.ndarray:
        """A map (M,3) at the chart's texels: of its file, or its constant."""
        value = getattr(self._head, key)
        if not isinstance(value, str):
            return np.broadcast_to(np.asarray(value, np.float32), (len(self._texels.triangle), 3))
        picture = read_picture(value, colour=key.endswith("albedo"))
        if space is not None:
            picture = linear(picture, space)
        return resampled(picture, self._nearest, self._head.texture_size)[self._texels.inside]

    def _albedo(self) -> np.ndarray:
        albedo = self._texel_values("diffuse_albedo", self._head.diffuse_albedo_space)
        self._within("diffuse_albedo", albedo, 0, 1, "reflect no more than the light that falls in")
        return albedo

    def _specular(self) -> np.ndarray:
        values = self._texel_values("specular_albedo", self._head.specular_albedo_space)[:, 1]
        if isinstance(self._head.specular_albedo, str):
            values = values * np.float32(self._head.specular_albedo_scale)
        fix = f"state specular_albedo_scale (now {self._head.specular_albedo_scale:g}) so that reflectance stays within"
        self._within("specular_albedo", values, 0, _LARGEST_SPECULAR * 1.001, fix)
        return values.clip(0, _LARGEST_SPECULAR)

    def _roughness(self) -> np.ndarray:
        values = self._texel_values("roughness")
        if self._head.roughness_space == "perceptual" and isinstance(self._head.roughness, str):
            alpha = (values[:, 0] ** 2).clip(0.01)
            values = np.stack([alpha, alpha, np.full_like(alpha, 0.5)], -1)
        self._within("roughness", values[:, :2], 0.0099, 1, "write GGX alphas")
        self._within("roughness", values[:, 2], 0, 1, "write the share of the first lobe")
        return values

    def _normal(self, key: str) -> np.ndarray:
        """Unit normals (M,3) along the world's axes; the mesh's where the file has no direction."""
        path = getattr(self._head, key)
        if path is None:
            return self._smooth
        vectors = read_normals(path)
        points, uv, triangles = self._mesh
        n = resampled(vectors, self._nearest, self._head.texture_size)[self._texels.inside]
        known = np.linalg.norm(n, axis=1, keepdims=True) > 0.1
        if getattr(self._head, f"{key}_space") == "object":
            n = n @ axes(self._head).T
        else:
            along, upward = (self._texels.sample(t) for t in tangents(points, uv, triangles))
            smooth = self._smooth
            tangent = unit(along - smooth * (smooth * along).sum(1, keepdims=True))
            bitangent = np.cross(smooth, tangent)
            # Mirrored islands turn the frame over.
            bitangent *= np.where((bitangent * upward).sum(1, keepdims=True) < 0, -1, 1)
            n = n[:, :1] * tangent + n[:, 1:2] * bitangent + n[:, 2:] * smooth
        return np.where(known, unit(n), self._smooth)

    def _labels(self) -> np.ndarray:
        size, inside = self._head.texture_size, self._texels.inside
        if self._head.labels is None:
            return np.where(inside, np.uint8(Label.SKIN), np.uint8(0))
        labels = np.where(inside, read_labels(self._head.labels, size), 0).astype(np.uint8)
        if labels.max() > max(Label):
            raise FaceError(f"{self._head.labels}: holds label {labels.max()}; use {min(Label)} to {max(Label)}")
        return labels

    def _within(self, key: str, values: np.ndarray, low: float, high: float, fix: str) -> None:
        smallest, largest = float(values.min()), float(values.max())
        if not (low <= smallest and largest <= high):
            reach = f"{key} reaches from {smallest:.4g} to {largest:.4g} on the chart"
            raise FaceError(f"{getattr(self._head, key)}: {reach}; {fix} {low:.3g} to {high:.3g}")

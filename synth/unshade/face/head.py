"""The head that all faces begin with: subdivided head, its parts, the chart, the morph targets."""

from __future__ import annotations

import dataclasses

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from . import base_mesh
from .chart import boundary_loops, packed, unwrap
from .expression import UNITS, target
from .subdivide import subdivide, triangulate

JAW = target("jawOpen")
PARTS = ("chart", "rest", "mouth", "sockets")
LEVELS = 2

ETHNIC = ("african", "asian", "caucasian")
LOCAL_FOLDERS = ("head", "nose", "mouth", "eyes", "chin", "cheek", "forehead", "ears", "eyebrows")

# A point in the native UV inside each island that is used.
_ISLANDS = {
    "head": (0.82, 0.5),
    "mouth": (0.84, 0.07),
    "socket_l": (0.04, 0.59),
    "socket_r": (0.12, 0.59),
    "body": (0.4, 0.6),
}
# Neck and shoulders: the body above this height and within this half width (m).
_SHOULDER_HEIGHT, _SHOULDER_HALF_WIDTH = 0.52, 0.17
# Left half of the teeth bands from the midline back, counted in their own groups: the rim in the gum, the biting edge.
_GUM_RIM = (1, 0, 2, 3, 4, 5, 6, 7, 8)
_UPPER_RIMS = (_GUM_RIM, (9, 26, 11, 10, 25, 18, 17, 16, 20))
_LOWER_RIMS = (_GUM_RIM, (18, 9, 10, 11, 12, 13, 14, 15, 16))
# The chart ends behind the ears and, over the forehead, leans back with the skull (m).
_CHART_DEPTH, _CHART_CROWN = 0.04, 0.775
_BAND = 0.026
"""The surround reaches this far (m) into the chart: as far as the longest strands of hair."""
_SHOULDER_SCALE = 0.5
"""Scale of neck and shoulders in a surround, where they are farther from the face and plainer than the scalp."""


@dataclasses.dataclass(frozen=True)
class Head:
    """Identity-independent arrays; B base vertices, V subdivided ones, C of them in the chart.

    `base` (B,3) m; `refine_*` the CSR matrix (V,B) of the subdivision; `eyes` (2,E) base
    indices of the eyeballs, left first; `arches` (2,2,17) those of the upper and the lower
    dental arch, each at the gum's far rim and at the biting edge, from right to left;
    `tongue` (F,4) quads of base vertices; `target_names` and `targets_*` the CSR matrix
    (T,3B) of the morph targets in metres; `template` (V,3) and `eye_template` (2,4: centre,
    radius) the average young head in PAINT coordinates: millimetres from the midpoint of
    the eyes' centres. `part_<name>` (F,3) triangles of subdivided vertices. The chart:
    `chart_vertices` (C,) subdivided indices, ascending, twice where a seam runs; `chart_triangles`
    those of `part_chart` as indices into the C vertices; `chart_uv` (C,2); `native_uv` (C,2)
    of the base mesh, where the region masks live; `rim_mm` (C,) distance to its outer rim.

    The surround, a second chart of S vertices over `part_rest` and a band of the chart along it, so that paint can
    run across the rim (empty for a wide chart): `surround_vertices` (S,), `surround_triangles`, `surround_uv` (S,2),
    `surround_native_uv` (S,2), `surround_rim_mm` like those of the chart; `surround_rest` which of its triangles are those of
    `part_rest`, in order; `surround_band` which of the chart's triangles are the others, in order.
    """

    base: np.ndarray
    refine_data: np.ndarray
    refine_indices: np.ndarray
    refine_indptr: np.ndarray
    eyes: np.ndarray
    arches: np.ndarray
    tongue: np.ndarray
    target_names: np.ndarray
    targets_data: np.ndarray
    targets_indices: np.ndarray
    targets_indptr: np.ndarray
    template: np.ndarray
    eye_template: np.ndarray
    part_chart: np.ndarray
    part_rest: np.ndarray
    part_mouth: np.ndarray
    part_sockets: np.ndarray
    chart_vertices: np.ndarray
    chart_triangles: np.ndarray
    chart_uv: np.ndarray
    native_uv: np.ndarray
    rim_mm: np.ndarray
    surround_vertices: np.ndarray
    surround_triangles: np.ndarray
    surround_uv: np.ndarray
    surround_native_uv: np.ndarray
    surround_rim_mm: np.ndarray
    surround_rest: np.ndarray
    surround_band: np.ndarray

    def refine(self, base: np.ndarray) -> np.ndarray:
        """Subdivided positions (V,3) of base positions (B,3)."""
        shape = (len(self.template), len(self.base))
        return sp.csr_matrix((self.refine_data, self.refine_indices, self.refine_indptr), shape=shape) @ base

    def morph(self, weights: dict[str, float]) -> np.ndarray:
        """Base positions (B,3) m of the weighted morph targets."""
        row = {name: i for i, name in enumerate(self.target_names)}
        dense = np.zeros(len(self.target_names))
        for name, weight in weights.items():
            dense[row[name]] += weight
        shape = (len(dense), self.base.size)
        targets = sp.csr_matrix((self.targets_data, self.targets_indices, self.targets_indptr), shape=shape)
        return self.base + (targets.T @ dense).reshape(-1, 3)


def average_weights() -> dict[str, float]:
    """Morph weights of the template: young, of average build, every ethnicity and gender alike."""
    weights = {f"macrodetails/{e}-{g}-young": 1 / 6 for e in ETHNIC for g in ("female", "male")}
    return weights | {
        f"macrodetails/universal-{g}-young-averagemuscle-averageweight": 1 / 2 for g in ("female", "male")
    }


def fit_sphere(points: np.ndarray) -> np.ndarray:
    """Least-squares sphere through points (N,3): centre and radius (4,)."""
    system = np.c_[2 * points, np.ones(len(points))]
    x, y, z, rest = np.linalg.lstsq(system, (points**2).sum(axis=1), rcond=None)[0]
    return np.array([x, y, z, np.sqrt(rest + x * x + y * y + z * z)])


def make_head(wide: bool = False) -> Head:
    """Build everything from the head data; slow (see `cache.load_head`).

    The chart is the face to behind the ears or, if `wide`, head, neck and shoulders.
    """
    mesh = base_mesh.read_base_mesh()
    quads, uv_quads, part = _select(mesh)
    if wide:
        part[part == "rest"] = "chart"
    eyes = np.stack([np.unique(mesh.quads[mesh.groups == f"helper-{s}-eye"]) for s in "lr"])
    arches, tongue = _dental_arches(mesh), mesh.quads[mesh.groups == "helper-tongue"]
    used = np.unique(np.concatenate([part.ravel() for part in (quads, eyes, arches, tongue)]))
    compact = np.full(len(mesh.vertices), -1)
    # Head vertices first: only they are subdivided.
    skin = np.unique(quads)
    order = np.r_[skin, np.setdiff1d(used, skin)]
    compact[order] = np.arange(len(order))
    quads, eyes, arches, tongue = (compact[part] for part in (quads, eyes, arches, tongue))
    base = mesh.vertices[order]
    names, targets = _targets(compact, len(base))

    refine, fine_quads = subdivide(quads, len(skin), LEVELS)
    refine = sp.csr_matrix((refine.data, refine.indices, refine.indptr), shape=(refine.shape[0], len(base)))
    fine_part = np.repeat(part, 4**LEVELS)

    blank = np.zeros(0)
    head = Head(
        base, refine.data, refine.indices, refine.indptr, eyes, arches, tongue, names, targets.data, targets.indices, targets.indptr,
        np.zeros((refine.shape[0], 3)), blank, *(triangulate(fine_quads[fine_part == p]) for p in PARTS), *[blank] * 12,
    )  # fmt: skip
    young = head.morph(average_weights())
    spheres = np.stack([fit_sphere(young[e]) for e in eyes])
    middle = spheres[:, :3].mean(axis=0)
    spheres[:, :3] -= middle
    template = 1000 * (head.refine(young) - middle)

    front, rest = part == "chart", part == "rest"
    near = front & _beside(young, quads, rest)
    charted = [_charted(young, quads, fine_quads, uv_quads, mesh.uv, front, wide)]
    charted.append(
        [blank] * 4 if wide else _charted(young, quads, fine_quads, uv_quads, mesh.uv, rest | near, True, True)
    )
    chart, surround = charted
    to_rim = cKDTree(template[_outer_rim(template, head.part_chart)])
    # Triangles that each quad becomes.
    cut = 2 * 4**LEVELS
    return dataclasses.replace(
        head,
        template=template,
        eye_template=1000 * spheres,
        **dict(zip(("chart_vertices", "chart_triangles", "chart_uv", "native_uv"), chart)),
        rim_mm=to_rim.query(template[chart[0]])[0],
        **dict(zip(("surround_vertices", "surround_triangles", "surround_uv", "surround_native_uv"), surround)),
        surround_rim_mm=blank if wide else to_rim.query(template[surround[0]])[0],
        surround_rest=np.repeat(rest[rest | near], cut),
        surround_band=np.repeat(near[front], cut),
    )


def _beside(young: np.ndarray, quads: np.ndarray, rest: np.ndarray) -> np.ndarray:
    """Which quads (F,) bool lie within the band of the surround along those of `rest` (F,) bool."""
    if not rest.any():
        return rest
    return cKDTree(young[np.unique(quads[rest])]).query(young[quads].mean(axis=1))[0] < _BAND


def _charted(
    young: np.ndarray,
    quads: np.ndarray,
    fine_quads: np.ndarray,
    uv_quads: np.ndarray,
    native: np.ndarray,
    chosen: np.ndarray,
    cut: bool,
    surround: bool = False,
) -> tuple[np.ndarray, ...]:
    """Subdivided vertices (N,), triangles, UV and native UV (N,2) of a chart of the `chosen` quads (F,) bool."""
    local, uv, own_native = _chart(young, quads[chosen], uv_quads[chosen], native, cut, surround)
    # Subdivided vertex of every vertex in the chart's own subdivision.
    spread, fine_local = subdivide(local, len(uv), LEVELS)
    joined = np.empty(spread.shape[0], dtype=np.int64)
    joined[fine_local] = fine_quads[np.repeat(chosen, 4**LEVELS)]
    own = np.argsort(joined, kind="stable")
    return joined[own], np.argsort(own)[triangulate(fine_local)], (spread @ uv)[own], (spread @ own_native)[own]


def _select(mesh: base_mesh.BaseMesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Quads (F,4), their native UV indices, and the part of each, of head, neck and shoulders."""
    body = mesh.groups == "body"
    quads, uv_quads = mesh.quads[body], mesh.uv_quads[body]
    sides = np.stack([uv_quads, np.roll(uv_quads, -1, axis=1)], axis=-1).reshape(-1, 2)
    graph = sp.coo_matrix((np.ones(len(sides)), sides.T), shape=(len(mesh.uv),) * 2)
    island = connected_components(graph, directed=False)[1][uv_quads[:, 0]]
    centre_uv, centre = mesh.uv[uv_quads].mean(axis=1), mesh.vertices[quads].mean(axis=1)
    at = {name: island == island[np.abs(centre_uv - spot).sum(axis=1).argmin()] for name, spot in _ISLANDS.items()}

    front = centre[:, 2] > _CHART_DEPTH + np.maximum(0, centre[:, 1] - _CHART_CROWN)
    shoulders = at["body"] & (centre[:, 1] > _SHOULDER_HEIGHT) & (np.abs(centre[:, 0]) < _SHOULDER_HALF_WIDTH)
    part = np.full(len(quads), "", dtype="<U8")
    part[at["head"] | shoulders] = "rest"
    part[at["head"] & front] = "chart"
    part[at["mouth"]] = "mouth"
    part[at["socket_l"] | at["socket_r"]] = "sockets"
    keep = part != ""
    return quads[keep], uv_quads[keep], part[keep]


def _dental_arches(mesh: base_mesh.BaseMesh) -> np.ndarray:
    """Vertices (2,2,17) of the bands that stand for the teeth; see `Head.arches`."""
    arches = []
    for helper, rims in (("upper", _UPPER_RIMS), ("lower", _LOWER_RIMS)):
        own = np.unique(mesh.quads[mesh.groups == f"helper-{helper}-teeth"])
        tree = cKDTree(mesh.vertices[own])
        for rim in rims:
            left = own[list(rim)]
            right = own[tree.query(mesh.vertices[left[1:]] * [-1, 1, 1])[1]]
            arches.append(np.r_[right[::-1], left])
    return np.array(arches).reshape(2, 2, -1)


def _chart(
    young: np.ndarray, quads: np.ndarray, uv_quads: np.ndarray, native: np.ndarray, cut: bool, surround: bool
) -> tuple[np.ndarray, ...]:
    """Quads (F,4) of the chart's own vertices, their UV in the chart and in the base mesh (N,2).

    More than the front is `cut` open along the base mesh's seams; of them the front has but the end of one, in a rim.
    A `surround` has no mouth, and its islands that do not reach up to the crown are small.
    """
    seams = uv_quads.ravel() if cut else np.zeros(uv_quads.size, dtype=uv_quads.dtype)
    corners, first, local = np.unique(
        np.stack([quads.ravel(), seams], axis=1), axis=0, return_index=True, return_inverse=True
    )
    guess = native[uv_quads.ravel()[first]]
    local = local.reshape(quads.shape)
    sides = np.stack([local, np.roll(local, -1, axis=1)], axis=-1).reshape(-1, 2)
    graph = sp.coo_matrix((np.ones(len(sides)), sides.T), shape=(len(corners),) * 2)
    count, island = connected_components(graph, directed=False)
    # The face comes first: it has most vertices.
    members = sorted((np.flatnonzero(island == k) for k in range(count)), key=len, reverse=True)
    islands = []
    for own in members:
        inner = np.searchsorted(own, local[island[local[:, 0]] == island[own[0]]])
        points = young[corners[own, 0]]
        loops = boundary_loops(triangulate(inner))[1:]
        # The mouth is the inner loop on the midline; the other inner loops are the eyes.
        mouth = min(loops, key=lambda loop: abs(points[loop, 0].mean())) if loops and not surround else None
        crowned = points[:, 1].max() > young[:, 1].max() - 0.02
        islands.append((1.0 if crowned or not surround else _SHOULDER_SCALE) * unwrap(points, inner, guess[own], mouth))
    uv = np.empty((len(corners), 2))
    uv[np.concatenate(members)] = np.concatenate(packed(islands))
    return local, uv, guess


def _outer_rim(template: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """The vertices of the chart's widest rim: not that of an eye or of the mouth."""
    used, local = np.unique(triangles, return_inverse=True)
    loops = [used[loop] for loop in boundary_loops(local.reshape(-1, 3))]
    return max(loops, key=lambda loop: np.ptp(template[loop], axis=0).max())


def _targets(compact: np.ndarray, count: int) -> tuple[np.ndarray, sp.csr_matrix]:
    """Names and CSR (T,3B) of the targets that move the kept vertices."""
    macro = [f"macrodetails/{e}-{g}-{a}" for e in ETHNIC for g in ("female", "male") for a in ("young", "old")]
    macro += [
        f"macrodetails/universal-{g}-{a}-{m}muscle-{w}weight"
        for g in ("female", "male") for a in ("young", "old") for m in ("min", "average", "max") for w in ("min", "average", "max")
    ]  # fmt: skip
    local = [f"{folder}/{name}" for folder in LOCAL_FOLDERS for name in base_mesh.target_names(folder)]
    asymmetry = [f"asym/{name}" for name in base_mesh.target_names("asym") if name.startswith("asym-")]
    # The jaw, which shapes every face, keeps its place in the sum.
    units = [JAW] + [target(unit) for unit in UNITS if target(unit) != JAW]
    names, columns, values, starts = macro + local + asymmetry + units, [], [], [0]
    for name in names:
        index, offset = base_mesh.read_target(name)
        kept = compact[index] >= 0
        columns.append((3 * compact[index[kept], None] + np.arange(3)).ravel())
        values.append(offset[kept].ravel())
        starts.append(starts[-1] + columns[-1].size)
    table = sp.csr_matrix(
        (np.concatenate(values), np.concatenate(columns), np.array(starts)), shape=(len(names), 3 * count)
    )
    table.sort_indices()
    return np.array(names), table

"""The captured mesh: what was asked for is what was done, and the chart stays a chart."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from unshade.captured_mesh import degrade, deviation
from unshade.errors import SceneError
from unshade.face import Chart
from unshade.face.cache import load_head
from unshade.face.geometry import place
from unshade.face.identity import shape
from unshade.face.spec import FaceSpec
from unshade.face.texels import rasterise
from unshade.scene_file import CapturedMesh
from unshade.vectors import vertex_normals

STEPS = 70


def sheet(height=None, arc=2.2):
    """A 160 mm square sheet with a lens-shaped hole, bent to a half tube or with its own
    height; vertices in a regular grid."""
    u, v = (a.ravel() for a in np.meshgrid(*[np.linspace(0, 1, STEPS)] * 2))
    across, up = (u - 0.5) * 0.16, (v - 0.5) * 0.16
    if height is None:
        radius = 0.16 / arc
        points = np.stack([radius * np.sin(across / radius), up, radius * np.cos(across / radius)], 1)
    else:
        points = np.stack([across, up, height(across, up)], 1)
    corner = (np.arange(STEPS - 1)[:, None] * STEPS + np.arange(STEPS - 1)).ravel()
    quads = np.stack([corner, corner + 1, corner + STEPS + 1, corner + STEPS], 1)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    middle = points[triangles].mean(1)
    if height is None:
        hole = (middle[:, 1] / 0.01) ** 2 + (np.arctan2(middle[:, 0], middle[:, 2]) / 0.4) ** 2 < 1
        triangles = triangles[~hole]
    used, local = np.unique(triangles, return_inverse=True)
    uv = (0.05 + 0.9 * np.stack([u, v], 1))[used]
    points, triangles = points[used], local.reshape(-1, 3)
    return Chart(
        *(a.astype(np.float32) for a in (points, vertex_normals(points, triangles), uv)), triangles.astype(np.uint32)
    )


@pytest.fixture(scope="module")
def face_chart():
    head, spec = load_head(), FaceSpec("ada", 1, "III", 0.5, 0.5, (0.3, 0.3, 0.4), 0.5, texture_size=64)
    geometry, used = place(head, shape(head, spec)), head.chart_vertices
    return Chart(
        *(a.astype(np.float32) for a in (geometry.positions[used], geometry.normals[used], head.chart_uv)),
        head.chart_triangles.astype(np.uint32),
    )


SHEET = sheet()


def holes(chart):
    """Holes of a connected disk with holes, by its Euler characteristic V - E + F = 1 - holes."""
    triangles = chart.triangles.astype(np.int64)
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    edges, count = np.unique(edges, axis=0, return_counts=True)
    assert count.max() == 2 and len(np.unique(triangles)) == len(chart.vertices)
    return 1 - (len(chart.vertices) - len(edges) + len(triangles))


def twice_areas(chart):
    a, b, c = (chart.uv.astype(float)[chart.triangles[:, k]] for k in range(3))
    return (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]


def require_chart(chart, count):
    """Counter-clockwise everywhere, nowhere twice, holes still open, normals unit and outwards."""
    areas = twice_areas(chart)
    assert (areas > 0).all()
    # Overlapping triangles would have more area than the texels that they cover together.
    size = 1024
    covered = rasterise(chart.uv.astype(float), chart.triangles.astype(np.int64), size).inside.mean()
    assert -2e-4 < covered - areas.sum() / 2 < 1e-3
    assert holes(chart) == count
    assert chart.uv.min() >= 0 and chart.uv.max() <= 1
    assert np.abs(np.linalg.norm(chart.normals, axis=1) - 1).max() < 1e-5
    assert [a.dtype for a in (chart.vertices, chart.normals, chart.uv, chart.triangles)] == [np.float32] * 3 + [
        np.uint32
    ]


@pytest.mark.parametrize("fraction", [0.5, 0.1, 0.03])
def test_decimation_keeps_a_share_of_the_vertices_and_the_chart(fraction):
    small = degrade(SHEET, CapturedMesh(vertex_share=fraction), 1)
    assert len(small.vertices) == round(fraction * len(SHEET.vertices))
    require_chart(small, holes(SHEET))
    # Every vertex is an old one, with its own texture coordinates.
    distance, old = cKDTree(SHEET.uv).query(small.uv)
    assert distance.max() == 0 and (SHEET.vertices[old] == small.vertices).all()
    # Against the tube's own equation at the middles of the triangles: chords cut the arc.
    corners = small.vertices.astype(float)[small.triangles]
    middles = np.concatenate([corners.mean(1), *((corners[:, k] + corners[:, k - 1]) / 2 for k in range(3))])
    radius = 0.16 / 2.2
    off = np.abs(np.hypot(middles[:, 0], middles[:, 2]) - radius)
    # The sagitta of an even mesh's edge; the longest edge may be 2.6 times as long.
    sagitta = 0.16**2 / len(SHEET.vertices) / fraction / (8 * radius)
    assert off.max() < 7 * sagitta and off.mean() < 0.7 * sagitta
    assert deviation(SHEET, small)["max_distance_to_truth_mm"] < 1e-3


def test_a_face_keeps_its_outline_eyes_and_mouth(face_chart):
    small = degrade(face_chart, CapturedMesh(vertex_share=0.1), 1)
    require_chart(small, 3)
    deviations = deviation(face_chart, small)
    assert deviations["vertices"] == round(0.1 * len(face_chart.vertices)) and deviations["uv_flips"] == 0
    # Half the spacing of the vertices that are left is some 2 mm; features are kept better.
    assert 0.01 < deviations["mean_distance_from_truth_mm"] < 0.1 and deviations["max_distance_from_truth_mm"] < 1.0


def test_a_mesh_that_cannot_be_decimated_that_far_is_refused():
    with pytest.raises(SceneError, match="vertex_share .* of the vertices remain"):
        degrade(sheet_of_four(), CapturedMesh(vertex_share=0.01), 1)


def sheet_of_four():
    """One quad cut twice around a middle vertex: nothing can go but the middle."""
    uv = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0.5]], np.float32)
    points = np.concatenate([uv, np.zeros((5, 1), np.float32)], 1)
    triangles = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]], np.uint32)
    return Chart(points, np.tile(np.float32([0, 0, 1]), (5, 1)), uv, triangles)


def test_bumps_have_their_height_and_wavelength():
    level = sheet(lambda x, y: 0 * x)
    bumpy = degrade(level, CapturedMesh(bumps_mm=0.3, bumps_wavelength_mm=16.0), 4)
    heights = 1000 * bumpy.vertices[:, 2].astype(float).reshape(STEPS, STEPS)
    assert np.abs(bumpy.vertices[:, :2] - level.vertices[:, :2]).max() < 1e-7
    inner = heights[1:-1, 1:-1]
    assert np.sqrt((inner**2).mean()) == pytest.approx(0.3, rel=0.02)
    # Isotropic waves of one length in space: sin(kr)/(kr), with its zero at half the wavelength.
    spacing = 160 / (STEPS - 1)

    def correlation(steps):
        pairs = [(heights[:, :-steps], heights[:, steps:]), (heights[:-steps], heights[steps:])]
        return np.mean([(a * b).mean() for a, b in pairs]) / (heights**2).mean()

    for millimetres in (2.0, 5.0, 8.0, 11.5):
        steps = round(millimetres / spacing)
        assert correlation(steps) == pytest.approx(np.sinc(2 * steps * spacing / 16), abs=0.12)
    # Normals follow the bumps.
    slope = np.gradient(heights / 1000, spacing / 1000, axis=1)
    normals = bumpy.normals.reshape(STEPS, STEPS, 3)
    assert np.corrcoef(slope[2:-2, 2:-2].ravel(), (-normals[..., 0] / normals[..., 2])[2:-2, 2:-2].ravel())[0, 1] > 0.98


@pytest.mark.parametrize("sigma", [1.5, 3.0])
def test_smoothing_is_a_gaussian_of_its_width(sigma):
    wave = 2 * np.pi / 0.02
    rough = sheet(lambda x, y: 1e-5 * np.cos(wave * x))
    smooth = degrade(rough, CapturedMesh(smoothing_mm=sigma), 1)
    before, after = (c.vertices[:, 2].reshape(STEPS, STEPS)[20:-20, 20:-20].astype(float) for c in (rough, smooth))
    left = (before * after).sum() / (before**2).sum()
    # Implicit steps fall a little short of the Gaussian.
    assert left == pytest.approx(np.exp(-((wave * sigma / 1000) ** 2) / 2), rel=0.08)
    rim = np.abs(rough.uv - 0.5).max(1) > 0.449
    assert rim.sum() == 4 * (STEPS - 1) and (smooth.vertices[rim] == rough.vertices[rim]).all()


def test_all_together_repeats_bit_by_bit_and_nothing_changes_nothing():
    spec = CapturedMesh(vertex_share=0.2, smoothing_mm=1.0, bumps_mm=0.2, bumps_wavelength_mm=8.0)
    first, again, other = (degrade(SHEET, spec, seed) for seed in (1, 1, 2))
    for name in ("vertices", "normals", "uv", "triangles"):
        assert getattr(first, name).tobytes() == getattr(again, name).tobytes()
    assert first.vertices.shape == other.vertices.shape and (first.vertices != other.vertices).any()
    require_chart(first, holes(SHEET))
    deviations = deviation(SHEET, first)
    # The mean height of Gaussian bumps is 0.8 of their rms.
    assert 0.1 < deviations["mean_distance_to_truth_mm"] < 0.25 and deviations["max_distance_to_truth_mm"] < 1.2
    assert degrade(SHEET, CapturedMesh(), 1) is SHEET


def test_seams_do_not_open():
    """Two islands that share a row of points in space stay together when all is degraded."""
    left, right = sheet(lambda x, y: 0 * x), sheet(lambda x, y: 0 * x)
    half = np.float32([0.45, 1.0])
    shifted = right.vertices + np.float32([left.vertices[:, 0].max() - right.vertices[:, 0].min(), 0, 0])
    both = Chart(
        np.concatenate([left.vertices, shifted]), np.concatenate([left.normals, right.normals]),
        np.concatenate([left.uv * half, right.uv * half + np.float32([0.5, 0])]),
        np.concatenate([left.triangles, right.triangles + np.uint32(len(left.vertices))]),
    )  # fmt: skip
    seam = left.vertices[:, 0] == left.vertices[:, 0].max()
    spec = CapturedMesh(vertex_share=0.2, bumps_mm=0.3, bumps_wavelength_mm=20.0)
    joined = degrade(both, spec, 1)
    _, count = np.unique(joined.vertices, axis=0, return_counts=True)
    assert (count == 2).sum() == seam.sum() and count.max() == 2

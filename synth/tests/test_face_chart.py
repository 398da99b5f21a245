"""Subdivision, chart and texels, against closed forms and areas."""

import numpy as np
import pytest

from unshade.face import cache, chart, geometry, subdivide, texels


@pytest.fixture(scope="module")
def head():
    return cache.load_head()


def test_one_step_of_a_cube_is_catmull_and_clarks():
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
    quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    refine, finer = subdivide.catmull_clark(quads, 8)
    points = refine @ corners
    assert finer.shape == (24, 4) and points.shape == (26, 3)
    # Known: corners move to 5/9, edge points lie at 3/4, face points at the centres.
    np.testing.assert_allclose(points[:8], corners * 5 / 9)
    np.testing.assert_allclose(np.sort(np.abs(points[8:20]), axis=1), [[0, 0.75, 0.75]] * 12)
    np.testing.assert_allclose(np.sort(np.abs(points[20:]), axis=1), [[0, 0, 1]] * 6)


def test_an_open_boundary_is_a_cubic_spline():
    x, y = np.meshgrid(np.arange(3.0), np.arange(3.0))
    points = np.column_stack([x.ravel(), y.ravel(), 0 * x.ravel()])
    points[1, 1] = 0.8  # bend the lower edge
    quads = np.array([[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]])
    refine, _ = subdivide.catmull_clark(quads, 9)
    np.testing.assert_allclose((refine @ points)[1], [1.0, 0.6, 0.0])
    np.testing.assert_allclose(refine.sum(axis=1), 1)


def test_the_chart_neither_flips_nor_overlaps(head):
    area = chart.signed_areas(head.chart_uv, head.chart_triangles)
    assert (area > 0).all()
    assert head.chart_uv.min() > 0.01 and head.chart_uv.max() < 0.99
    # Triangles that overlapped would cover fewer texels than their areas add up to.
    covered = texels.rasterise(head.chart_uv, head.chart_triangles, 1024).inside.mean()
    assert covered == pytest.approx(area.sum(), rel=1e-3)


def test_the_chart_is_one_island_with_even_scale(head):
    used = np.unique(head.chart_triangles)
    assert len(used) == len(head.chart_uv)
    assert [len(loop) for loop in chart.boundary_loops(head.chart_triangles)] == [488, 152, 112, 112]
    corner = head.template[head.part_chart]
    world = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1)
    scale = np.sqrt(world / (2 * chart.signed_areas(head.chart_uv, head.chart_triangles)))
    assert np.percentile(scale, 99) / np.percentile(scale, 1) < 2.5


def test_a_wide_chart_holds_head_neck_and_shoulders_in_two_islands(head):
    wide = cache.load_head(True)
    area = chart.signed_areas(wide.chart_uv, wide.chart_triangles)
    assert (area > 0).all()
    assert wide.chart_uv.min() > 0.01 and wide.chart_uv.max() < 0.99
    covered = texels.rasterise(wide.chart_uv, wide.chart_triangles, 1024).inside.mean()
    assert covered == pytest.approx(area.sum(), rel=1e-3) and covered > 0.5
    np.testing.assert_array_equal(wide.template, head.template)
    np.testing.assert_array_equal(wide.chart_vertices[wide.chart_triangles], wide.part_chart)
    assert len(wide.part_rest) == 0 and len(wide.part_chart) == len(head.part_chart) + len(head.part_rest)
    # Two islands: a rim of either, two eyes and the mouth. Of the surface one rim is left, the cut through the shoulders.
    assert len(chart.boundary_loops(wide.chart_triangles)) == 5
    assert wide.template[wide.chart_vertices][wide.rim_mm < 0.1][:, 1].max() < -150
    corner = wide.template[wide.part_chart]
    world = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1)
    scale = np.sqrt(world / (2 * area))
    assert np.percentile(scale, 99) / np.percentile(scale, 1) < 2.5


def test_texels_know_their_own_centres(head):
    grid = texels.rasterise(head.chart_uv, head.chart_triangles, 256)
    row, column = np.nonzero(grid.inside)
    centre = np.column_stack([(column + 0.5) / 256, 1 - (row + 0.5) / 256])
    np.testing.assert_allclose(grid.sample(head.chart_uv), centre, atol=1e-5)
    near = grid.around(centre[1000], 2.0)
    assert 1000 in near and np.abs(centre[near] - centre[1000]).max() < 4 / 256


def test_angle_weighted_normals_of_a_sphere():
    polar, around = np.meshgrid(np.linspace(0.3, 2.5, 30), np.linspace(0, 5, 60), indexing="ij")
    points = np.stack([np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar)], axis=-1)
    index = np.arange(30 * 60).reshape(30, 60)
    quads = np.stack([index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]], axis=-1).reshape(-1, 4)
    normals = geometry.vertex_normals(points.reshape(-1, 3), subdivide.triangulate(quads)).reshape(points.shape)
    assert (normals * points).sum(axis=-1)[1:-1, 1:-1].min() > 0.9999


def test_cache_keeps_the_head_and_survives_a_broken_file(head, tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    made = []
    monkeypatch.setattr(cache, "make_head", lambda wide: made.append(1) or head)
    load = cache.load_head.__wrapped__
    load()
    again = load()
    assert len(made) == 1
    np.testing.assert_array_equal(again.chart_uv, head.chart_uv)
    (file,) = (tmp_path / "unshade").iterdir()
    file.write_bytes(file.read_bytes()[:1000])
    load()
    assert len(made) == 2
    assert [p.name for p in (tmp_path / "unshade").iterdir()] == [file.name]


def test_cache_does_without_a_folder_it_can_write(head, tmp_path, monkeypatch):
    (tmp_path / "unshade").write_text("a file where the folder should be")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(cache, "make_head", lambda wide: head)
    assert cache.load_head.__wrapped__() is head

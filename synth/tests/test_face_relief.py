"""Pores, furrows and wrinkles: density, averages over texels, direction, age; one face at every texture size."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter, label

from unshade.face import FaceSpec, Label, build_face
from unshade.face.cache import load_head
from unshade.face.cellular import Cells, Grain, furrows, pits
from unshade.face.pores import SPACING_MM
from unshade.face.regions import find_regions
from unshade.face.strokes import Sketch
from unshade.face.texels import rasterise
from unshade.face.wrinkles import draw_crinkle, draw_folds

TABLE = {"name": "x", "seed": 7, "fitzpatrick": "III"}


def square(side, step):
    axis = np.arange(step / 2, side, step, dtype=np.float32)
    return np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2), len(axis)


def test_pores_are_as_dense_as_published():
    places, count = square(20.0, 0.05)
    depth = pits(places, Cells(SPACING_MM, np.random.default_rng(1)), (0.12, 0.2), 0.75, 0.05).reshape(count, count)
    found = label(depth > 0.15)[1] / 4.0
    # Flament et al. 2015: tens to a hundred conspicuous pores per cm2; here 68, less those that merge.
    assert 50 < found < 75


PATTERNS = {
    "pits": lambda places, texel: pits(places, Cells(1.05, np.random.default_rng(2)), (0.12, 0.27), 0.75, texel),
    "furrows": lambda places, texel: furrows(places, Cells(0.85, np.random.default_rng(2)), 0.11, texel),
}


@pytest.mark.parametrize(("name", "likeness"), [("pits", 0.8), ("furrows", 0.65)])
def test_coarse_texels_hold_the_mean_of_fine_ones(name, likeness):
    pattern = PATTERNS[name]
    places, count = square(30.0, 0.05)
    fine = pattern(places, 0.05).reshape(count, count)
    coarse_places, coarse_count = square(30.0, 0.6)
    coarse = pattern(coarse_places, 0.6).reshape(coarse_count, coarse_count)
    mean = fine.reshape(coarse_count, 12, coarse_count, 12).mean(axis=(1, 3))
    assert abs(coarse.mean() / mean.mean() - 1) < 0.1
    assert np.corrcoef(coarse.ravel(), mean.ravel())[0, 1] > likeness


def test_pores_run_along_the_grain():
    places, count = square(20.0, 0.05)
    grain = Grain(np.broadcast_to(np.float32([0, 1]), places.shape), np.full(len(places), 1.6, np.float32))
    depth = pits(places, Cells(1.05, np.random.default_rng(3)), (0.2, 0.2), 1.0, 0.05, grain).reshape(count, count)
    along, across = (np.mean(np.diff(depth, axis=axis) ** 2) for axis in (0, 1))
    # Pits 1.6 times as long as wide have slopes in that proportion.
    assert across / along == pytest.approx(1.6**2, rel=0.15)


@pytest.fixture(scope="module")
def template():
    head = load_head()
    regions = find_regions(head.template[head.chart_vertices].astype(np.float32))
    x, y, z = regions.points.T
    return regions, Sketch(regions.points, (z > -30) & (y > -100) & (y < 85) & (np.abs(x) < 70))


def test_wrinkles_grow_with_age_where_they_belong(template):
    regions, sketch = template
    depths = {}
    for age in (0.0, 0.5, 1.0):
        spec = FaceSpec.from_table(TABLE | {"age": age})
        depths[age] = draw_folds(sketch, len(regions.points), 0.16, spec) + draw_crinkle(regions, 0.16, spec)
    x, y, z = np.abs(regions.points[:, 0]), regions.points[:, 1], regions.points[:, 2]
    places = {
        "forehead": (x < 30) & (y > 34) & (y < 66),
        "crow's feet": (x > 48) & (x < 62) & (np.abs(y) < 10),
        "under the eye": (x > 20) & (x < 40) & (y > -20) & (y < -11),
        "nasolabial": (x > 19) & (x < 31) & (y > -62) & (y < -42),
    }
    for place, where in places.items():
        where &= z > -30
        young, middle, old = (depths[age][where].std() for age in (0.0, 0.5, 1.0))
        assert old > 1.3 * middle > 1.6 * young, place
    assert 0.2 < depths[1.0].max() < 0.9 and depths[0.0].max() < 0.1


@pytest.fixture(scope="module")
def sizes():
    return {size: build_face(FaceSpec.from_table(TABLE | {"texture_size": size})) for size in (512, 2048)}


@pytest.mark.heavy
def test_the_large_maps_are_the_same_face(sizes):
    small, large = (sizes[size].maps for size in (512, 2048))
    inner = large.inside.reshape(512, 4, 512, 4).all(axis=(1, 3)) & small.inside
    for name, bound in (("diffuse_albedo", 0.02), ("specular_albedo", 0.04), ("roughness", 0.03)):
        values, fine = getattr(small, name), getattr(large, name)
        mean = fine.reshape(512, 4, 512, 4, -1).mean(axis=(1, 3))
        difference = np.abs(mean - values.reshape(512, 512, -1))[inner].mean()
        assert difference < bound * values[inner].mean(), name
    mean = large.specular_normal.reshape(512, 4, 512, 4, 3).mean(axis=(1, 3))
    mean /= np.linalg.norm(mean, axis=2, keepdims=True)
    angle = np.degrees(np.arccos(np.clip((mean * small.specular_normal).sum(axis=2)[inner], -1, 1)))
    # Detail finer than the small map's texels is in the large one alone.
    assert np.median(angle) < 1.0


@pytest.mark.heavy
def test_2048_texels_show_pores(sizes):
    maps = sizes[2048].maps
    skin = maps.labels == Label.SKIN
    blurred = np.stack([gaussian_filter(maps.specular_normal[..., k], 3.0) for k in range(3)], axis=-1)
    fine = np.degrees(np.linalg.norm(maps.specular_normal - blurred, axis=2))
    head = load_head()
    uv = head.chart_uv[np.linalg.norm(head.template[head.chart_vertices] - [0, -36, 40], axis=1) < 14]
    row, column = ((1 - uv[:, 1]) * 2048).astype(int), (uv[:, 0] * 2048).astype(int)
    nose = fine[row, column]
    # Pits a millimetre apart: some tenths of the nose lie in them, the rest is smooth.
    assert np.quantile(nose, 0.95) > 4 and np.median(fine[skin]) > 0.5


@pytest.mark.heavy
def test_relief_has_the_measured_size(sizes):
    for size, low, high in ((512, 2.7, 3.4), (2048, 3.0, 4.3)):
        face = sizes[size]
        texels = rasterise(face.chart.uv, face.chart.triangles.astype(np.int64), size)
        smooth = texels.sample(face.chart.normals)
        smooth /= np.linalg.norm(smooth, axis=1, keepdims=True)
        skin = face.maps.labels[texels.inside] == Label.SKIN
        cosine = (smooth * face.maps.specular_normal[texels.inside]).sum(axis=1)[skin]
        assert low < np.degrees(np.arccos(np.clip(cosine, -1, 1))).mean() < high

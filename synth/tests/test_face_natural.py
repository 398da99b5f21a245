"""Natural skin: the same person, as uneven as a photographed face, with strands of hair and an individual sheen."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter, map_coordinates
from scipy.spatial import cKDTree

from unshade.face import FaceError, FaceSpec, Label, build_face, statistics
from unshade.face.blotches import blood_factor, melanin_factor
from unshade.face.character import ROUGHNESS_FACTORS, SPECULAR_FACTORS, character
from unshade.face.chart import boundary_loops
from unshade.face.pigment import BLOOD, MELANOSOMES, exact_colour
from unshade.face.regions import find_regions
from unshade.face.strands import Field, Ground, Strands
from unshade.face.texels import rasterise

TABLE = {"name": "x", "seed": 7, "fitzpatrick": "III", "texture_size": 512}
SCAN = np.array([0.060, 0.054, 0.033, 0.029])
"""Log luminance of the scanned face of docs/ground-truth.md: wavelengths of 32 mm down to 2 mm, by octaves."""


@pytest.fixture(scope="module")
def faces():
    return {detail: build_face(FaceSpec.from_table(TABLE | {"detail": detail})) for detail in ("smooth", "natural")}


@pytest.fixture(scope="module")
def small():
    return build_face(FaceSpec.from_table(TABLE | {"detail": "natural", "texture_size": 128}))


def test_equal_specifications_give_equal_bytes_and_the_same_person(faces, small):
    first, again = small.maps, build_face(small.spec).maps
    assert all(getattr(first, name).tobytes() == getattr(again, name).tobytes() for name in vars(first))
    smooth, natural = faces["smooth"], faces["natural"]
    np.testing.assert_array_equal(smooth.chart.vertices, natural.chart.vertices)
    skin = (smooth.maps.labels == Label.SKIN) & (natural.maps.labels == Label.SKIN)
    means = [face.maps.diffuse_albedo[skin].mean(axis=0) for face in (smooth, natural)]
    np.testing.assert_allclose(means[0], means[1], rtol=0.15)


def test_skin_is_as_uneven_as_a_photographed_face(faces):
    curves = {}
    for detail, face in faces.items():
        maps = face.maps
        surface = statistics.Surface.of(face.chart, 512)
        skin = statistics.bare_skin(maps.diffuse_albedo, np.isin(maps.labels, [Label.SKIN, Label.NOSE]), surface)
        curves[detail] = statistics.spectrum(statistics.luminance(maps.diffuse_albedo), skin, surface)[:4]
    assert (curves["natural"] < 2 * SCAN).all() and (curves["natural"] > SCAN / 2).all()
    assert (curves["smooth"] < curves["natural"] / 1.5).all()


def test_hair_is_dark_and_has_strands(faces):
    spread = {}
    for detail, face in faces.items():
        maps = face.maps
        scalp, skin = (maps.inside & (maps.labels == label) for label in (Label.SCALP, Label.SKIN))
        spread[detail] = statistics.spread(maps.diffuse_albedo, scalp, skin)
    assert spread["natural"].contrast < spread["smooth"].contrast < -0.4
    assert spread["natural"].deviation > 0.35


def test_maps_stay_in_their_ranges(faces):
    maps = faces["natural"].maps
    assert 0 < maps.diffuse_albedo.min() and maps.diffuse_albedo.max() < 0.95
    assert maps.specular_albedo.min() >= 0 and maps.specular_albedo.max() <= 0.05
    assert 0.04 < maps.roughness[..., :2].min() and maps.roughness[..., :2].max() < 0.75
    for normal in (maps.specular_normal, maps.diffuse_normal):
        np.testing.assert_allclose(np.linalg.norm(normal, axis=-1), 1, atol=1e-5)


def test_sheen_differs_from_face_to_face(faces):
    people = [character(FaceSpec.sample(seed)) for seed in range(200)]
    for values, (low, high) in (
        ([p.specular for p in people], SPECULAR_FACTORS),
        ([p.roughness for p in people], ROUGHNESS_FACTORS),
    ):
        assert low <= min(values) < low * 1.05 and high / 1.05 < max(values) <= high
        # Even in the logarithm: the median is the geometric mean.
        assert np.log(np.median(values)) == pytest.approx(np.log(low * high) / 2, abs=0.12)
    person = character(FaceSpec.from_table(TABLE | {"detail": "natural"}))
    smooth, natural = (faces[detail].maps for detail in ("smooth", "natural"))
    nose = (smooth.labels == Label.NOSE) & (natural.labels == Label.NOSE)
    ratio = np.median(natural.specular_albedo[nose]) / np.median(smooth.specular_albedo[nose])
    assert ratio == pytest.approx(person.specular, rel=0.12)
    ratio = np.median(natural.roughness[nose], axis=0) / np.median(smooth.roughness[nose], axis=0)
    assert ratio == pytest.approx([person.roughness, person.roughness, 1], rel=0.12)


@pytest.mark.parametrize("fitzpatrick", ["I", "IV", "VI"])
def test_amounts_are_log_luminance_on_every_skin(fitzpatrick):
    spec = FaceSpec.from_table(TABLE | {"fitzpatrick": fitzpatrick})
    base = np.array([MELANOSOMES[fitzpatrick], BLOOD[fitzpatrick]])
    lum = lambda melanin, blood: float(statistics.luminance(exact_colour(np.array(melanin), np.array(blood))))
    darker = base[0] * float(melanin_factor(np.array(0.05), spec))
    assert lum(*base) - lum(darker, base[1]) == pytest.approx(0.05, rel=0.15)
    redder = base[1] * float(blood_factor(np.array(0.02), spec))
    # Under the darkest skin less of the blood is seen.
    assert lum(*base) - lum(base[0], redder) == pytest.approx(0.02, rel=0.2) or fitzpatrick == "VI"
    assert 0.003 < lum(*base) - lum(base[0], redder) < 0.025


def test_another_detail_is_refused_and_the_default_is_not_written():
    with pytest.raises(FaceError, match=r"detail in \[face\] is 'hard'; use smooth or natural"):
        FaceSpec.from_table(TABLE | {"detail": "hard"})
    assert "detail" not in FaceSpec.from_table(TABLE).to_table()
    natural = FaceSpec.from_table(TABLE | {"detail": "natural"})
    assert FaceSpec.from_table(natural.to_table()) == natural


def test_scales_change_the_sheen_and_nothing_else(small):
    scales = {"specular_scale": 0.6, "roughness_scale": 1.5}
    plain, scaled = small, build_face(FaceSpec.from_table(small.spec.to_table() | scales))
    np.testing.assert_allclose(scaled.maps.specular_albedo, 0.6 * plain.maps.specular_albedo, rtol=1e-5)
    np.testing.assert_allclose(scaled.maps.roughness[..., :2], 1.5 * plain.maps.roughness[..., :2], rtol=1e-5)
    for name in ("diffuse_albedo", "specular_normal", "labels"):
        np.testing.assert_array_equal(getattr(scaled.maps, name), getattr(plain.maps, name))
    rest = [next(part for part in face.parts if part.name == "rest") for face in (plain, scaled)]
    np.testing.assert_allclose(rest[1].specular, 0.6 * rest[0].specular, rtol=1e-5)
    np.testing.assert_allclose(rest[1].texture.specular, 0.6 * rest[0].texture.specular, rtol=1e-5)
    assert FaceSpec.from_table(scaled.spec.to_table()) == scaled.spec


def test_small_maps_are_the_average_of_large_ones(faces, small):
    """A map of 128 texels holds what four by four texels of one of 512 hold in the mean; of hair too, strand by strand."""
    large, small = faces["natural"].maps, small.maps
    inner = large.inside.reshape(128, 4, 128, 4).all(axis=(1, 3)) & small.inside
    for name, error, bias in (
        ("diffuse_albedo", 0.06, 0.01),
        ("specular_albedo", 0.06, 0.01),
        ("roughness", 0.03, 0.005),
    ):
        values = getattr(small, name).reshape(128, 128, -1)
        mean = getattr(large, name).reshape(128, 4, 128, 4, -1).mean(axis=(1, 3))
        for where, limit in ((inner, bias), (inner & (small.labels == Label.SCALP), 3 * bias)):
            level, difference = values[where].mean(), (mean - values)[where]
            assert np.abs(difference).mean() < error * level, name
            assert abs(difference.mean()) < limit * level, name
    mean = large.specular_normal.reshape(128, 4, 128, 4, 3).mean(axis=(1, 3))
    cosine = (mean / np.linalg.norm(mean, axis=2, keepdims=True) * small.specular_normal).sum(axis=2)[inner]
    # What is finer than the small map's texels is in the large one alone.
    assert np.median(np.degrees(np.arccos(np.clip(cosine, -1, 1)))) < 2.5


def test_paint_goes_on_across_the_rim_of_the_chart(faces):
    """Along the rim the chart and the rest of the head have the same albedo, gloss and hair."""
    face = faces["natural"]
    rest = next(part for part in face.parts if part.name == "rest")
    rim = boundary_loops(face.chart.triangles)[0]
    twin = cKDTree(rest.vertices).query(face.chart.vertices[rim])[1]

    def at(picture, uv):
        place = np.stack([1 - uv[:, 1], uv[:, 0]]) * len(picture) - 0.5
        # Single hairs are as wide as a texel, and the two charts sample them at different places.
        return map_coordinates(gaussian_filter(picture, 2.0), place, order=1, mode="nearest")

    maps, texture = face.maps, rest.texture
    for chart, behind, bound in (
        (np.log(maps.diffuse_albedo[..., 1]), np.log(texture.diffuse[..., 1]), 0.15),
        (np.log(maps.specular_albedo), np.log(texture.specular), 0.1),
        (np.log(maps.roughness[..., 0]), np.log(texture.roughness[..., 0]), 0.1),
    ):
        ours, theirs = at(chart, face.chart.uv[rim]), at(behind, texture.uv[twin])
        assert np.median(np.abs(ours - theirs)) < bound
        assert np.corrcoef(ours, theirs)[0, 1] > 0.9
    np.testing.assert_array_equal(rest.vertices[twin], face.chart.vertices[rim])


@pytest.fixture(scope="module")
def flat():
    """A sheet of 40 x 20 mm over the unit square, 100 texels a side."""
    uv = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=float)
    triangles = np.array([[0, 1, 2], [0, 2, 3]])
    texels = rasterise(uv, triangles, 100)
    points = texels.sample(np.column_stack([40 * uv[:, 0], 20 * uv[:, 1], 0 * uv[:, 0]]))
    sites = find_regions(np.zeros((4, 3), np.float32))
    return Field(texels, texels.nearest_inside(), points), Ground(uv[triangles], triangles, np.full(2, 400.0), sites)


def test_strands_are_as_long_and_cover_as_much_as_they_should(flat):
    field, ground = flat
    rng = np.random.default_rng(3)
    roots = field.roots(10.0, np.ones(4), ground, rng)
    assert len(roots) == 80
    roots = 50 + 0.2 * (roots - 50)  # well inside
    towards = lambda points: np.broadcast_to([0.6, 0.8, 0.0], points.shape)
    paths = field.grow(roots, np.full(80, 3.0), towards, np.zeros((80, 5)), 5)
    # Texels are 0.4 mm wide and 0.2 mm high, and rows go down.
    end = (paths[:, -1] - paths[:, 0]) * [0.4, -0.2]
    np.testing.assert_allclose(end, np.broadcast_to([1.8, 2.4], end.shape), atol=1e-5)
    layers, tone = field.draw(Strands(paths, np.full(80, 0.15), np.full(80, 0.7)), taper=0.0)
    assert layers.sum() * 0.4 * 0.2 == pytest.approx(80 * 3.0 * 0.15, rel=0.1)
    np.testing.assert_allclose(tone[layers > 0], 0.7, rtol=1e-5)

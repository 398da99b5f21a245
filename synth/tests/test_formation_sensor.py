"""The sensor against what is known of sensors: photon transfer, saturation, code values."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest
import render_toy

from unshade.errors import PictureError, SceneError
from unshade.formation import expose, needs_own_rendering
from unshade.render.scene_text import scene_text
from unshade.scene_file import CapturedMesh, Formation, parse_scene
from unshade.srgb import decoded, encoded


def flat(value, count=40000):
    return np.full((count // 200, 200, 3), value, np.float32)


def ramp(top=1.2):
    return np.repeat(np.linspace(0, top, 100_000, dtype=np.float32)[None, :, None], 3, axis=2)


@pytest.mark.parametrize("stops", [0.0, 1.0, -2.0])
def test_photon_transfer(stops):
    """Variance in electrons = signal + read noise squared, at every level and exposure."""
    full_well, read, white = 5000.0, 12.0, 2.0
    sensor = Formation(
        exposure_stops=stops, white_level=white, full_well_electrons=full_well, read_noise_electrons=read
    )
    electrons_per_radiance = full_well * 2**stops / white
    for electrons in (100.0, 400.0, 1500.0, 4000.0):
        picture = expose(flat(electrons / electrons_per_radiance), sensor, 3).astype(float) * electrons_per_radiance
        # 120 000 values: the mean to 0.1 of its scatter's percent, the variance to 0.4 percent.
        assert picture.mean() == pytest.approx(electrons, abs=5 * np.sqrt((electrons + read**2) / picture.size))
        assert picture.var() == pytest.approx(electrons + read**2, rel=0.02)


def test_read_noise_alone_is_gaussian_and_cut_off_at_black():
    sensor = Formation(white_level=1.0, full_well_electrons=1000.0, read_noise_electrons=20.0)
    dark = expose(flat(0.0), sensor, 1).astype(float) * 1000
    assert dark.min() == 0 and (dark == 0).mean() == pytest.approx(0.5, abs=0.01)
    # The mean of a Gaussian cut off at zero: sigma / sqrt(2 pi).
    assert dark.mean() == pytest.approx(20 / np.sqrt(2 * np.pi), rel=0.02)


@pytest.mark.parametrize("stops", [0.0, 1.0, -1.0])
def test_highlights_clip_at_the_white_level(stops):
    radiance, limit = ramp(4.0), 1.5 / 2**stops
    picture = expose(radiance, Formation(exposure_stops=stops, white_level=1.5), 0)
    assert picture.max() == np.float32(limit)
    np.testing.assert_allclose(picture, np.minimum(radiance, limit), rtol=1e-6)


@pytest.mark.parametrize("bits", [8, 16])
def test_linear_codes_are_evenly_spaced(bits):
    white, largest = 0.8, 2**bits - 1
    radiance = ramp()
    picture = expose(radiance, Formation(white_level=white, bits=bits, transfer="linear"), 0)
    codes = picture.astype(float) / white * largest
    assert np.abs(codes - np.rint(codes)).max() < 2e-2 and codes.max() == pytest.approx(largest)
    if bits == 8:
        assert len(np.unique(np.rint(codes))) == 256
    inside = radiance < white
    assert np.abs(picture - radiance)[inside].max() <= white * 0.501 / largest


def test_srgb_codes_are_those_of_the_standard():
    picture = np.unique(expose(ramp(), Formation(white_level=1.0, bits=8), 0))
    assert len(picture) == 256
    # IEC 61966-2-1: the linear part up to code 10, then the power law; code 128 is 21.586 %.
    published = {0: 0.0, 1: 0.000303527, 10: 0.00303527, 11: 0.00334654, 128: 0.215861, 188: 0.502886, 255: 1.0}
    for code, linear in published.items():
        assert picture[code] == pytest.approx(linear, rel=1e-5)


def test_equal_seeds_give_equal_bits_and_nothing_is_the_picture_itself():
    sensor = Formation(white_level=1.0, full_well_electrons=2000.0, read_noise_electrons=4.0, bits=16)
    radiance = ramp()
    first, again, other = (expose(radiance, sensor, seed) for seed in (1, 1, 2))
    assert first.tobytes() == again.tobytes() and (first != other).any() and first.dtype == np.float32
    assert expose(radiance, Formation(), 1) is radiance


BRACKETED = {"white_level": 1.0, "full_well_electrons": 6000.0, "read_noise_electrons": 5.0, "bits": 8}


@pytest.mark.parametrize("level", [0.002, 0.02, 0.15, 0.6, 1.5, 3.5])
def test_merged_brackets_have_the_least_variance_that_weights_can_reach(level):
    """One over the sum of the inverse variances (Gauss-Markov) of the exposures that do not clip there."""
    stops = (-2.0, 0.0, 2.0)
    picture = expose(flat(level), Formation(**BRACKETED, brackets_stops=stops), 1).astype(float)
    precision = 0.0
    for scale in np.exp2(stops):
        x = level * scale
        if x > 0.9:
            continue
        codes = decoded((encoded(np.float64(x)) * 255 + np.array([-0.5, 0.5])) / 255)
        noise = x / 6000 + (5 / 6000) ** 2 + np.diff(codes).item() ** 2 / 12
        precision += scale**2 / noise
    assert picture.var() == pytest.approx(1 / precision, rel=0.05)
    # Readings of the short exposures that are cut off at black brighten the darkest level a little.
    assert picture.mean() == pytest.approx(level, rel=2e-3 if level > 0.01 else 0.02)


def test_brackets_extend_the_range_and_the_rest_is_as_it_was():
    radiance = ramp(8.0)
    bracketed = Formation(**BRACKETED, brackets_stops=(2.0, -2.0))
    first, again = (expose(radiance, bracketed, 5) for _ in range(2))
    assert first.tobytes() == again.tobytes() and first.max() == 4.0
    low, high = (radiance < 0.1), (radiance > 0.3) & (radiance < 3.5)
    single = expose(radiance, Formation(**BRACKETED), 5)
    assert np.square(first - radiance)[low].mean() < 0.4 * np.square(single - radiance)[low].mean()
    assert np.abs(first - radiance)[high].max() < 0.3 and (single[radiance > 1.1] == 1).all()
    # The order of the exposures changes their noise alone.
    other = expose(radiance, Formation(**BRACKETED, brackets_stops=(-2.0, 2.0)), 5)
    assert np.abs(first - other)[low].max() < 0.05


def test_pictures_stay_finite():
    sensor = Formation(
        exposure_stops=16.0, white_level=1e-3, full_well_electrons=1e9, read_noise_electrons=1e6, bits=16
    )
    picture = expose(np.array([[[0, 1e-38, 3e38], [-1.0, 1.0, 65504.0]]], np.float32), sensor, 0)
    assert np.isfinite(picture).all() and (picture >= 0).all()
    for bad in (np.nan, np.inf):
        with pytest.raises(PictureError, match="NaN or infinity"):
            expose(flat(bad), Formation(), 0)


FULL = {
    "exposure_stops": 1.0, "white_level": 1.5, "full_well_electrons": 20000, "read_noise_electrons": 3, "bits": 8, "transfer": "linear",
    "motion_pixels": 2.0, "motion_direction_degrees": 30.0, "aperture_radius_mm": 2, "focus_distance_metres": 0.5,
    "lens_distortion": [-0.1, 0.02, 0.001, 0], "brackets_stops": [-2, 0.5, 2], "pose_noise_degrees": 0.05, "pose_noise_mm": 0.3,
}  # fmt: skip


def scene(**tables):
    return parse_scene(render_toy.toy_table() | tables, "toy", Path())


def test_every_key_survives_writing_and_reading(tmp_path):
    import tomllib

    mesh = {"vertex_share": 0.1, "smoothing_mm": 1.0, "bumps_mm": 0.2, "bumps_wavelength_mm": 7.0}
    full = scene(image_formation=FULL, captured_mesh=mesh)
    assert set(full.formation.to_table()) == set(FULL) and set(full.captured_mesh.to_table()) == set(mesh)
    again = parse_scene(tomllib.loads(scene_text(full)), "again", Path())
    assert again == full
    assert scene().formation == Formation() and scene().captured_mesh == CapturedMesh()
    assert "image_formation" not in scene_text(scene()) and "captured_mesh" not in scene_text(scene())


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ({"exposure": 1}, "unknown key 'exposure'.*'exposure_stops'"),
        ({"exposure_stops": 1.0}, "does nothing without white_level"),
        ({"full_well_electrons": 100}, "does nothing without white_level"),
        ({"white_level": 1, "read_noise_electrons": 2}, "does nothing without full_well_electrons"),
        ({"white_level": 1, "transfer": "srgb"}, "does nothing without bits"),
        ({"white_level": 0}, "use a number above 0"),
        ({"white_level": 1, "bits": 10}, "bits .* is 10; use 8 or 16"),
        ({"motion_pixels": 1, "motion_degrees": 1}, "keep one"),
        ({"focus_distance_metres": 1}, "does nothing without aperture_radius_mm"),
        ({"brackets_stops": [-2, 2], "white_level": 1}, "brackets_stops .* does nothing without bits"),
        ({"brackets_stops": [0, 0], "white_level": 1, "bits": 8}, r"use 2 to 9 different numbers, as \[-2, 0, 2\]"),
        ({"brackets_stops": 2, "white_level": 1, "bits": 8}, "use 2 to 9 different numbers"),
        ({"lens_distortion": [0.1]}, r"use four numbers \[k1, k2, p1, p2\]"),
        ({"pose_noise_pixels": 1, "pose_noise_mm": 1}, "keep it or them"),
        ({"pose_noise_mm": -1}, "from 0 to 100"),
    ],
)
def test_contradictory_tables_are_refused(table, message):
    with pytest.raises(SceneError, match=message):
        scene(image_formation=table)


def test_only_optics_need_a_rendering_of_their_own():
    needy = {
        "motion_pixels": 1.0,
        "motion_degrees": 1.0,
        "aperture_radius_mm": 1.0,
        "lens_distortion": (0.1, 0.0, 0.0, 0.0),
    }
    for key, value in needy.items():
        assert needs_own_rendering(dataclasses.replace(Formation(), **{key: value}))
    assert not needs_own_rendering(Formation(white_level=1.0, bits=8, pose_noise_mm=1.0))

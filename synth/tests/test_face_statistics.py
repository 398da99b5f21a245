"""Spectra, pigment amounts and spreads against what is known of made pictures."""

import numpy as np
import pytest

from unshade.face import Chart, statistics
from unshade.face.pigment import BLOOD, MELANOSOMES, skin_colour

SIZE = 128


def plane(width_mm, height_mm):
    """A flat chart of this size in space, over the whole unit square."""
    u, v = (a.ravel() for a in np.meshgrid(np.linspace(0, 1, 9), np.linspace(0, 1, 9)))
    corner = (np.arange(8)[:, None] * 9 + np.arange(8)).ravel()
    triangles = np.concatenate(
        [np.stack([corner, corner + 1, corner + 10], 1), np.stack([corner, corner + 10, corner + 9], 1)]
    )
    vertices = np.stack([1e-3 * width_mm * (u - 0.5), 1e-3 * height_mm * (v - 0.5), 0 * u + 0.05], 1)
    normals = np.broadcast_to(np.float32([0, 0, 1]), vertices.shape)
    return Chart(
        vertices.astype(np.float32),
        normals.copy(),
        np.stack([u, v], 1).astype(np.float32),
        triangles.astype(np.uint32),
    )


@pytest.mark.parametrize(("width", "height"), [(64.0, 64.0), (96.0, 48.0)])
@pytest.mark.parametrize("direction", [0.0, 35.0, 90.0])
def test_a_wave_lies_in_its_octave_whatever_the_texels_are(width, height, direction):
    surface = statistics.Surface.of(plane(width, height), SIZE)
    x, y = 1e3 * surface.points[..., 0], 1e3 * surface.points[..., 1]
    angle = np.radians(direction)
    values = 0.1 * np.sin(2 * np.pi * (np.cos(angle) * x + np.sin(angle) * y) / 5.6)
    found = statistics.spectrum(values, np.ones((SIZE, SIZE), bool), surface)
    assert found[2] == pytest.approx(0.1 / np.sqrt(2), rel=0.08)
    assert max(found[0], found[1], found[3]) < 0.015


def test_texels_outside_the_region_are_not_measured():
    surface = statistics.Surface.of(plane(64.0, 64.0), SIZE)
    noise = np.random.default_rng(1).normal(0, 0.1, (SIZE, SIZE))
    region = np.ones((SIZE, SIZE), bool)
    region[60:70, 40:60] = False
    spoiled = np.where(region, noise, 50.0)
    clean, marred = (statistics.spectrum(v, region, surface) for v in (noise, spoiled))
    np.testing.assert_array_equal(clean, marred)
    # White noise: the variance in an octave is its share of the square of frequencies up to 1 / mm.
    fraction = np.pi * (3 * statistics.BANDS[3] ** 2) * 0.5**2
    assert clean[3] == pytest.approx(0.1 * np.sqrt(fraction), rel=0.15)
    assert np.isnan(statistics.spectrum(noise, np.zeros_like(region), surface)).all()


def test_a_tilted_wave_is_measured_in_degrees():
    surface = statistics.Surface.of(plane(64.0, 64.0), SIZE)
    slope = np.radians(3) * np.sin(2 * np.pi * 1e3 * surface.points[..., 1] / 5.6)
    normal = np.stack([0 * slope, slope, np.sqrt(1 - slope**2)], axis=-1)
    found = statistics.slope_spectrum(normal, np.ones((SIZE, SIZE), bool), surface)
    assert found[2] == pytest.approx(3 / np.sqrt(2), rel=0.08)


def test_melanin_and_blood_are_separated():
    melanin, blood = MELANOSOMES["III"], BLOOD["III"]
    base, darker, redder = (
        skin_colour(np.array([melanin * m]), np.array([blood * b])) for m, b in ((1, 1), (1.3, 1), (1, 1.3))
    )
    amounts = [np.array(statistics.pigment_amounts(c))[:, 0] for c in (base, darker, redder)]
    lost = [float((statistics.luminance(base) - statistics.luminance(c))[0]) for c in (darker, redder)]
    assert amounts[1] - amounts[0] == pytest.approx([lost[0], 0], abs=0.15 * lost[0])
    assert amounts[2] - amounts[0] == pytest.approx([0, lost[1]], abs=0.15 * lost[1])
    # Shade is neither.
    assert np.array(statistics.pigment_amounts(0.5 * base))[:, 0] == pytest.approx(amounts[0], abs=1e-5)


def test_flat_labels_have_the_psnr_of_their_spread():
    rng = np.random.default_rng(2)
    labels = np.repeat([[1, 2]], 64, axis=0).repeat(32, axis=1)
    codes = np.where(labels == 1, 0.6, 0.3)[..., None] + rng.normal(0, 0.02, (64, 64, 3))
    albedo = ((codes + 0.055) / 1.055) ** 2.4
    found = statistics.label_mean_psnr(albedo, labels, np.ones((64, 64), bool))
    assert found == pytest.approx(-20 * np.log10(0.02), abs=0.2)

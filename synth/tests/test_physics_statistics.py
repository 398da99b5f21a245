"""The z-tests on pictures of pure noise: their false alarms and power are those they state."""

import numpy as np
import pytest

from unshade.render.layers import Layers
from unshade.render.physics import statistics
from unshade.render.physics.statistics import Comparison, Estimate

SHAPE, PASSES = (48, 48), 13
SEEN = np.hypot(*(np.indices(SHAPE) - 23.5)) < 22


def noisy(rng, expected, noise=0.05):
    """A picture's mean and variance as ``PASSES`` passes tell them."""
    return Estimate.of_runs(
        [np.repeat((expected + noise * rng.standard_normal(SHAPE))[..., None], 3, 2) for _ in range(PASSES)]
    )


def compare(rng, bias, noise=0.05):
    expected = 0.5 + 0.3 * np.indices(SHAPE)[0] / SHAPE[0]
    return Comparison(noisy(rng, expected * (1 + bias), noise), noisy(rng, expected, noise), SEEN)


def test_no_alarm_without_bias():
    """A thousandth for each of three: 1.2 alarms are expected; 8 would come once in 5000."""
    rng = np.random.default_rng(1)
    assert sum(len(compare(rng, 0.0).rejections()) for _ in range(400)) < 8


@pytest.mark.parametrize("bias", [0.002, 0.003])
def test_the_pooled_power_is_the_one_stated(bias):
    rng = np.random.default_rng(2)
    comparisons = [compare(rng, bias) for _ in range(150)]
    found = np.mean([any("pooled" in fault for fault in c.rejections()) for c in comparisons])
    stated = np.mean([c.pooled_power(bias) for c in comparisons])
    assert 0.2 < stated < 0.99
    assert found == pytest.approx(stated, abs=4 * np.sqrt(0.25 / 150))
    assert all(abs(c.bias - bias) < 0.005 for c in comparisons)


def test_the_power_for_one_region_is_the_one_stated():
    """For the noisiest region: here the darkest, a block of the first row."""
    rng = np.random.default_rng(3)
    bias = np.zeros(SHAPE)
    bias[8:16, 8:16] = 0.03
    comparisons = [compare(rng, bias, 0.14) for _ in range(120)]
    found = np.mean([any("regional" in fault for fault in c.rejections()) for c in comparisons])
    # The biased block is whole, so somewhat better off than the noisiest one of the rim.
    worst = np.mean([c.regional_power(0.03) for c in comparisons])
    whole = np.abs(np.mean([c.regional for c in comparisons], 0)).max()
    expected = statistics._power(whole, statistics._threshold(len(comparisons[0].regional)))
    assert worst < expected < 0.99
    assert found == pytest.approx(expected, abs=4 * np.sqrt(0.25 / 120))


def test_the_stated_bias_of_a_pixel_is_found_half_the_time():
    rng = np.random.default_rng(4)
    bias = np.zeros(SHAPE)
    bias[24, 24] = compare(rng, 0.0).pixel_bias()
    found = np.mean(
        [any("pixel in row 24, column 24" in fault for fault in compare(rng, bias).rejections()) for _ in range(120)]
    )
    assert found == pytest.approx(0.5, abs=0.2)


def test_per_pixel_p_values_are_even():
    """Each with few passes: a normal distribution would call 2.5 times too many extreme."""
    rng = np.random.default_rng(5)
    p = np.concatenate([compare(rng, 0.0).per_pixel for _ in range(100)])
    assert np.mean(p < 0.001) == pytest.approx(0.001, rel=0.3)


def test_grey_noise_has_the_variance_of_its_channels():
    """Fully correlated channels: the bound on luminance is then exact."""
    layers = Layers(np.ones((2, 2, 3)), np.zeros((2, 2, 3)), np.full((2, 2, 3), 0.04))
    np.testing.assert_allclose(Estimate.of_layers(layers, 4).variance, 0.04)

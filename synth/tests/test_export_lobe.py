"""One lobe in place of two."""

import numpy as np
import pytest
from scipy.integrate import quad

from unshade.exporting import lobe


def ggx(theta, alpha):
    """D of GGX at a half vector's angle."""
    cosine2, a2 = np.cos(theta) ** 2, alpha * alpha
    return a2 / (np.pi * (cosine2 * (a2 - 1) + 1) ** 2)


def misplaced(alpha, first, second, weight):
    """Half the integral of the difference, by another quadrature."""

    def difference(theta):
        two = weight * ggx(theta, first) + (1 - weight) * ggx(theta, second)
        return abs(two - ggx(theta, alpha)) * np.pi * np.sin(2 * theta)

    return quad(difference, 0, np.pi / 2, limit=400, epsabs=1e-7)[0] / 2


def fitted(first, second, weight):
    single = lobe.fit(np.float32([[[first, second, weight]]]))
    return float(single.alpha[0, 0]), float(single.misplaced[0, 0])


@pytest.mark.parametrize("alpha", [0.03, 0.2, 0.7])
def test_two_equal_lobes_are_one(alpha):
    found, error = fitted(alpha, alpha, 0.3)
    assert found == pytest.approx(alpha, rel=0.01)
    assert error == pytest.approx(0, abs=1e-6)


@pytest.mark.parametrize("lobes", [(0.15, 0.35, 0.5), (0.1, 0.4, 0.8), (0.3, 0.2, 0.25)])
def test_no_other_alpha_moves_less_energy(lobes):
    found, error = fitted(*lobes)
    assert min(lobes[:2]) < found < max(lobes[:2])
    assert error == pytest.approx(misplaced(found, *lobes), abs=2e-3)
    others = [misplaced(alpha, *lobes) for alpha in np.linspace(*sorted(lobes[:2]), 40)]
    assert error < min(others) + 2e-3


def test_a_share_of_one_is_the_first_lobe():
    assert fitted(0.2, 0.5, 1.0)[0] == pytest.approx(0.2, rel=0.01)
    assert fitted(0.2, 0.5, 0.0)[0] == pytest.approx(0.5, rel=0.01)


def test_every_texel_has_its_own():
    random = np.random.default_rng(3)
    roughness = random.uniform([0.1, 0.3, 0.2], [0.2, 0.5, 0.8], (8, 8, 3)).astype(np.float32)
    single = lobe.fit(roughness)
    assert single.alpha.shape == single.misplaced.shape == (8, 8)
    for row, column in ((0, 0), (3, 5)):
        assert single.alpha[row, column] == pytest.approx(fitted(*roughness[row, column])[0])

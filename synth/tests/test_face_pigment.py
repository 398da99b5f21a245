"""The pigment model against measured skin: its scattering, and colours of real faces and arms."""

import numpy as np
import pytest
from scipy.optimize import least_squares

from unshade.face import pigment
from unshade.face.ita import cielab

VISIBLE = np.linspace(450.0, 700.0, 26)


def test_scattering_is_the_single_power_law_of_the_same_review():
    # Jacques 2013, table 2 fits the same samples of skin with one power: 46.0 (w / 500)^-1.421. The two fits part in the violet.
    single = 46.0 * (VISIBLE / 500) ** -1.421
    np.testing.assert_allclose(pigment.reduced_scattering(VISIBLE), single, rtol=0.15)


def test_scattering_lies_between_dermis_and_epidermis():
    def two_term(at_500, rayleigh, power):
        return at_500 * (rayleigh * (VISIBLE / 500) ** -4.0 + (1 - rayleigh) * (VISIBLE / 500) ** -power)

    # Rows of Jacques 2013, table 1, for Salomatina et al. 2006.
    skin = pigment.reduced_scattering(VISIBLE)
    assert (two_term(43.6, 0.41, 0.562) < skin).all() and (skin < two_term(66.7, 0.29, 0.689)).all()


# Mean L*, a*, b* under D65 of groups of people. Xiao et al. 2017 (Skin Research and Technology 23), foreheads and
# cheeks; Alaluf et al. 2002 (Pigment Cell Research 15), upper arm unexposed and forearm exposed.
MEASURED = {
    "Caucasian forehead": (59.2, 11.6, 15.1),
    "Caucasian cheek": (59.6, 11.8, 14.6),
    "Chinese forehead": (56.4, 11.7, 16.3),
    "Chinese cheek": (58.9, 11.4, 14.2),
    "Thai cheek": (60.7, 10.5, 17.2),
    "European arm": (65.0, 7.1, 13.3),
    "Chinese arm": (62.1, 8.4, 16.3),
    "Indian arm": (53.7, 10.3, 17.9),
    "African arm": (49.2, 10.2, 18.4),
    "Indian forearm": (43.7, 12.9, 17.2),
    "African forearm": (38.1, 12.7, 15.0),
}


@pytest.mark.parametrize("group", MEASURED)
def test_two_pigments_make_measured_skin(group):
    measured = np.array(MEASURED[group])
    fit = least_squares(lambda logs: cielab(pigment.exact_colour(*np.exp(logs))) - measured, np.log([0.06, 0.01]))
    # Two free numbers for three measured ones: a colour difference of 2 to 3 is just seen side by side.
    assert np.linalg.norm(fit.fun) < 2.5
    melanin, blood = np.exp(fit.x)
    # Jacques 1998: melanosomes of adults 1.3 to 43 %; blood of skin some tenths to some percent.
    assert 0.013 < melanin < 0.43 and 0.002 < blood < 0.03


def test_base_tones_are_as_red_and_yellow_as_measured_faces():
    for skin, melanin in pigment.MELANOSOMES.items():
        _, a, b = cielab(pigment.exact_colour(melanin, pigment.BLOOD[skin]))
        assert 7 < a < 13 and 9 < b < 19


def test_lips_are_redder_than_the_same_pigments_in_skin():
    blood = np.array([0.03, 0.04, 0.06])
    lip, skin = (cielab(pigment.exact_colour(0.04, blood, tissue)) for tissue in (pigment.LIP, pigment.SKIN))
    assert (lip[:, 1] > skin[:, 1] + 3).all()
    # As measured on lips: a* of 15 to 25.
    assert (15 < lip[:, 1]).all() and (lip[:, 1] < 25).all()
    table = pigment.skin_colour(np.full(3, 0.04), blood, pigment.LIP)
    np.testing.assert_allclose(table, pigment.exact_colour(0.04, blood, pigment.LIP), atol=1e-3)

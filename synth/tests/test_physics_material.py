"""The checks of the material pass, and each fails on the fault it is there for."""

import drjit as dr
import pytest

from unshade.render.physics.formula import check_formula
from unshade.render.physics.furnace import check_furnace
from unshade.render.physics.material import NORMALS
from unshade.render.physics.reciprocity import check_reciprocity
from unshade.render.physics.sampling import all_cases, check_sampling

CASES = [
    ("mesh", None, "all", 30), ("tilted diffuse", None, "diffuse", 60), ("tilted specular", None, "all", 80),
    ("both tilted", "dry", "all", 60), ("mesh", "wet", "specular", 60), ("tilted specular", "oily", "specular", 60),
]  # fmt: skip


class Faulty:
    """A material with a fault in one of its answers."""

    def __init__(self, bsdf, gain=1.0, density=lambda si, wo: 1, value=lambda si, wo: 1):
        self.bsdf, self.gain, self.density, self.value = bsdf, gain, density, value

    def eval(self, ctx, si, wo):
        return self.bsdf.eval(ctx, si, wo) * self.gain * self.value(si, wo)

    def pdf(self, ctx, si, wo):
        return self.bsdf.pdf(ctx, si, wo) * self.density(si, wo)

    def sample(self, ctx, si, sample1, sample2):
        bs, weight = self.bsdf.sample(ctx, si, sample1, sample2)
        return bs, weight * self.gain


def faulty(**fault):
    return lambda bsdf: Faulty(bsdf, **fault)


def test_samples_follow_the_density():
    """An even part of the grid; `unshade doctor --physics` runs all of it."""
    verdict = check_sampling(all_cases()[::7])
    assert verdict.ok, verdict.found


@pytest.mark.parametrize(
    "density",
    [lambda si, wo: 1.05, lambda si, wo: 0.95, lambda si, wo: 4 * dr.dot(dr.normalize(si.wi + wo), wo)],
    ids=["5 % more", "5 % less", "no Jacobian of the reflection"],
)
def test_a_wrong_density_is_found_in_every_case(density):
    for case in CASES:
        assert not check_sampling([case], alter=faulty(density=density)).ok, case


def test_a_density_that_is_wrong_by_one_percent_is_found_by_its_integral():
    verdict = check_sampling([CASES[0]], alter=faulty(density=lambda si, wo: 1.01))
    assert not verdict.ok and "integrates to" in verdict.found


def test_a_sample_below_the_specular_horizon_must_not_count():
    """The fault that the first draft of such a material has: samples that the density of the
    other part happens to cover."""

    class Leaky(Faulty):
        def sample(self, ctx, si, sample1, sample2):
            bs, weight = self.bsdf.sample(ctx, si, sample1, sample2)
            return bs, dr.select(bs.pdf > 0, 1, weight)

    assert not check_sampling([("tilted specular", None, "all", 80)], alter=Leaky).ok


def test_all_normals_lobes_angles_and_roughnesses_are_in_the_grid():
    columns = [set(column) for column in zip(*all_cases())]
    assert columns[0] == set(NORMALS) and columns[2] == {"all", "diffuse", "specular"}
    assert len(columns[1]) == 5 and columns[3] == {1, 30, 60, 80, 88}


def test_values_are_those_of_the_stated_model():
    verdict = check_formula(500)
    assert verdict.ok, verdict.found
    assert not check_formula(500, alter=faulty(gain=1.01)).ok


def test_light_takes_the_same_way_back():
    verdict = check_reciprocity(500)
    assert verdict.ok, verdict.found
    # A Fresnel term of the view's angle in place of the half vector's is such a fault.
    assert not check_reciprocity(500, alter=faulty(value=lambda si, wo: 1 + 0.01 * si.wi.z)).ok


def test_the_furnace_finds_one_percent_of_energy():
    """In the material's samples, and in the renderer."""
    from unshade.render.layers import Layers
    from unshade.render.passes import render_layers

    def shining(*scene, **settings):
        layers = render_layers(*scene, **settings)
        return Layers(1.01 * layers.diffuse, 1.01 * layers.specular, layers.variance)

    settings = {"samples": 1 << 16, "normals": ["mesh", "tilted specular"]}
    verdict = check_furnace(**settings)
    assert verdict.ok, verdict.found
    for fault in ({"alter": faulty(gain=1.01)}, {"render": shining}):
        assert not check_furnace(**settings, **fault).ok

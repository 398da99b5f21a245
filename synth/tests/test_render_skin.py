"""The skin material: what its maps mean. (`test_physics_material` has what any material must
obey: sampling that matches its density, no energy made, the same light both ways.)"""

import drjit as dr
import mitsuba as mi
import numpy as np
import pytest
import render_toy

from unshade.render.physics import material
from unshade.render.physics.material import PARTS, bitmap, constant, context, interaction, vectors


def skin(diffuse=0.5, specular=0.04, roughness=None, **others):
    """``roughness``: a constant, or a picture [H, W, 3]."""
    others |= (
        {}
        if roughness is None
        else {"roughness": constant(roughness) if np.ndim(roughness) == 1 else bitmap(roughness)}
    )
    return mi.load_dict(
        {"type": "skin", "diffuse": constant([diffuse] * 3), "specular": constant([specular]), **others}
    )


def direction(theta_degrees, phi_degrees):
    return vectors(material.direction(theta_degrees, phi_degrees))


def reflected(bsdf, ctx, wi, count=1 << 18):
    """Share of the light from direction wi that is reflected, estimated by sampling."""
    sampler = mi.load_dict({"type": "independent"})
    sampler.seed(1, count)
    _, weight = bsdf.sample(ctx, interaction(wi, count), sampler.next_1d(), sampler.next_2d())
    return float(dr.mean(weight.x)[0])


@pytest.mark.parametrize("theta", [1, 45, 70])
def test_skin_reflects_less_than_it_gets(theta):
    assert reflected(skin(diffuse=0.7, specular=0.05), context("all"), direction(theta, 0)) < 1


def test_the_lambert_term_reflects_its_albedo():
    assert reflected(skin(diffuse=0.7), context("diffuse"), direction(50, 0)) == pytest.approx(0.7, abs=2e-3)


def test_specular_albedo_reads_as_reflectance_at_normal_incidence():
    """Rough lobes lose a tenth of it to masking and to the horizon."""
    for rho_s in (0.02, 0.05):
        albedo = reflected(skin(specular=rho_s), context("specular"), direction(1, 0))
        assert 0.88 < albedo / rho_s < 0.95


def test_furnace_on_a_head():
    """In even white light a near-white head is nearly white; lobes that add without
    coupling exceed it at grazing angles only."""
    from unshade.camera.camera import Camera, look_at
    from unshade.render.lights import Dome
    from unshade.render.passes import render_layers
    from unshade.render.scene import ChartMaps, HeadScene

    face = render_toy.toy_face()
    white = ChartMaps(np.full((2, 2, 3), 0.8, np.float32), np.full((2, 2), 0.05, np.float32))
    head = HeadScene(face.chart, [], white)
    camera = Camera("000", 48, 48, 96.0, look_at(np.array([0, 0, 0.5]), np.zeros(3)), True)
    layers = render_layers(head.lit(Dome()), camera.sensor(64), samples=64, depth=8, seed=1)
    lit = layers.total[layers.total.max(-1) > 0.5]
    assert len(lit) > 500
    assert 0.85 < lit.mean() < 1.0
    assert lit.max() < 1.1


def test_a_map_without_direction_means_the_mesh_normal():
    zero = skin(diffuse_normal=constant([0.0, 0.0, 0.0]), specular_normal=constant([0.0, 0.0, 0.0]))
    wi, wo = direction(30, 10), direction(50, 200)
    for part in PARTS:
        ctx = context(part)
        expected = skin().eval(ctx, interaction(wi, 1), wo)
        np.testing.assert_allclose(zero.eval(ctx, interaction(wi, 1), wo), expected, rtol=1e-6)


def values(bsdf, u=0.5, wo=None):
    """Value and density towards one direction."""
    wo = direction(50, 200) if wo is None else wo
    value, pdf = bsdf.eval_pdf(context("specular"), interaction(direction(30, 10), 1, u), wo)
    return float(value.x[0]), float(pdf[0])


def test_a_roughness_map_of_the_standard_values_changes_nothing():
    np.testing.assert_allclose(values(skin(roughness=[0.15, 0.35, 0.5])), values(skin()), rtol=1e-6)


def test_roughness_varies_over_the_map():
    rough = [[[0.1, 0.3, 0.8]], [[0.25, 0.5, 0.2]]]
    varied = skin(roughness=np.swapaxes(rough, 0, 1))
    for u, (texel,) in zip((0.25, 0.75), rough):
        np.testing.assert_allclose(values(varied, u), values(skin(roughness=texel)), rtol=1e-6)
    middle = np.mean(rough, 0)[0]
    np.testing.assert_allclose(values(varied, 0.5), values(skin(roughness=middle)), rtol=1e-5)


def test_the_share_is_that_of_the_first_lobe():
    """Far from the mirror direction a wide lobe is bright and a narrow one dark."""
    far = direction(50, 80)
    narrow, wide = (values(skin(roughness=[0.05, 0.5, weight]), wo=far) for weight in (1.0, 0.0))
    mixed = values(skin(roughness=[0.05, 0.5, 0.25]), wo=far)
    assert wide[0] > 20 * narrow[0]
    np.testing.assert_allclose(mixed, 0.25 * np.array(narrow) + 0.75 * np.array(wide), rtol=1e-5)


def test_roughness_out_of_range_is_held_in_it():
    from unshade.render.skin_bsdf import MIN_ALPHA

    mirror = direction(30, 190)
    for wild, tame in (([0.0, 3.0, 0.5], [MIN_ALPHA, 1.0, 0.5]), ([0.2, 0.4, 1.7], [0.2, 0.4, 1.0])):
        got, expected = (values(skin(roughness=lobes), wo=mirror) for lobes in (wild, tame))
        assert np.isfinite(got).all()
        np.testing.assert_allclose(got, expected, rtol=1e-6)


def test_the_true_roughness_of_a_face_reaches_its_picture():
    """Smoother skin has the brighter highlight; without the map the standard lobes serve."""
    import dataclasses

    from unshade.camera.camera import Camera, look_at
    from unshade.render import lights
    from unshade.render.passes import render_layers
    from unshade.render.scene import ChartMaps, HeadScene

    face = render_toy.toy_face()
    camera = Camera("000", 40, 40, 80.0, look_at(np.array([0, 0, 0.5]), np.zeros(3)), True)

    def highlights(roughness):
        picture = None if roughness is None else np.broadcast_to(np.float32(roughness), (4, 4, 3))
        maps = dataclasses.replace(face.maps, roughness=picture, specular_normal=np.zeros((2, 2, 3), np.float32))
        head = HeadScene(face.chart, [], ChartMaps.truth(dataclasses.replace(face, paint=lambda: maps)))
        return render_layers(
            head.lit(lights.studio().scaled(8.0)), camera.sensor(64), samples=64, depth=2, seed=1
        ).specular

    standard = highlights(None)
    np.testing.assert_allclose(highlights([0.15, 0.35, 0.5]), standard, rtol=1e-3, atol=1e-6)
    assert highlights([0.08, 0.15, 0.5]).max() > 1.3 * standard.max()

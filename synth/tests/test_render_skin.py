"""The skin material against what any material must obey: sampling that matches its
density, no more light out than in, the same light both ways."""

import numpy as np
import pytest
import render_toy  # isort: skip  (sets the variant, before drjit is imported)
import drjit as dr
import mitsuba as mi
from mitsuba.chi2 import ChiSquareTest, SphericalDomain

TILTS = {
    "flat": ((0.0, 0.0, 1.0), (0.0, 0.0, 1.0)),
    "tilted": ((0.1, -0.1, 1.0), (0.3, 0.2, 1.0)),
    "far": ((0.0, 0.2, 1.0), (-0.5, 0.4, 1.0)),
}
PARTS = {"all": None, "diffuse": +mi.BSDFFlags.DiffuseReflection, "specular": +mi.BSDFFlags.GlossyReflection}


def constant(values):
    picture = np.broadcast_to(np.float32(values), (2, 2, np.size(values)))
    return {"type": "bitmap", "bitmap": mi.Bitmap(np.array(picture)), "raw": True}


def skin(tilt="flat", diffuse=0.5, specular=0.04):
    n_d, n_s = (np.array(n) / np.linalg.norm(n) for n in TILTS[tilt])
    return mi.load_dict(
        {
            "type": "skin",
            "diffuse": constant([diffuse] * 3),
            "specular": constant([specular]),
            "diffuse_normal": constant(n_d),
            "specular_normal": constant(n_s),
        }
    )


def context(part):
    ctx = mi.BSDFContext()
    if PARTS[part] is not None:
        ctx.type_mask = PARTS[part]
    return ctx


def direction(theta_degrees, phi_degrees):
    theta, phi = np.radians([theta_degrees, phi_degrees])
    level = np.sin(theta)
    return mi.Vector3f(*map(float, (level * np.cos(phi), level * np.sin(phi), np.cos(theta))))


def interaction(wi, count):
    si = dr.zeros(mi.SurfaceInteraction3f, count)
    si.wi = wi
    si.uv = mi.Point2f(0.5)
    si.n = mi.Normal3f(0, 0, 1)
    si.sh_frame = mi.Frame3f(*(mi.Vector3f(*axis) for axis in np.eye(3).tolist()))
    return si


@pytest.mark.parametrize("part", PARTS)
@pytest.mark.parametrize("theta", [1, 30, 60, 80, 88])
@pytest.mark.parametrize("tilt", TILTS)
def test_samples_follow_the_density(tilt, theta, part):
    bsdf, ctx, wi = skin(tilt), context(part), direction(theta, 40)

    def sample(u):
        bs, weight = bsdf.sample(ctx, interaction(wi, dr.width(u)), u[2], mi.Point2f(u[0], u[1]))
        return bs.wo, dr.select(dr.max(weight) > 0, mi.Float(1), mi.Float(0))

    def density(wo):
        return bsdf.pdf(ctx, interaction(wi, dr.width(wo)), wo)

    test = ChiSquareTest(SphericalDomain(), sample, density, sample_dim=3, sample_count=500_000, res=101, ires=16)
    # 45 tests at a joint significance of 1 % (Sidak).
    assert test.run(0.01, test_count=45), test.messages


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
        share = reflected(skin(specular=rho_s), context("specular"), direction(1, 0))
        assert 0.88 < share / rho_s < 0.95


def test_furnace_on_a_head():
    """In even white light a near-white head is nearly white; lobes that add without
    coupling exceed it at grazing angles only."""
    from unshade.render.lights import Dome
    from unshade.render.passes import render_layers
    from unshade.render.camera import Camera, look_at
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


def test_reciprocity_of_each_term_about_its_own_normal():
    """f cos / (n.l) is symmetric where diffuse and specular normal agree; about different
    normals each term is symmetric about its own."""
    rng = np.random.default_rng(3)
    wi, wo = map(to_vector, hemisphere(rng, 2))
    for tilt in TILTS:
        bsdf = skin(tilt)
        for part, normal in zip(("diffuse", "specular"), TILTS[tilt]):
            n = mi.Vector3f(*map(float, np.array(normal) / np.linalg.norm(normal)))
            there = one_way(bsdf, context(part), wi, wo, n)
            back = one_way(bsdf, context(part), wo, wi, n)
            # The Lambert term does not ask from where it is seen, so compare only where both ways are lit.
            both = (there > 0) & (back > 0)
            assert both.sum() > 100
            np.testing.assert_allclose(there[both], back[both], rtol=2e-4)


def hemisphere(rng, sets, count=500):
    for _ in range(sets):
        v = rng.standard_normal((count, 3))
        v[:, 2] = np.abs(v[:, 2]) + 0.05
        yield v / np.linalg.norm(v, axis=1, keepdims=True)


def to_vector(v):
    return mi.Vector3f(*(mi.Float(column.astype(np.float32)) for column in v.T))


def one_way(bsdf, ctx, wi, wo, normal):
    value = bsdf.eval(ctx, interaction(wi, dr.width(wi)), wo)
    return np.array(value.x / dr.dot(normal, wo))


def test_a_map_without_direction_means_the_mesh_normal():
    zero = mi.load_dict(
        {
            "type": "skin",
            "diffuse": constant([0.5] * 3),
            "specular": constant([0.04]),
            "diffuse_normal": constant([0.0, 0.0, 0.0]),
            "specular_normal": constant([0.0, 0.0, 0.0]),
        }
    )
    wi, wo = direction(30, 10), direction(50, 200)
    for part in PARTS:
        ctx = context(part)
        expected = skin().eval(ctx, interaction(wi, 1), wo)
        np.testing.assert_allclose(zero.eval(ctx, interaction(wi, 1), wo), expected, rtol=1e-6)

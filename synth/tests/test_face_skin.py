"""Skin colour against an independent colour library; relief against closed forms."""

import colour
import numpy as np
import pytest

from unshade.face import FaceSpec, build_face, pigment
from unshade.face.labels import Label
from unshade.face.normals import relief_normals, tangents
from unshade.face.texels import rasterise


@pytest.mark.parametrize("skin", ["I", "VI"])
def test_painted_skin_is_even(skin):
    face = build_face(FaceSpec.from_table({"name": "x", "seed": 31, "fitzpatrick": skin, "texture_size": 128}))
    luminance = face.maps.diffuse_albedo[face.maps.labels == Label.SKIN] @ [0.2126, 0.7152, 0.0722]
    # Not blotchy: regions differ by less than a quarter of the tone.
    assert luminance.std() < 0.25 * luminance.mean()


@pytest.mark.parametrize(("melanin", "blood"), [(0.01, 0.004), (0.06, 0.03), (0.25, 0.008)])
def test_spectrum_to_colour_agrees_with_a_colour_library(melanin, blood):
    spectrum = colour.SpectralDistribution(dict(zip(pigment.WAVELENGTHS, pigment.reflectance(melanin, blood))))
    xyz = colour.sd_to_XYZ(spectrum, illuminant=colour.SDS_ILLUMINANTS["D65"]) / 100
    expected = colour.XYZ_to_RGB(xyz, "sRGB", apply_cctf_encoding=False)
    # The observer here is a fit with an error of about one percent.
    np.testing.assert_allclose(pigment.exact_colour(melanin, blood), expected, atol=0.01)


def test_more_pigment_is_darker_and_blood_is_redder():
    assert (np.diff(pigment.exact_colour(np.linspace(0.01, 0.5, 20), 0.01), axis=0) < 0).all()
    pale, flushed = pigment.exact_colour(0.04, np.array([0.004, 0.02]))
    assert flushed[0] / flushed[1] > 1.15 * pale[0] / pale[1]


def test_the_table_is_the_exact_colour():
    rng = np.random.default_rng(0)
    melanin, blood = rng.uniform(0.005, 0.5, 2000), rng.uniform(0.003, 0.1, 2000)
    np.testing.assert_allclose(pigment.skin_colour(melanin, blood), pigment.exact_colour(melanin, blood), atol=1e-3)


def test_relief_normals_on_a_sheared_chart_of_a_tilted_plane():
    size = 128
    x, y = np.meshgrid(np.linspace(0, 1, 9), np.linspace(0, 1, 9))
    flat = np.column_stack([x.ravel(), y.ravel()])
    across, along, normal = np.array([0.6, 0.0, 0.8]), np.array([0.0, 1.0, 0.0]), np.array([-0.8, 0.0, 0.6])
    # Lengths and angles are not kept: P = 0.2 (u + 0.4 v) across + 0.1 v along.
    du, dv = 0.2 * across, 0.08 * across + 0.1 * along
    points = flat[:, :1] * du + flat[:, 1:] * dv
    index = np.arange(81).reshape(9, 9)
    quads = np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]], axis=-1).reshape(-1, 4)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    grid = rasterise(flat, triangles, size)
    t_u, t_v = (grid.sample(t) for t in tangents(points, flat, triangles))
    np.testing.assert_allclose(t_u, np.broadcast_to(du, t_u.shape), atol=1e-6)
    np.testing.assert_allclose(t_v, np.broadcast_to(dv, t_v.shape), atol=1e-6)
    u, v = grid.sample(flat).T.astype(float)
    a, b = 0.2 * (u + 0.4 * v), 0.1 * v
    height = 0.001 * (np.sin(100 * a) + np.cos(80 * b))
    slope_a, slope_b = 0.1 * np.cos(100 * a), -0.08 * np.sin(80 * b)
    expected = normal - slope_a[:, None] * across - slope_b[:, None] * along
    expected /= np.linalg.norm(expected, axis=1, keepdims=True)
    found = relief_normals(height, grid, grid.nearest_inside(), np.broadcast_to(normal, t_u.shape), t_u, t_v)
    inner = (np.abs(u - 0.5) < 0.49) & (np.abs(v - 0.5) < 0.49)
    assert np.degrees(np.arccos(np.clip((found * expected).sum(axis=1)[inner], -1, 1))).max() < 0.2

"""Renderer and solver hold skin to be the same: lobes, weights, reflectance at normal incidence."""

import numpy as np
import pytest

from unshade import _native
from unshade.render.physics.material import NORMALS, Skin, context, hemisphere, interaction, vectors
from unshade.render.skin_bsdf import F0


@pytest.mark.parametrize("normals", NORMALS)
def test_the_solvers_highlights_are_those_of_the_renderers_material(normals):
    count, rng = 4000, np.random.default_rng(3)
    skin = Skin(normals, specular=F0)
    views, lights = hemisphere(rng, count), hemisphere(rng, count)
    normal = skin.specular_normal
    # Closer to the horizon each has a guard of its own against the division by the cosine.
    clear = (views @ normal > 0.01) & (lights @ normal > 0)
    found = skin.bsdf().eval(context("specular"), interaction(vectors(views), count), vectors(lights)).x
    expected = _native.skin_reflected(
        np.broadcast_to(np.float32(normal), (count, 3)), np.float32(views), np.float32(lights)
    )
    assert clear.sum() > 2000
    np.testing.assert_allclose(np.array(found)[clear], expected[clear], rtol=2e-4, atol=1e-6)


def test_directions_that_do_not_belong_together_are_refused():
    one, two = np.zeros((1, 3), np.float32), np.zeros((2, 3), np.float32)
    with pytest.raises(ValueError, match="one per normal"):
        _native.skin_reflected(one, two, one)
    with pytest.raises(ValueError, match=r"views: expected \(n, 3\)"):
        _native.skin_reflected(one, np.zeros((1, 2), np.float32), one)

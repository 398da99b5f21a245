"""The truth of another material: it samples what it says, and is Mitsuba's own `principled` where maps are constant."""

import mitsuba as mi
import numpy as np
import pytest
import render_toy
from test_render_skin import PARTS, constant, context, direction, interaction

from unshade.camera.camera import Camera, look_at
from unshade.errors import SceneError
from unshade.render.lights import Dome, studio
from unshade.render.passes import render_layers
from unshade.render.physics.sampling import all_cases, check_sampling
from unshade.render.principled_skin import principled_roughness
from unshade.render.scene import ChartMaps, HeadScene, mesh_shape
from unshade.scene_file import parse_scene

LOBES = (0.1, 0.3, 0.75)
PLAIN = {"type": "principled", "base_color": {"type": "rgb", "value": 0.5}, "specular": 0.5}


def like_skin(bsdf):
    """The principled material with the maps of a `skin`."""
    maps = mi.traverse(bsdf)
    lobes = np.array(maps["roughness.data"])[:1, :1] if "roughness.data" in maps else None
    return mi.load_dict(
        {
            "type": "principled_skin",
            "principled_roughness": constant(principled_roughness(lobes)[0]),
            **{
                name: constant(np.array(maps[f"{name}.data"])[0, 0])
                for name in ("diffuse", "specular", "diffuse_normal", "specular_normal")
            },
        }
    )


def test_samples_follow_the_density():
    verdict = check_sampling(all_cases()[::9], alter=like_skin)
    assert verdict.ok, verdict.found


def test_values_are_those_of_mitsubas_own_material():
    ours = like_skin(
        mi.load_dict(
            {
                "type": "skin", "diffuse": constant([0.5] * 3), "specular": constant([0.04]), "roughness": constant(LOBES),
                "diffuse_normal": constant([0.0] * 3), "specular_normal": constant([0.0] * 3),
            }
        )
    )  # fmt: skip
    theirs = mi.load_dict(PLAIN | {"roughness": float(np.sqrt(0.15))})
    for wi, wo in (((30, 10), (50, 200)), ((80, 0), (75, 180)), ((5, 90), (10, 40))):
        si, wo = interaction(direction(*wi), 1), direction(*wo)
        whole = np.array(ours.eval(context("all"), si, wo)).ravel()
        np.testing.assert_allclose(whole, np.array(theirs.eval(mi.BSDFContext(), si, wo)).ravel(), rtol=1e-4)
        parts = sum(np.array(ours.eval(context(part), si, wo)).ravel() for part in PARTS if part != "all")
        np.testing.assert_allclose(parts, whole, rtol=1e-5)


@pytest.mark.parametrize("light", [Dome(), studio()], ids=["dome", "studio"])
def test_a_picture_is_that_of_mitsubas_material_and_path_tracer(light):
    face = render_toy.toy_face()
    flat = lambda *values: np.broadcast_to(np.float32(values), (2, 2, len(values))).copy()
    maps = ChartMaps(flat(0.5, 0.5, 0.5), flat(0.04)[..., 0], roughness=flat(*LOBES))
    camera = Camera("000", 32, 32, 64.0, look_at(np.array([0, 0, 0.5]), np.zeros(3)), True)
    head = HeadScene(face.chart, [], maps, "principled")
    layers = render_layers(head.lit(light), camera.sensor(256), samples=256, depth=4, seed=1)
    bsdf = mi.load_dict(PLAIN | {"roughness": float(np.sqrt(0.15))})
    chart = mesh_shape("chart", face.chart, bsdf, uv=face.chart.uv)
    lit = HeadScene.around(chart, []).lit(light)
    path = mi.load_dict({"type": "path", "max_depth": 4, "hide_emitters": True})
    theirs = np.array(mi.render(lit.scene, sensor=camera.sensor(1024), spp=1024, integrator=path, seed=2))[..., :3]
    face_ = layers.total.max(-1) > 0.02
    assert face_.sum() > 200
    # Mitsuba's own lets no light through where the interpolated normal faces away; ours asks the triangle.
    inner = face_ & (np.abs(layers.total - theirs).max(-1) < 0.5)
    assert inner.sum() > 0.97 * face_.sum()
    np.testing.assert_allclose(layers.total[inner].mean(0), theirs[inner].mean(0), rtol=6e-3)
    assert (layers.specular >= 0).all() and layers.specular.mean() > 0


def test_another_material_makes_another_picture_and_only_of_the_opaque_tier():
    table = render_toy.toy_table(material="principled")
    assert parse_scene(table, "scene", None).render.to_table()["material"] == "principled"
    assert "material" not in parse_scene(render_toy.toy_table(), "scene", None).render.to_table()
    for fault in ({"material": "principle"}, {"material": "principled", "tier": "diffusion"}):
        with pytest.raises(SceneError, match="principled"):
            parse_scene(render_toy.toy_table(**fault), "scene", None)

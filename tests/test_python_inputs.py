"""What the calls take beside paths: dictionaries, arrays as light, pictures, metrics of the user."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
import tomllib
from scipy.ndimage import binary_erosion

import unshade
from conftest import CASE
from unshade.errors import ConfigError, MetricError, PictureError, SceneError, StorageError

SUITE = Path(__file__).parent / "scenes" / "tiny.toml"

METRICS = '''
import numpy as np
import unshade

@unshade.metric(of=["relit", "diffuse_albedo"], direction="lower", unit="%", name="Mean deviation")
def deviation(prediction, truth, mask):
    """100 |p - g|, mean over the mask."""
    assert prediction.shape == truth.shape and mask.shape == truth.shape[:2] and mask.dtype == bool
    return 100 * np.abs(prediction - truth)[mask].mean()

@unshade.metric(of="view", direction="higher")
def undefined(prediction, truth, mask):
    return None
'''


def test_a_suite_as_a_dictionary_scores_metrics_of_the_user(
    tiny_run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The dictionary's paths are those of the current folder; only what the metric changes is made anew."""
    run = tmp_path / "run"
    shutil.copytree(tiny_run, run)
    monkeypatch.chdir(SUITE.parent)
    file = tmp_path / "mine.py"
    file.write_text(METRICS)
    suite = {**tomllib.loads(SUITE.read_text()), "metrics": [str(file)]}
    page = unshade.run(suite, run)
    timing = json.loads((run / "timing.json").read_text())["stages"]
    assert {stage["id"].split("/")[0] for stage in timing if not stage["cached"]} <= {"scores", "report"}
    scores = unshade.Scores.read(run / "scores" / CASE / "quick.json")
    (stated, _) = scores["metrics"]
    assert (stated["id"], stated["unit"], stated["definition"]) == (
        "deviation",
        "%",
        "100 |p - g|, mean over the mask.",
    )
    before = unshade.Scores.read(tiny_run / "scores" / CASE / "quick.json")
    assert scores["rows"][: len(before)] == before["rows"]
    # The same by hand, of arrays.
    truth, maps = unshade.Capture(run / "captures" / CASE).truth(), unshade.Maps.read(run / "maps" / CASE / "quick")
    (row,) = scores.select(metric="deviation", subject="diffuse_albedo", scale="none")
    mask = binary_erosion(truth.coverage > 127, np.ones((5, 5)))
    # Twice the truth's texels: linearly at the truth's texel centres is the mean of each four.
    albedo = maps.diffuse_albedo.reshape(128, 2, 128, 2, 3).mean((1, 3))
    expected = 100 * np.abs(albedo - truth.diffuse_albedo)[mask].mean()
    assert (row.value, row.n, row.region) == (pytest.approx(expected, rel=1e-6), mask.sum(), "coverage-e5")
    assert scores.value(metric="undefined") is None
    relit = scores.select(metric="deviation", subject="relit", scale="global", light="uniform")
    assert len(relit) == 1 and len(next(iter(relit)).per_frame) == 1
    text = page.read_text()
    assert "Mean deviation" in text and "100 |p - g|, mean over the mask." in text
    # From Python, the same function gives the same rows.
    monkeypatch.chdir(tmp_path)
    again = unshade.score(run / "captures" / CASE, run / "maps" / CASE / "quick", metrics=["mine.py:deviation"])
    assert again.value(metric="deviation", subject="diffuse_albedo", scale="none") == row.value


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("def deviation(): pass", "deviation is not a metric; write @unshade.metric"),
        ("x = 1", "deviation is missing"),
        ("1 / 0", "cannot be imported: ZeroDivisionError"),
        ("import unshade\n@unshade.metric(of='views', direction='lower')\ndef deviation(*_): ...", "of has 'views'; use some of view, relit"),
        ("import unshade\n@unshade.metric(of='view', direction='up')\ndef deviation(*_): ...", "direction is 'up'; use higher"),
        ("import unshade\n@unshade.metric(of='view', direction='one', id='ssim')\ndef deviation(*_): ...", "unshade has a metric of this id"),
        ("import unshade\n@unshade.metric(of='diffuse_albedo', direction='one')\ndef deviation(*_): return 'x'", "returned 'x' for diffuse_albedo"),
        ("import unshade\n@unshade.metric(of='diffuse_albedo', direction='one')\ndef deviation(*_): return 1 / 0", "mine.py:3: metric 'deviation' raised ZeroDivisionError"),
    ],
)  # fmt: skip
def test_a_wrong_metric_is_named(
    text: str, message: str, tiny_run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "mine.py").write_text(text)
    from unshade import own_metrics

    with pytest.raises(MetricError) as caught:
        (own,), _ = own_metrics.found(["mine.py:deviation"], tmp_path)
        folder = tiny_run / "captures" / CASE / "truth"
        pair = {"subject": "diffuse_albedo", "light": None, "frame": "", "factor": 1.0, "mask": folder / "coverage.png"}
        own_metrics.measured(
            own, [{**pair, "picture": folder / "diffuse_albedo.exr", "truth": folder / "diffuse_albedo.exr"}]
        )
    assert message in str(caught.value) and "\n" not in str(caught.value)


def test_a_wrong_dictionary_is_named_as_such(tiny_run: Path, tmp_path: Path) -> None:
    scene = {"format": 1, "name": "x", "face": {"name": "x", "seed": 1}, "light": "nowhere.toml"}
    complete = {**scene, "light": {"name": "x", "kind": "dome"}, "rig": {"name": "x"}}
    suite = tomllib.loads(SUITE.read_text())
    case = tiny_run / "captures" / CASE
    wrong = {
        "nowhere.toml: cannot be read": (SceneError, lambda: unshade.synth(scene, tmp_path / "out")),
        "the scene (a dict): unknown key 'lights' in the scene (a dict); did you mean 'light'": (SceneError, lambda: unshade.synth({**complete, "lights": 1}, tmp_path / "out")),
        "the scene (a dict): x is a object": (SceneError, lambda: unshade.synth({"x": object()}, tmp_path / "out")),
        "the suite (a dict): methods: is unknown": (SceneError, lambda: unshade.run({**suite, "methods": 1}, tmp_path / "out")),
        "the config (a dict): ": (ConfigError, lambda: unshade.solve(case, config={"warm_ups": {}})),
        "papre": (ConfigError, lambda: unshade.solve(case, config="papre")),
        "mine.toml": (StorageError, lambda: unshade.solve(case, config=tmp_path / "mine.toml")),
    }  # fmt: skip
    for message, (kind, call) in wrong.items():
        with pytest.raises(kind) as caught:
            call()
        assert message in str(caught.value) and "\n" not in str(caught.value) and "unshade-" not in str(caught.value)


def test_configurations_are_alike_as_name_text_file_and_dictionary(tiny_run: Path, tmp_path: Path) -> None:
    """By the loss of the first step, which a callback takes and ends the solve with."""
    case = unshade.Capture(tiny_run / "captures" / CASE)
    text = 'base = "fast"\n[regions]\ntexture_size = 32\n[light]\nsteps = 20\n[joint]\n'
    (tmp_path / "config").write_text(text)

    def first(config: object) -> tuple[int, float]:
        def progress(_stage: str, _iteration: int, total: int, loss: float) -> None:
            raise StopIteration((total, loss))

        with pytest.raises(StopIteration) as caught:
            unshade.solve(case, config=config, progress=progress)
        return caught.value.value

    given = [text, tmp_path / "config", str(tmp_path / "config"), tomllib.loads(text)]
    assert len({first(config) for config in given}) == 1


def test_an_array_lights_the_maps_with_its_own_radiance(tiny_run: Path, tmp_path: Path) -> None:
    """White from everywhere, twice as bright as the light `uniform`."""
    maps = tiny_run / "maps" / CASE / "mean_texture"
    case = unshade.Capture(tiny_run / "captures" / CASE)
    out = unshade.relight(case, maps, tmp_path / "relit", light=np.full((8, 16, 3), 2.0))
    (name,) = case.withheld
    found = unshade.read_exr(out / "none" / "light" / f"{name}.exr")
    uniform = unshade.read_exr(tiny_run / "relit" / CASE / "mean_texture" / "none" / "uniform" / f"{name}.exr")
    mask = case.mask(name) > 127
    assert found[mask].mean() == pytest.approx(2 * uniform[mask].mean(), rel=0.02)
    assert sorted(path.name for path in (out / "none").iterdir()) == ["light"]
    for wrong, message in ((np.ones((8, 8, 3)), "expected (rows, 2 rows, 3)"), (-np.ones((8, 16, 3)), "negative")):
        with pytest.raises(PictureError) as caught:
            unshade.relight(case, maps, tmp_path / "other", light=wrong)
        assert message in str(caught.value)


def test_exr_files_are_read_and_written_by_channel(tiny_run: Path, tmp_path: Path) -> None:
    random = np.random.default_rng(0)
    for array, channels in (
        (random.random((5, 7, 3), np.float32), ["R", "G", "B"]),
        (random.random((5, 7), np.float32), ["Y"]),
        (random.random((5, 7, 2)), ["left.Z", "right.Z"]),
    ):
        path = tmp_path / "a.exr"
        unshade.write_exr(path, array, None if channels[0] in "RY" else channels)
        assert unshade.exr_channels(path) == sorted(channels)
        found = unshade.read_exr(path, channels)
        assert found.dtype == np.float32
        np.testing.assert_array_equal(found, np.float32(array).reshape(5, 7, -1))
    unshade.write_exr(tmp_path / "b.exr", random.random((5, 7, 3)))
    assert unshade.read_exr(tmp_path / "b.exr").shape == (5, 7, 3)
    wrong = {
        "has no R, G and B among its channels left.Z, right.Z": lambda: unshade.read_exr(path),
        "nowhere.exr": lambda: unshade.read_exr(tmp_path / "nowhere.exr"),
        "picture: has 2 channels; name them": lambda: unshade.write_exr(path, np.zeros((2, 2, 2))),
        "are not 2 different names": lambda: unshade.write_exr(path, np.zeros((2, 2, 2)), ["a", "a"]),
        "has dtype uint8": lambda: unshade.write_exr(path, np.zeros((2, 2), np.uint8)),
        "Q": lambda: unshade.read_exr(path, ["Q"]),
    }
    for message, call in wrong.items():
        with pytest.raises(PictureError) as caught:
            call()
        assert message in str(caught.value)


def test_a_capture_has_the_pictures_of_its_withheld_views(tiny_run: Path, tmp_path: Path) -> None:
    case = unshade.Capture(tiny_run / "captures" / CASE)
    (name,) = case.withheld
    truth = unshade.read_exr(case.path / "truth" / "relit" / "studio" / f"{name}.exr")
    np.testing.assert_array_equal(case.image(name), truth)
    assert case.mask(name).shape == truth.shape[:2]
    assert case._repr_html_().count("data:image/png;base64,") == len(case.train)
    blind = tmp_path / "blind"
    shutil.copytree(case.path, blind, ignore=shutil.ignore_patterns("truth", f"{name}.exr"))
    with pytest.raises(unshade.errors.CaptureError, match="comes without its withheld pictures"):
        unshade.Capture(blind).image(name)
    with pytest.raises(KeyError, match="no training view"):
        case.image("x")

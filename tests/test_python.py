"""The Python package as its users meet it."""

from __future__ import annotations

import json
import pkgutil
import shutil
from pathlib import Path

import numpy as np
import pytest
from doc_examples import examples
from skimage.metrics import peak_signal_noise_ratio

import unshade
from conftest import CASE, QUICK

README = Path(__file__).parents[1] / "README.md"


def test_no_module_has_the_name_of_a_function() -> None:
    """Importing it would put the module in the function's place."""
    modules = {module.name for module in pkgutil.iter_modules(unshade.__path__)}
    assert modules & {*unshade.__all__} == {"errors", "metrics"}


def test_a_capture_hands_out_arrays(tiny_run: Path) -> None:
    capture = unshade.Capture(tiny_run / "captures" / CASE)
    assert len(capture.train) == 4 and len(capture.withheld) == 1
    name = capture.train[0]
    image, mask = capture.image(name), capture.mask(name)
    assert image.shape == (96, 96, 3) and image.dtype == np.float32
    assert mask.shape == (96, 96) and set(np.unique(mask)) == {0, 255}
    camera = capture.camera(capture.withheld[0])
    rotation = camera["camera_to_world"][:3, :3]
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-5)
    mesh = capture.mesh
    assert mesh["triangles"].max() < len(mesh["vertices"]) == len(mesh["uvs"])
    # A vertex in the middle of the face is seen where the camera says it is.
    front = mesh["vertices"][mesh["normals"][:, 2] > 0.99].mean(0)
    camera = capture.camera(name)
    local = np.linalg.inv(camera["camera_to_world"]) @ np.append(front, 1)
    x, y = np.array(camera["centre"]) + camera["focal"] * local[:2] / -local[2] * [1, -1]
    assert mask[int(y), int(x)] == 255


def test_maps_survive_a_round_trip(tmp_path: Path) -> None:
    albedo = np.random.default_rng(0).random((8, 8, 3), dtype=np.float32)
    unshade.Maps(diffuse_albedo=albedo, specular_albedo=albedo[..., 0]).write(tmp_path / "maps")
    back = unshade.Maps.read(tmp_path / "maps")
    np.testing.assert_array_equal(back.diffuse_albedo, albedo)
    np.testing.assert_array_equal(back.specular_albedo, albedo[..., 0])
    assert back.diffuse_normal is None


def test_metrics_agree_with_scikit_image() -> None:
    random = np.random.default_rng(1)
    truth = random.random((32, 40, 3), dtype=np.float32)
    noisy = truth + random.normal(0, 0.05, truth.shape).astype(np.float32)
    mask = np.zeros((32, 40), bool)
    mask[4:20, 6:30] = True
    expected = peak_signal_noise_ratio(truth[mask].astype(float), noisy[mask].astype(float), data_range=1)
    assert unshade.metrics.psnr_lin(noisy, truth, mask) == pytest.approx(expected, abs=1e-9)
    assert unshade.metrics.psnr_lin(0.5 * truth, truth, scale="global") > 90
    assert unshade.metrics.pearson(np.ones_like(truth[..., 0]), truth[..., 0]) is None
    assert "sRGB" in unshade.metrics.psnr_srgb.__doc__


def test_scores_are_those_of_the_command_line(tiny_run: Path) -> None:
    maps = tiny_run / "maps" / CASE / "quick"
    relit = tiny_run / "relit" / CASE / "quick"
    scores = unshade.score(tiny_run / "captures" / CASE, maps, relit=relit)
    written = json.loads((tiny_run / "scores" / CASE / "quick.json").read_text())
    assert scores["rows"] == written["rows"]


def test_callback_receives_steps_and_stops_a_solve(tiny_run: Path) -> None:
    capture = unshade.Capture(tiny_run / "captures" / CASE)
    heard = []

    def progress(stage: str, iteration: int, total: int, loss: float) -> None:
        heard.append((stage, iteration, total, loss))
        if iteration == 3:
            raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        unshade.solve(capture, config=QUICK, progress=progress)
    assert [iteration for _, iteration, _, _ in heard] == [1, 2, 3]


def test_stopped_solve_returns_its_maps_and_resumes(tiny_run: Path, tmp_path: Path) -> None:
    capture = unshade.Capture(tiny_run / "captures" / CASE)
    first: list[int] = []

    def until_70(_stage: str, iteration: int, _total: int, _loss: float) -> object:
        first.append(iteration)
        return unshade.STOP if iteration == 70 else False

    out = tmp_path / "maps"
    stopped = unshade.solve(capture, config=QUICK, out=out, progress=until_70)
    assert stopped.interrupted is not None and "at step" in stopped.interrupted
    assert unshade.Maps.read(out).interrupted == stopped.interrupted
    assert np.isfinite(stopped.diffuse_albedo).all()

    first.clear()
    maps = unshade.solve(capture, config=QUICK, out=out, progress=lambda _s, i, _t, _l: first.append(i))
    assert first[0] == 71 and maps.interrupted is None
    whole = tiny_run / "maps" / CASE / "quick"
    for name in ("diffuse_albedo.exr", "specular_normal.exr", "solve.json"):
        assert (out / name).read_bytes() == (whole / name).read_bytes()


def test_errors_have_names_and_one_line(tiny_run: Path, tmp_path: Path) -> None:
    capture = unshade.Capture(tiny_run / "captures" / CASE)
    wrong = {
        unshade.errors.CaptureError: lambda: unshade.Capture(tmp_path),
        unshade.errors.MapsError: lambda: unshade.Maps(diffuse_albedo=np.zeros((2, 3, 3), np.float32)),
        unshade.errors.ConfigError: lambda: unshade.solve(capture, config="papre"),
        unshade.errors.MetricError: lambda: unshade.metrics.psnr_lin(
            np.zeros((2, 2), np.float32), np.zeros((3, 3), np.float32)
        ),
        unshade.errors.ScoreError: lambda: unshade.score(capture.path, tmp_path),
        unshade.errors.ReportError: lambda: unshade.report(tmp_path, tmp_path / "report"),
        unshade.errors.CompareError: lambda: unshade.compare(tmp_path, tmp_path / "baseline.json"),
        unshade.errors.SceneError: lambda: unshade.run(tmp_path / "suite.toml", tmp_path / "run"),
        unshade.errors.BackendError: lambda: unshade.solve(capture, backend="abacus"),
    }
    for kind, call in wrong.items():
        with pytest.raises(kind) as caught:
            call()
        assert type(caught.value) is kind and issubclass(kind, unshade.errors.UnshadeError)
        assert "\n" not in str(caught.value) and kind.__doc__


@pytest.mark.parametrize("place", examples())
def test_the_documentations_examples_run(
    place: str, tiny_run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As they stand, but for the size: the tiny scene is rendered already, and solved fast."""

    def synth(scene: str, out: str, **_: object) -> unshade.Capture:
        # The name of a scene that comes with unshade: a path would be that of one folder.
        assert (README.parent / "scenes" / f"{scene}.toml").is_file()
        shutil.copytree(tiny_run / "captures" / CASE, out)
        return unshade.Capture(out)

    solve = unshade.solve
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(unshade, "synth", synth, raising=False)
    monkeypatch.setattr(
        unshade, "solve", lambda *given, **named: solve(*given, **{**named, "config": QUICK}), raising=False
    )
    code = examples()[place]
    exec(compile(code, place, "exec"), {"__name__": "example"})


def test_pictures_of_views_are_projected_into_the_chart(tiny_run: Path) -> None:
    capture = unshade.Capture(tiny_run / "captures" / CASE)
    flat = {name: np.full((96, 96, 3), [0.1, 0.2, 0.4]) for name in capture.train}
    texture, seen = capture.project(flat, 64)
    assert texture.shape == (64, 64, 3) and set(np.unique(seen)) == {0, 255}
    np.testing.assert_allclose(texture, np.broadcast_to(np.float32([0.1, 0.2, 0.4]), texture.shape), atol=1e-6)
    one = capture.project({capture.train[0]: flat[capture.train[0]]}, 64)[1]
    assert (one <= seen).all() and 0 < (one > 0).sum() < (seen > 0).sum()
    with pytest.raises(KeyError, match="no training view"):
        capture.project({capture.withheld[0]: flat[capture.train[0]]}, 64)
    with pytest.raises(ValueError, match=r"expected shape \(96, 96, 3\)"):
        capture.project({capture.train[0]: np.zeros((8, 8, 3))}, 64)

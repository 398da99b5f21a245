"""Captures without a truth through the whole job: solved, relit in the light that was found, scored, reported."""

from __future__ import annotations

import json
import re
from pathlib import Path

import foreign_captures
import numpy as np
import pytest

import unshade
from conftest import QUICK, TINY
from conftest import unshade as command
from unshade.errors import CaptureError, SceneError, ScoreError

SOLVERS = TINY.read_text().split("\n\n", 1)[1].split('[[method]]\nname = "oracle"')[0]
"""Our method, small, and a baseline; there is no oracle of photographs."""


def _imported(tiny_run: Path, folder: Path, **choices: object) -> Path:
    path = foreign_captures.colmap(tiny_run / "captures" / "tiny-studio", folder / "source", binary=True)
    beside = {"mesh": path / "mesh.obj", "masks": path / "masks", "labels": path / "labels", "parser": "unshade"}
    return unshade.import_capture("colmap", path, folder / "head", **beside, **choices)  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def photographed(tiny_run: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with an imported capture, a suite of it, and its finished run."""
    folder = tmp_path_factory.mktemp("photographed")
    capture = _imported(tiny_run, folder, holdout=["004"])
    (capture / "relight.toml").write_text('[[relight]]\nname = "even"\nkind = "dome"\n')
    (folder / "suite.toml").write_text(f'format = 1\nname = "heads"\ncaptures = ["head"]\n\n{SOLVERS}')
    command("run", folder / "suite.toml", "-o", folder / "run")
    return folder


def _scores(run: Path, case: str, method: str) -> unshade.Scores:
    return unshade.Scores.read(run / "scores" / case / f"{method}.json")


def test_pictures_are_held_against_withheld_photographs(photographed: Path, tiny_run: Path) -> None:
    found = _scores(photographed / "run", "head", "quick")
    # The same pictures as a rendered capture, whose truth they are: the same solve, the same rows.
    true = _scores(tiny_run, "tiny-studio", "quick")
    assert found["protocol"]["id"] == "unshade-photographs-1"
    subjects = {(row.subject, row.light) for row in found}
    assert subjects == {("view", None), ("relit", "found")}
    psnr = {"metric": "psnr_srgb", "scale": "none"}
    assert found.value(subject="view", **psnr) == pytest.approx(true.value(subject="view", **psnr), abs=0.5)
    # The found light is not the true one, but it has to explain the photographs about as well.
    relit = found.value(subject="relit", light="found", **psnr)
    assert relit is not None and relit > (true.value(subject="relit", light="studio", **psnr) or 0) - 2
    names, planes = unshade._native.read_exr(
        photographed / "run" / "relit" / "head" / "quick" / "none" / "found" / "004.exr"
    )
    assert {"R", "diffuse.R", "specular.R", "variance.R"} <= set(names) and planes.shape[:2] == (96, 96)


def test_the_found_light_has_the_photographs_exposure(photographed: Path) -> None:
    relit = unshade._native.read_colour(
        photographed / "run" / "relit" / "head" / "quick" / "none" / "found" / "004.exr"
    )
    photograph = unshade._native.read_colour(photographed / "head" / "images" / "004.exr")
    mask = unshade._native.read_gray(photographed / "head" / "masks" / "004.png") > 0
    np.testing.assert_allclose(relit[mask].mean(0) / photograph[mask].mean(0), 1, atol=0.15)


def test_a_baseline_without_a_light_is_scored_by_its_unlit_views(photographed: Path) -> None:
    run = photographed / "run"
    lights = run / "relit" / "head" / "mean_texture" / "none"
    assert [light.name for light in lights.iterdir()] == ["even"]
    found = _scores(run, "head", "mean_texture")
    assert {row.subject for row in found} == {"view"}
    # The projected texture has the photographs' shading in it, but no highlight that moves.
    assert 25 < (found.value(subject="view", metric="psnr_srgb", scale="none") or 0) < 40
    assert [path.name for path in (run / "maps" / "head" / "mean_texture" / "views").iterdir()] == ["004.exr"]


def test_the_report_shows_them_and_the_run_resumes(photographed: Path) -> None:
    page = (photographed / "run" / "report" / "index.html").read_text()
    assert "Withheld photograph, maps relit: the light that the method recovered" in page
    assert "mean projected texture recovers no light, so its maps cannot be relit" in page
    assert "view 004" in page and "Relit" in page and ">truth<" not in page
    again = command("run", photographed / "suite.toml", "-o", photographed / "run")
    assert "0 stages run" in again.stderr


def test_a_dry_run_counts_the_pixels_of_the_photographs(photographed: Path, tmp_path: Path) -> None:
    suite, run = photographed / "suite.toml", photographed / "run"
    said = command("run", suite, "-o", tmp_path / "new", "--dry-run", "--costs", run).stdout
    times = json.loads((run / "timing.json").read_text())
    expected = sum(stage["seconds"] for stage in times["stages"])
    found = re.search(r"^in all: (\d+) (s|min)", said, re.MULTILINE)
    assert found is not None and "no timings yet" not in said
    assert 0.5 * expected < int(found[1]) * {"s": 1, "min": 60}[found[2]] < 2 * expected + 10, said


def test_photographs_that_cannot_be_scored_are_one_line_errors(
    tiny_run: Path, tmp_path: Path, photographed: Path
) -> None:
    every = _imported(tiny_run, tmp_path)
    with pytest.raises(ScoreError, match="no truth and no withheld photographs.*--holdout"):
        unshade.score(every, photographed / "run" / "maps" / "head" / "quick")

    def refused(text: str, words: str) -> None:
        suite = photographed / "wrong.toml"
        suite.write_text('format = 1\nname = "heads"\n' + text)
        with pytest.raises(SceneError, match=words) as refusal:
            unshade.run(suite, tmp_path / "run")
        assert "\n" not in str(refusal.value)

    solver = '[[method]]\nname = "mean_texture"\n'
    refused('captures = ["head"]\n[[method]]\nname = "oracle"\n', "photographs have no true maps")
    refused(f'captures = ["nothing"]\n{solver}', "nothing is not a capture without a truth")
    refused(f'captures = ["{tiny_run}/captures/tiny-studio"]\n{solver}', "is not a capture without a truth")
    refused(f"captures = []\n{solver}", "must be a list of captures' folders")
    refused(f'captures = ["head", "head"]\n{solver}', "head occurs twice")
    refused(f'captures = ["head"]\n{solver}[render]\nwidth = 64\n', "render.* does not apply to captures")
    refused(solver, "scene: is missing")


def test_halves_of_the_views_are_compared(photographed: Path, tmp_path: Path) -> None:
    found = unshade.consistency(photographed / "head", config=QUICK, out=tmp_path / "halves")
    assert found["views"] == (2, 2) and 0.3 < found["common"] <= 1
    first, second = (unshade.Maps.read(tmp_path / "halves" / half) for half in ("first", "second"))
    assert (
        first.coverage is not None
        and second.coverage is not None
        and first.diffuse_albedo is not None
        and second.diffuse_albedo is not None
    )
    both = (first.coverage > 0) & (second.coverage > 0)
    expected = unshade.metrics.psnr_srgb(first.diffuse_albedo, second.diffuse_albedo, both, scale="global")
    assert found["diffuse_albedo_psnr"] == pytest.approx(expected)
    assert found["normal_mean_deg"] is not None and found["normal_mean_deg"] < 45
    two = json.loads((photographed / "head" / "transforms.json").read_text())
    (tmp_path / "few").mkdir()
    (tmp_path / "few" / "transforms.json").write_text(json.dumps(two | {"train_filenames": two["train_filenames"][:3]}))
    with pytest.raises(CaptureError, match="halves need four"):
        unshade.consistency(tmp_path / "few")

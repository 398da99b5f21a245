"""`unshade figure` on a finished run."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path

import mitsuba as mi
import numpy as np
import pytest
from PIL import Image
from scipy.ndimage import binary_erosion

import unshade as package
from conftest import unshade


def test_a_figure_of_a_run_has_its_drawings_its_numbers_and_its_latex(tiny_run: Path, tmp_path: Path) -> None:
    out = tmp_path / "figure"
    said = unshade("figure", "fig8", tiny_run, "-o", out).stdout
    assert said.strip() == str(out / "figure.png")
    assert Image.open(out / "figure.png").width == 2160
    assert (out / "figure.pdf").read_bytes().startswith(b"%PDF")
    included = re.findall(r"includegraphics\[[^]]*\]\{([^}]*)\}", (out / "figure.tex").read_text())
    assert included and all((out / name).is_file() for name in included)
    with (out / "figure.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["method"] for row in rows} == {"quick"}

    # The panel of the true albedo is that map under the sRGB curve.
    panel = np.array(Image.open(next(out.glob("panels/*-truth-diffuse_albedo.png"))))
    linear = np.array(mi.Bitmap(str(next(tiny_run.glob("captures/*/truth/diffuse_albedo.exr")))))
    seen = np.array(Image.open(next(tiny_run.glob("captures/*/truth/coverage.png")))) > 0
    np.testing.assert_allclose(panel[seen], 255 * _srgb(linear)[seen], atol=0.51)


def test_what_a_run_does_not_hold_is_bad_input(tiny_run: Path, tmp_path: Path) -> None:
    done = unshade("figure", "fig9", tiny_run, "-o", tmp_path / "figure", check=False)
    assert done.returncode == 2 and "captures of one face in two lights" in done.stderr
    assert "tiny-studio (face tiny, light studio)" in done.stderr and "quick (solver)" in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_errors_by_what_the_capture_shows_are_those_of_their_texels(tiny_run: Path, tmp_path: Path) -> None:
    out = tmp_path / "figure"
    assert package.figure("observability", tiny_run, out=out) == out / "figure.png"
    with pytest.raises(package.errors.ReportError, match="`fig7`, expected one of `fig6`, "):
        package.figure("fig7", tiny_run, out=tmp_path / "other")
    with (out / "figure.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert {"views", "obliqueness", "light"} <= {row["factor"] for row in rows}

    case = rows[0]["case"]
    truth = tiny_run / "captures" / case / "truth"
    maps = tiny_run / "maps" / case / "quick"
    exact, found = (np.array(mi.Bitmap(str(path / "diffuse_albedo.exr"))) for path in (truth, maps))
    # Half the side: between the centres of four texels.
    found = found.reshape(len(exact), 2, len(exact), 2, 3).mean((1, 3))
    scores = json.loads((tiny_run / "scores" / case / "quick.json").read_text())
    encoded = [_srgb(albedo) for albedo in (exact, found * np.float32(scores["scale"]["global"]))]
    squared = ((encoded[0] - encoded[1]) ** 2).mean(-1)
    seen, views = (np.array(Image.open(truth / name)) for name in ("coverage.png", "views.png"))
    compared = binary_erosion(seen > 127, np.ones((5, 5)))
    bins = [row for row in rows if row["factor"] == "views"]
    assert len(bins) > 1
    for row in bins:
        inside = compared & (views >= float(row["from"])) & (views < float(row["to"] or "inf"))
        assert float(row["share of texels"]) * compared.sum() == pytest.approx(inside.sum())
        assert float(row["albedo, dB"]) == pytest.approx(-10 * np.log10(squared[inside].mean()), abs=1e-3)


def _srgb(linear: np.ndarray) -> np.ndarray:
    clipped = linear.astype(np.float64).clip(0, 1)
    return np.where(clipped <= 0.0031308, 12.92 * clipped, 1.055 * clipped ** (1 / 2.4) - 0.055)

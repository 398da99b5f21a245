"""`unshade figure` on a finished run."""

from __future__ import annotations

import csv
import re
from pathlib import Path

import mitsuba as mi
import numpy as np
from PIL import Image

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
    curve = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 0) ** (1 / 2.4) - 0.055)
    seen = np.array(Image.open(next(tiny_run.glob("captures/*/truth/coverage.png")))) > 0
    np.testing.assert_allclose(panel[seen], 255 * np.clip(curve, 0, 1)[seen], atol=0.51)


def test_what_a_run_does_not_hold_is_bad_input(tiny_run: Path, tmp_path: Path) -> None:
    done = unshade("figure", "fig9", tiny_run, "-o", tmp_path / "figure", check=False)
    assert done.returncode == 2 and "captures in two lights" in done.stderr
    assert list(tmp_path.iterdir()) == []

"""Whether two renderers rank methods alike: a finished run, relit once more by Cycles.

    unshade run SUITE -o RUN
    python synth/bench/judges.py RUN -o FOLDER

relights every method's maps and the truth by Cycles (FOLDER keeps the pictures; what is there is not rendered again)
and compares each renderer's relit pictures with that renderer's own true pictures: psnr_srgb inside the eroded mask,
pooled over the withheld views. Prints both numbers in Markdown and Kendall's tau over the methods, for every case and
light, and over all.
"""

from __future__ import annotations

import argparse
import itertools
import json
from pathlib import Path

import numpy as np
import unshade
from unshade import _native
from scipy.stats import kendalltau

SCALE = "global"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=Path)
    parser.add_argument("-o", "--out", type=Path, required=True)
    options = parser.parse_args()
    rows = [row for capture in captures(options.run) for row in judged(options.run, capture, options.out)]
    print("| case | light | method | Mitsuba (dB) | Cycles (dB) |\n|---|---|---|---|---|")
    for case, light, method, ours, theirs in rows:
        print(f"| {case} | {light} | {method} | {ours:.2f} | {theirs:.2f} |")
    taus = []
    for (case, light), group in itertools.groupby(rows, lambda row: row[:2]):
        ours, theirs = zip(*(row[3:] for row in group), strict=True)
        taus.append(kendalltau(ours, theirs).statistic)
        print(f"\ntau of {case} in {light}: {taus[-1]:.2f}")
    ours, theirs = (np.array([row[column] for row in rows]) for column in (3, 4))
    print(f"\nmean tau: {np.mean(taus):.3f}; over all rows: {kendalltau(ours, theirs).statistic:.3f}")
    print(f"largest difference: {np.abs(ours - theirs).max():.2f} dB, mean {np.mean(theirs - ours):+.3f} dB")


def captures(run: Path) -> list[Path]:
    return sorted(path for path in (run / "captures").iterdir() if (path / "truth").is_dir())


def judged(run: Path, capture: Path, out: Path) -> list[tuple[str, str, str, float, float]]:
    """Case, light, method, and the PSNR by both renderers, of every method but the oracle."""
    truth = relit(capture, capture / "truth", out / capture.name / "truth")
    rows = []
    for maps in sorted((run / "maps" / capture.name).iterdir()):
        if maps.name == "oracle":
            continue
        theirs = relit(capture, maps, out / capture.name / maps.name)
        ours = run / "relit" / capture.name / maps.name / SCALE
        for light in sorted(path.name for path in ours.iterdir()):
            of_ours = psnr(capture, ours / light, capture / "truth" / "relit" / light)
            of_theirs = psnr(capture, theirs / SCALE / light, truth / "none" / light)
            rows.append((capture.name, light, maps.name, of_ours, of_theirs))
    return sorted(rows, key=lambda row: row[:2])


def relit(capture: Path, maps: Path, out: Path) -> Path:
    if not (out / "relit.json").is_file():
        unshade.relight(capture, maps, out, renderer="cycles")
    assert json.loads((out / "relit.json").read_text())["renderer"] == "cycles"
    return out


def psnr(capture: Path, pictures: Path, truth: Path) -> float:
    """Pooled: of the mean squared error over all views."""
    errors = []
    for path in sorted(truth.glob("*.exr")):
        mask = _native.read_gray(capture / "masks" / f"{path.stem}.png")
        made, true = (_native.read_exr(file, ["R", "G", "B"])[1] for file in (pictures / path.name, path))
        errors.append(10 ** (-unshade.metrics.psnr_srgb(made, true, mask, erode=True) / 10))
    return float(-10 * np.log10(np.mean(errors)))


if __name__ == "__main__":
    main()

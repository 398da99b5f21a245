"""Noise-free scores at few samples beside those at sixteen times as many: do their intervals hold them?

    python synth/bench/noise_free.py FOLDER [--samples 16] [--size 96]

Twenty cases: the tuning faces in four lights, each with the maps of one solver and of one flat baseline. The maps,
found at few samples, are relit and scored against the truth at few and, with other random numbers, at many. Prints
every relit row of the linear score, how many of the intervals at few samples hold the value at many, and what the
scores as rendered lose to noise. A quarter of an hour on two cores.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np

from unshade.scene_file.scene import read_table

SCENES = Path(__file__).parents[2] / "scenes"
LIGHTS = ("studio", "uniform", "flash", "courtyard")
METHODS = ("fast", "label-means")
PROGRAM = Path(sys.executable).with_name("unshade")
MORE = 16


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--samples", type=int, default=16)
    parser.add_argument("--size", type=int, default=96)
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    few = options.folder / "few"
    unshade("run", suite(options.folder, options.size, options.samples), "-o", few)
    held, apart, lost = [], [], []
    cases = json.loads((few / "run.json").read_text())["cases"]
    for case in cases:
        capture = at_more_samples(options.folder, few / f"{case['capture']}.toml", options.samples)
        for method in case["solvers"]:
            true = again(options.folder, capture, few / method["maps"], f"{case['id']}-{method['id']}")
            for light, row in scores(few / method["scores"], "psnr_lin_unbiased").items():
                (low, high), value = row["ci95"], true[light]["value"]
                rendered = scores(few / method["scores"], "psnr_lin")[light]["value"]
                held.append(low <= value <= high)
                apart.append(abs(row["value"] - value))
                lost.append(value - rendered)
                print(
                    f"{case['id']:16} {method['id']:12} {light:10} {rendered:6.2f} as rendered, {row['value']:6.2f} "
                    f"({low:.2f} to {high:.2f}) without noise, {value:6.2f} at {MORE} times"
                    f"{'' if held[-1] else '  MISSED'}",
                    flush=True,
                )
    print(
        f"{len(cases)} cases, {len(held)} relit rows: {sum(held)} intervals hold; apart by {np.median(apart):.2f} dB in "
        f"the median, {max(apart):.2f} at most; as rendered too low by {np.median(lost):.2f} and {max(lost):.2f}"
    )


def suite(folder: Path, size: int, samples: int) -> Path:
    """The suite of the twenty cases."""
    tuning = read_table(SCENES / "face-sets.toml")["tuning"]
    faces = json.dumps([str(SCENES / "faces" / face) for face in tuning])
    lights = json.dumps([str(SCENES / "lights" / f"{light}.toml") for light in LIGHTS])
    file = folder / "few.toml"
    file.write_text(
        f'format = 1\nname = "few"\nscene = "{SCENES / "method.toml"}"\nscales = ["none"]\nfaces = {faces}\n'
        f'lights = {lights}\n[face]\ndetail = "natural"\ntexture_size = 256\n[render]\nwidth = {size}\n'
        f"height = {size}\nsamples = {samples}\nseed = 1\n"
        + "".join(f'[[method]]\nname = "{method}"\n' for method in METHODS)
    )
    return file


def at_more_samples(folder: Path, scene: Path, samples: int) -> Path:
    """The capture of ``scene`` with more samples and other random numbers."""
    capture = folder / "many" / scene.stem
    if not capture.exists():
        was, now = (f"samples = {n}\ndepth = 6\nseed = {seed}\n" for n, seed in ((samples, 1), (MORE * samples, 2)))
        text = scene.read_text()
        assert was in text, f"{scene} has no [render] of {samples} samples"
        file = folder / f"{scene.stem}.toml"
        file.write_text(text.replace(was, now))
        unshade("synth", file, "-o", capture)
    return capture


def again(folder: Path, capture: Path, maps: Path, name: str) -> dict[str, dict[str, Any]]:
    """The noise-free scores of ``maps`` against another capture, by light."""
    relit, out = folder / "relit" / name, folder / "scores" / f"{name}.json"
    if not out.exists():
        unshade("relight", capture, maps, "-o", relit)
        out.parent.mkdir(exist_ok=True)
        unshade("score", capture, maps, "--relit", relit, "-o", out)
    return scores(out, "psnr_lin_unbiased")


def scores(file: Path, metric: str) -> dict[str, dict[str, Any]]:
    """Rows of relit pictures of maps as they are, by light."""
    rows = json.loads(file.read_text())["rows"]
    wanted = [row for row in rows if row["metric"] == metric and row["scale"] == "none" and row["subject"] == "relit"]
    return {row["light"]: row for row in wanted}


def unshade(*words: object) -> None:
    subprocess.run([str(PROGRAM), *map(str, words)], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


if __name__ == "__main__":
    main()

"""How far Cycles and Mitsuba agree on a face whose maps are known: per light, layer and region.

    unshade relight CAPTURE CAPTURE/truth --renderer cycles -o RELIT
    python synth/bench/cycles.py CAPTURE RELIT

prints a table in Markdown. ``mean``: mean of Cycles' layer over Mitsuba's, less one; and the region where it is
largest. ``apart``: root mean square difference of the two pictures less what their noise accounts for, over their
mean. Pixels: the mask, eroded once by 5x5.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np
from scipy.ndimage import binary_erosion

from unshade.files.pictures import read_exr, read_gray
from unshade.render import llvm

llvm.activate(llvm.choose())

LAYERS = ("diffuse", "specular")

MIN_PIXELS = 100
"""Pixels of a region that is looked at."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("capture", type=Path)
    parser.add_argument("relit", type=Path)
    options = parser.parse_args()
    print("| light | diffuse: mean | worst region | specular: mean | worst region | apart |\n|---|---|---|---|---|---|")
    for light in sorted(path.name for path in (options.relit / "none").iterdir()):
        print(row(options.capture, options.relit / "none", light))


def row(capture: Path, relit: Path, light: str) -> str:
    """One row of the table."""
    labels, variance, truth, other = gathered(capture, relit, light)
    names = json.loads((capture / "transforms.json").read_text())["label_names"]
    cells = []
    for layer in LAYERS:
        regions = {
            word: other[layer][labels == int(label)].mean() / truth[layer][labels == int(label)].mean() - 1
            for label, word in names.items()
            if (labels == int(label)).sum() > MIN_PIXELS
        }
        worst = max(regions, key=lambda word: abs(regions[word]))
        cells += [f"{other[layer].mean() / truth[layer].mean() - 1:+.2%}", f"{worst} {regions[worst]:+.2%}"]
    total, whole = sum(other.values()), sum(truth.values())
    excess = max(float(((total - whole) ** 2).mean() - variance.mean()), 0.0) ** 0.5 / whole.mean()
    return f"| {light} | " + " | ".join([*cells, f"{excess:.1%}"]) + " |"


def gathered(
    capture: Path, relit: Path, light: str
) -> tuple[np.ndarray, np.ndarray, dict[str, np.ndarray], dict[str, np.ndarray]]:
    """Labels, the variance of the difference, and both renderers' layers (N,3) inside the masks of all withheld views."""
    columns: list[tuple[np.ndarray, ...]] = []
    for path in sorted((relit / light).glob("*.exr")):
        mask = binary_erosion(read_gray(capture / "masks" / f"{path.stem}.png") > 0, np.ones((5, 5)))
        pictures = [read_exr(capture / "truth" / "relit" / light / path.name), read_exr(path)]

        def inside(picture: dict[str, np.ndarray], name: str, mask: np.ndarray = mask) -> np.ndarray:
            return np.stack([picture[f"{name}.{c}"] for c in "RGB"], -1)[mask]

        variance = inside(pictures[0], "variance") + inside(pictures[1], "variance")
        layers = [inside(picture, layer) for picture in pictures for layer in LAYERS]
        columns.append((read_gray(capture / "labels" / f"{path.stem}.png")[mask], variance, *layers))
    labels, variance, *layers = (np.concatenate(parts) for parts in zip(*columns, strict=True))
    return labels, variance, dict(zip(LAYERS, layers[:2], strict=True)), dict(zip(LAYERS, layers[2:], strict=True))


if __name__ == "__main__":
    main()

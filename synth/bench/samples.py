"""Whether scores without the renderer's noise hold, at a sixteenth of the samples, what all of them give.

    unshade run scenes/suites/samples.toml -o RUN
    python synth/bench/samples.py RUN

Prints, in Markdown, the linear PSNR of the same maps relit with 16 and with 256 samples, as rendered and without
noise, and in how many cases the interval of the first holds the second.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import unshade

FEW, MANY = "16", "256"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=Path)
    run = parser.parse_args().run
    print(
        f"| face, light | as rendered: {FEW} / {MANY} | without noise: {FEW} (95 %) / {MANY} | held |\n|---|---|---|---|"
    )
    held = []
    for folder in sorted((run / "scores").glob(f"*-{FEW}")):
        few, many = (unshade.Scores.read(path / "label-means.json") for path in (folder, with_many(folder)))
        for light in dict.fromkeys(row.light for row in few.select(subject="relit")):
            rendered = [one(scores, light, "psnr_lin").value for scores in (few, many)]
            without, target = (one(scores, light, "psnr_lin_unbiased") for scores in (few, many))
            low, high = without.ci95
            held.append(low <= target.value <= high)
            name = folder.name.removesuffix(f"-{FEW}").split("-")[0]
            print(
                f"| {name}, {light} | {rendered[0]:.1f} / {rendered[1]:.1f} | "
                f"{without.value:.1f} ({low:.1f} to {high:.1f}) / {target.value:.1f} | {'yes' if held[-1] else 'no'} |"
            )
    print(f"\nheld: {sum(held)} of {len(held)}")


def with_many(folder: Path) -> Path:
    return folder.with_name(folder.name.removesuffix(FEW) + MANY)


def one(scores: unshade.Scores, light: str | None, metric: str) -> unshade.Score:
    (row,) = scores.select(subject="relit", light=light, metric=metric, scale="none", region="mask-e5", label=None)
    return row


if __name__ == "__main__":
    main()

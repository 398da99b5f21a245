"""The cost of scoring beside the Python libraries that compute the same numbers.

    python synth/bench/scoring.py [--views 12] [--size 512]

Every metric of ``unshade.metrics`` of so many pictures, and its reference implementation by scikit-image,
colour-science, flip-evaluator and SciPy (`harness/scoring/tests/reference/metrics.py`), on the same pictures and in
the same run. The values must agree. Prints a table in Markdown, without and with other benchmarks' protocols, whose
references search for a minimum.
"""

from __future__ import annotations

import argparse
import importlib.util
import time
from pathlib import Path
from types import ModuleType

import numpy as np

import unshade

SCRIPT = Path(__file__).parents[2] / "harness/scoring/tests/reference/metrics.py"
COMPATIBLE = ("orb_", "owl_", "nerfactor_")
TOLERANCE = 1e-3


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--views", type=int, default=12)
    parser.add_argument("--size", type=int, default=512)
    options = parser.parse_args()
    reference = load(options.size)
    pictures = reference.pictures()
    truth, prediction = pictures[:2]
    made = pictures, reference.normals(), reference.mesh_normals(), reference.halves(prediction, truth)
    print("| metrics | Python libraries, s | unshade, s | times |\n|---|---|---|---|")
    compatible = reference.compatible
    for title, protocols in (("own", False), ("own and other benchmarks'", True)):
        reference.compatible = compatible if protocols else lambda *_: {}
        theirs, expected = timed(lambda: reference.references()["values"], options.views)
        names = [name for name in expected if protocols or not name.startswith(COMPATIBLE)]
        values = lambda names=names: measure(reference, made, names)
        ours, found = timed(values, options.views)
        for name in names:
            if not np.isclose(found[name], expected[name], rtol=TOLERANCE):
                raise SystemExit(f"{name}: {found[name]}, the reference has {expected[name]}")
        print(f"| {len(names)} {title} | {theirs:.1f} | {ours:.2f} | {theirs / ours:.0f} |")


def load(size: int) -> ModuleType:
    """The reference script, with square pictures and a mask that fills half of them."""
    spec = importlib.util.spec_from_file_location("metric_pictures", SCRIPT)
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    module.WIDTH = module.HEIGHT = size  # type: ignore[attr-defined]
    y, x = np.mgrid[0:size, 0:size]
    disc = np.where((x - size / 2) ** 2 + (y - size / 2) ** 2 < (0.4 * size) ** 2, 255, 0).astype(np.uint8)
    made = module.pictures()
    module.pictures = lambda: (*made[:3], disc, *made[4:])  # type: ignore[attr-defined]
    return module


def measure(reference: ModuleType, made: tuple, names: list[str]) -> dict[str, float]:
    """One call for the metrics of the same pair, region and inputs."""
    groups: dict[tuple, list] = {}
    for name in names:
        prediction, truth, beside = reference.given(made, name, unshade.metrics.DEFINITIONS[name].needs)
        key = prediction.__array_interface__["data"], prediction.shape, name not in reference.WHOLE
        _, names_of, all_beside = groups.setdefault(key, ((prediction, truth), [], {}))
        names_of.append(name)
        all_beside |= beside
    values = {}
    for (*_, erode), (pair, names_of, beside) in groups.items():
        values |= unshade.metrics.evaluate(names_of, *pair, made[0][3], erode=erode, **beside)
    return values


def timed(work, views: int) -> tuple[float, dict[str, float]]:
    start = time.perf_counter()
    for _ in range(views):
        values = work()
    return time.perf_counter() - start, values


if __name__ == "__main__":
    main()

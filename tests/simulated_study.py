"""A study that nobody ran: the scores of real captures, of made-up faces, for tests of what must bear a thousand.

``python tests/simulated_study.py RUN OUT --faces 250`` makes it from the scores of a finished run.
"""

from __future__ import annotations

import argparse
import hashlib
import json
from pathlib import Path
from typing import Any

import numpy as np

LIGHTS = ("studio", "uniform", "flash", "courtyard")
METHODS = {"good": 3.0, "twin": 3.0, "fair": 1.0, "mean_texture": 0.0}
"""What each has over the scores it is made of, dB; ``twin`` is ``good`` with other noise."""


def simulate(scores: Path, out: Path, faces: int, lights: tuple[str, ...] = LIGHTS, seed: int = 0) -> Path:
    """A run's folder with manifest and scores alone: ``faces`` x ``lights`` cases, every method on each.

    Faces differ by 2 dB (one standard deviation), methods on a face by .5 dB more.
    """
    random = np.random.default_rng(seed)
    model: dict[str, Any] = json.loads(scores.read_text())
    cases = []
    for face in range(faces):
        of_face = random.normal(0, 2)
        for light in lights:
            case = f"face{face:04d}-{light}"
            capture = hashlib.sha256(case.encode()).hexdigest()
            solvers = []
            for method, better in METHODS.items():
                shift = better + of_face + random.normal(0, 0.5)
                file = out / "scores" / case / f"{method}.json"
                file.parent.mkdir(parents=True, exist_ok=True)
                rows = [_shifted(row, model["light"], light, shift) for row in model["rows"]]
                maps = hashlib.sha256(f"{case}{method}{seed}".encode()).hexdigest()
                inputs = {"capture": capture, "maps": maps, "relit": None}
                scored = {"capture": case, "face": f"face{face:04d}", "light": light, "solver": method}
                file.write_text(json.dumps({**model, **scored, "inputs": inputs, "rows": rows}))
                kind = "baseline" if method == "mean_texture" else "solver"
                solvers.append({"id": method, "kind": kind, "scores": str(file.relative_to(out))})
            cases.append(
                {
                    "id": case,
                    "face": f"face{face:04d}",
                    "light": light,
                    "capture": case,
                    "solvers": solvers,
                    "variant": None,
                }
            )
    versions = {"scoring sources": "simulated"}
    run = {"format": 1, "suite": "study", "title": "A simulated study", "cases": cases, "versions": versions}
    (out / "run.json").write_text(json.dumps(run))
    return out


def _shifted(row: dict[str, Any], own: str, light: str, shift: float) -> dict[str, Any]:
    other = {own: light, light: own}
    changed = {**row, "light": other.get(row["light"], row["light"])}
    if row["metric"] == "psnr_srgb" and row["value"] is not None:
        changed["value"] = row["value"] + shift
    return changed


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("run", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--faces", type=int, default=250)
    options = parser.parse_args()
    simulate(next(iter(sorted((options.run / "scores").rglob("*.json")))), options.out, options.faces)

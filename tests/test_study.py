"""`unshade study` and `unshade.study`: the same numbers as files and as objects."""

from __future__ import annotations

import csv
import json
import shutil
from pathlib import Path

import numpy as np
import pytest

import unshade
from conftest import unshade as command
from unshade.errors import ScoreError

FACES = 8


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run of made scores: two methods on eight faces in two lights, ``better`` ahead by a decibel or so."""
    root = tmp_path_factory.mktemp("study") / "run"
    random = np.random.default_rng(3)
    cases = []
    for face in range(FACES):
        level = 30 + 2 * random.standard_normal()
        for light in ("studio", "flash"):
            case = f"face{face}-{light}"
            solvers = []
            for method, ahead in (("better", 1.0), ("worse", 0.0), ("oracle", 20.0)):
                path = Path("scores") / case / f"{method}.json"
                (root / path).parent.mkdir(parents=True, exist_ok=True)
                value = level + ahead + 0.2 * random.standard_normal()
                (root / path).write_text(json.dumps(_scores(face, light, method, value)))
                kind = "oracle" if method == "oracle" else "solver"
                solvers.append({"id": method, "kind": kind, "class": "passive", "scores": str(path)})
            cases.append({"id": case, "face": f"face{face}", "light": light, "variant": None, "seed": None,
                          "capture": f"captures/{case}", "solvers": solvers})  # fmt: skip
    (root / "run.json").write_text(json.dumps({"format": 1, "suite": "made", "cases": cases}))
    return root


def _scores(face: int, light: str, method: str, value: float) -> dict[str, object]:
    row = {"subject": "diffuse_albedo", "metric": "psnr_srgb", "scale": "global", "region": "coverage-e5",
           "label": None, "light": None, "value": value, "ci95": [value - 1, value + 1], "n": 100, "floor": None}  # fmt: skip
    return {"format": 1, "capture": f"face{face}-{light}", "face": f"face{face}", "light": light, "solver": method,
            "skin_tone": 60.0 if face < FACES // 2 else -40.0, "protocol": {"id": "made", "statements": []},
            "inputs": {"capture": "", "maps": "", "relit": None}, "scale": None, "regions": [], "rows": [row]}  # fmt: skip


def _faces(run: Path, method: str) -> np.ndarray:
    """The mean of each face over its lights, by itself."""
    values: dict[str, list[float]] = {}
    for path in sorted((run / "scores").glob(f"*/{method}.json")):
        document = json.loads(path.read_text())
        values.setdefault(document["face"], []).append(document["rows"][0]["value"])
    return np.array([np.mean(of) for of in values.values()])


def test_a_study_has_the_numbers_of_scipy(run: Path) -> None:
    from scipy import stats

    study = unshade.study(run)
    better, worse = _faces(run, "better"), _faces(run, "worse")
    (row,) = [row for row in study.summaries if row["method"] == "better"]
    assert row["faces"] == FACES and row["mean"] == pytest.approx(better.mean())
    assert row["ci95"] == pytest.approx(stats.t.interval(0.95, FACES - 1, better.mean(), stats.sem(better)))
    assert row["worst"][1] == pytest.approx(better.min())
    (pair,) = study.comparisons  # the oracle competes with nobody
    test = stats.permutation_test((better - worse,), np.mean, permutation_type="samples", n_resamples=np.inf)
    assert (pair["method"], pair["against"], pair["verdict"]) == ("better", "worse", "better")
    assert pair["p"] == pytest.approx(test.pvalue) and pair["gain"] == pytest.approx((better - worse).mean())
    (fair,) = [row for row in study.fairness if row["method"] == "worse"]
    light, dark = worse[: FACES // 2], worse[FACES // 2 :]
    assert {group["group"] for group in fair["groups"]} == {"very light", "dark"}
    assert fair["gap"] == pytest.approx(abs(light.mean() - dark.mean()))
    assert fair["worst"] == ("very light" if light.mean() < dark.mean() else "dark")
    welch = stats.ttest_ind(*((dark, light) if dark.mean() > light.mean() else (light, dark)), equal_var=False)
    assert fair["gap_ci95"] == pytest.approx(tuple(welch.confidence_interval()))
    assert len(study.rows) == 6 * FACES and study.rows[0]["skin_tone"] == 60.0


def test_the_command_writes_the_same_completely_or_not_at_all(run: Path, tmp_path: Path) -> None:
    out = tmp_path / "study"
    printed = command("study", run).stdout
    command("study", run, "-o", out)
    page = (out / "study.md").read_text()
    assert page.split("\n", 3)[3].strip() == printed.split("\n", 3)[3].strip() and "better against worse" in page
    assert json.loads((out / "study.json").read_text())["comparisons"] == unshade.study(run).comparisons
    with (out / "scores.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["value"]) for row in rows] == [row["value"] for row in unshade.study(run).rows]
    first = {path.name: path.read_bytes() for path in out.iterdir()}
    command("study", run, "-o", out)
    assert {path.name: path.read_bytes() for path in out.iterdir()} == first
    done = command("study", run, "-o", run / "study", check=False)
    assert done.returncode == 2 and len(done.stderr.strip().splitlines()) == 1


def test_what_is_no_study_is_refused(run: Path, tmp_path: Path) -> None:
    copy = tmp_path / "copy"
    shutil.copytree(run, copy)
    with pytest.raises(ScoreError, match="is in another run given too"):
        unshade.study(run, copy)
    shutil.rmtree(copy / "scores")
    with pytest.raises(
        ScoreError, match=r"copy: is not finished, scores/.*better.json is missing; the same `unshade run`"
    ):
        unshade.study(copy)
    with pytest.raises(ScoreError, match="run the suite to its end"):
        unshade.study(tmp_path)


def test_the_tidy_table_is_written_as_parquet(run: Path, tmp_path: Path) -> None:
    study = unshade.study(run)
    try:
        import pyarrow.parquet as pq  # type: ignore[import-not-found,import-untyped,unused-ignore]
    except ImportError:
        with pytest.raises(ScoreError, match=r"unshade\[parquet\]"):
            study.to_parquet(tmp_path / "scores.parquet")
        return
    study.to_parquet(tmp_path / "scores.parquet")
    assert pq.read_table(tmp_path / "scores.parquet").to_pylist() == study.rows

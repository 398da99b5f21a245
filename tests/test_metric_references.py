"""The stored reference values of the metrics are what the independent libraries compute today."""

import importlib.util
import json
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[1] / "harness" / "scoring" / "tests" / "reference" / "metrics.py"


def test_stored_references_are_current():
    spec = importlib.util.spec_from_file_location("metric_references", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    stored = json.loads(module.STORED.read_text())
    current = module.references()
    assert stored["pixels"] == current["pixels"]
    for group in ("values", "scale"):
        assert stored[group].keys() == current[group].keys()
        for name, value in current[group].items():
            # FLIP is single precision and sums in another order on another machine.
            tolerance = 1e-5 if name.startswith("flip") else 1e-10
            fix = "run python harness/scoring/tests/reference/metrics.py"
            assert value == pytest.approx(stored[group][name], rel=tolerance), f"{name}: {fix}"

"""The history's steps and its picture."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from unshade import errors
from unshade.history_chart import steps, write

pytest.importorskip("ruptures")


def test_steps_are_where_they_were_put_and_noise_has_none() -> None:
    random = np.random.default_rng(3)
    quiet = sum(bool(steps(random.normal(size=30))) for _ in range(200))
    assert quiet <= 18, f"{quiet} of 200 histories without a step have one"
    series = random.normal(size=40)
    series[25:] += 5.0
    assert steps(series.tolist()) == [25]
    # Of code that does not change the scores, every change is one.
    assert steps([1.0] * 10 + [1.001] * 5) == [10]
    assert steps([1.0, 2.0]) == []


def line(index: int, shift: float) -> str:
    values = {
        "unshade/diffuse_albedo/psnr_srgb@coverage-e5:global": 30.0 + 0.01 * (index % 3) - shift,
        "unshade/relit/studio/psnr_srgb@mask-e5:global": 28.0,
        "unshade/relit/flash/psnr_srgb@mask-e5:global": 30.0,
    }
    record = {"format": 1, "at": f"2026-01-{index + 1:02d}T00:00:00Z", "commit": f"{index:040x}", "suite": "ci <&>"}
    return json.dumps(record | {"values": values})


def test_the_chart_is_an_svg_that_names_the_commit_of_the_step(tmp_path: Path) -> None:
    history, out = tmp_path / "history.jsonl", tmp_path / "charts" / "chart.svg"
    history.write_text("\n".join(line(i, 0.5 if i >= 12 else 0.0) for i in range(20)) + "\n")
    assert write(history, out) == 1
    words = [element.text for element in ElementTree.parse(out).iter() if element.text]
    assert "ci <&>: 20 runs" in words
    assert f"{12:040x}"[:8] in words
    history.write_text(line(0, 0.0) + "\n{\n")
    with pytest.raises(errors.CompareError, match="jsonl:2: is not a line of a history"):
        write(history, out)

"""The leaderboard: what it says of a thousand cases, and that a browser bears them."""

from __future__ import annotations

import csv
import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import browser
import numpy as np
import pytest
from scipy import stats
from simulated_study import METHODS, simulate

import unshade as package
from conftest import unshade

CHROMIUM = browser.find()
FIGURE = "relit, other lights"

ERRORS = "<script>var faults = []; addEventListener('error', (e) => faults.push(String(e.message || e.target.src)), true);</script>"
DRIVER = """<script>
document.body.offsetHeight;
const headings = document.querySelectorAll("thead button").length;
for (let at = 0; at < headings; at++) document.querySelectorAll("thead button")[at].click();
state.figure = 0; state.down = true;
draw();
const rows = () => [...document.querySelectorAll("#methods tbody tr")].map((row) => [...row.cells].map((cell) => cell.innerText));
const all = rows();
state.light = "flash"; draw();
const flash = document.getElementById("basis").textContent;
state.light = ""; draw();
const said = { faults, headings, all, flash, rows: document.querySelectorAll("#cases tbody tr").length,
  fetched: performance.getEntriesByType("resource").map((e) => e.name), wide: document.documentElement.scrollWidth,
  window: innerWidth, t: [1, 2, 3, 4, 7, 19, 249].map(studentT) };
document.body.append(Object.assign(document.createElement("pre"), { id: "said", textContent: JSON.stringify(said) }));
</script>"""


@pytest.fixture(scope="module")
def study(tiny_run: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Scores of 1000 cases: 250 faces in four lights."""
    return simulate(tiny_run / "scores" / "tiny-studio" / "quick.json", tmp_path_factory.mktemp("site") / "study", 250)


@pytest.fixture(scope="module")
def site(study: Path) -> Path:
    out = study.parent / "site"
    unshade("site", study, "-o", out)
    return out


def test_a_thousand_cases_are_a_small_page(site: Path, study: Path) -> None:
    page = (site / "index.html").read_text()
    assert len(page) < 2_000_000
    assert not re.findall(r"""(?:src=|href=|url\()["']?(?:https?:)?//""", page)
    data = json.loads((site / "leaderboard.json").read_text())
    assert len(data["captures"]["case"]) == 1000 and [entry["name"] for entry in data["entries"]] == list(METHODS)
    again = study.parent / "again"
    assert package.site(study, out=again) == again / "index.html"
    assert (again / "index.html").read_bytes() == (site / "index.html").read_bytes()


def test_the_table_holds_the_scores(site: Path, study: Path) -> None:
    with (site / "leaderboard.csv").open(newline="") as file:
        lines = {(line["case"], line["method"]): line for line in csv.DictReader(file)}
    assert len(lines) == 1000 * len(METHODS)
    line = lines["face0007-studio", "fair"]
    scores = json.loads((study / "scores" / "face0007-studio" / "fair.json").read_text())
    others = [
        row["value"]
        for row in scores["rows"]
        if (row["subject"], row["metric"], row["scale"], row["region"]) == ("relit", "psnr_srgb", "global", "mask-e5")
        and row["label"] is None
        and row["light"] != "studio"
    ]
    assert float(line[f"{FIGURE} (dB)"]) == pytest.approx(np.mean(others), abs=1e-9)
    assert line["capture"] == scores["inputs"]["capture"]


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium here (Debian: apt install chromium)")
@pytest.mark.parametrize("width", [1400, 420])
def test_a_browser_sorts_ranks_and_fetches_nothing(site: Path, width: int) -> None:
    said = _in_browser(site / "index.html", width)
    assert said["faults"] == [] and said["fetched"] == []
    assert said["headings"] > 5
    assert said["rows"] == 50
    assert "250 of 250 captures" in said["flash"]
    # The tables scroll by themselves.
    assert said["wide"] <= said["window"]
    expected = [stats.t.ppf(0.975, degrees) for degrees in (1, 2, 3, 4, 7, 19, 249)]
    np.testing.assert_allclose(said["t"], expected, rtol=2e-4)
    means, order = _ranks(site)
    shown = {row[1].split("\n")[0]: row for row in said["all"]}
    assert {name: row[0] for name, row in shown.items()} == order
    for name, (mean, half) in means.items():
        value, interval = shown[name][2].split("\n")
        assert float(value) == pytest.approx(mean, abs=0.051) and float(interval[2:]) == pytest.approx(half, abs=0.006)


def _ranks(site: Path) -> tuple[dict[str, tuple[float, float]], dict[str, str]]:
    """Mean and half interval over faces, and the rank by SciPy's paired t test at 5 %."""
    data = json.loads((site / "leaderboard.json").read_text())
    faces = np.array(data["captures"]["face"])
    names = sorted(set(faces))
    per_face = {
        entry["name"]: np.array([np.mean(np.array(entry["values"][0])[faces == face]) / 100 for face in names])
        for entry in data["entries"]
    }
    means = {}
    ranks = {}
    for name, own in per_face.items():
        low, high = stats.t.interval(0.95, len(own) - 1, own.mean(), stats.sem(own))
        means[name] = (float(own.mean()), float(high - low) / 2)
        better = [stats.ttest_rel(other, own) for key, other in per_face.items() if key != name]
        ranks[name] = 1 + sum(test.pvalue < 0.05 and test.statistic > 0 for test in better)
    shared = list(ranks.values())
    return means, {name: f"{rank}{'=' * (shared.count(rank) > 1)}" for name, rank in ranks.items()}


def _in_browser(page: Path, width: int) -> dict[str, Any]:
    """What the page says of itself once its headings were clicked, by headless Chromium."""
    driven = page.with_name(f"driven-{width}.html")
    text = page.read_text().replace("<style>", ERRORS + "<style>", 1).replace("</body>", DRIVER + "</body>")
    driven.write_text(text)
    flags = ["--headless", "--no-sandbox", "--disable-gpu", f"--window-size={width},900", "--dump-dom"]
    try:
        done = subprocess.run([str(CHROMIUM), *flags, driven.as_uri()], capture_output=True, text=True, timeout=60)
    finally:
        driven.unlink()
    found = re.search(r'<pre id="said">(.*?)</pre>', done.stdout, re.DOTALL)
    assert found is not None, done.stdout[-2000:] + done.stderr[-2000:]
    said: dict[str, Any] = json.loads(found[1].replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&"))
    return said


def test_runs_of_others_meet_on_the_same_captures(tiny_run: Path, tmp_path: Path) -> None:
    """The same maps are one method, other maps of the same name two, and links lead to reports and pictures."""
    other = shutil.copytree(tiny_run, tmp_path / "somebody's run")
    scores = other / "scores" / "tiny-studio" / "quick.json"
    changed = json.loads(scores.read_text())
    changed["inputs"]["maps"] = "0" * 64
    scores.write_text(json.dumps(changed))
    run = other / "run.json"
    listed = json.loads(run.read_text())
    solvers = {solver["id"]: solver for solver in listed["cases"][0]["solvers"]}
    solvers["mean_texture"]["content"] = "12345678"
    run.write_text(json.dumps(listed))
    own = json.loads((tiny_run / "run.json").read_text())["cases"][0]["solvers"]
    hashes = {solver["id"]: solver["content"][:6] for solver in own}
    unshade("site", tiny_run, other, "-o", tmp_path / "site")
    data = json.loads((tmp_path / "site" / "leaderboard.json").read_text())
    names = sorted(entry["name"] for entry in data["entries"])
    means = sorted(f"mean_texture (#{mark})" for mark in ("123456", hashes["mean_texture"]))
    assert names == [*means, "oracle", "quick (somebody's run)", "quick (tiny)"]
    # On other captures, an author and the content tell methods of equal names apart, and make them one.
    for author, content, count in (("ada", "1", 1), ("bo", "1", 2), ("ada", "2", 2)):
        pair = []
        for at, (who, what) in enumerate((("ada", "1"), (author, content))):
            changed["inputs"]["capture"] = str(at) * 64
            solvers["quick"] |= {"author": who, "content": what * 64}
            pair.append(tmp_path / f"{author}{content}{at}")
            (pair[-1] / "scores" / "tiny-studio").mkdir(parents=True)
            (pair[-1] / "scores" / "tiny-studio" / "quick.json").write_text(json.dumps(changed))
            (pair[-1] / "run.json").write_text(json.dumps(listed))
        unshade("site", *pair, "-o", tmp_path / "pair")
        entries = json.loads((tmp_path / "pair" / "leaderboard.json").read_text())["entries"]
        assert len(entries) == count, (author, content)
    assert data["captures"]["case"] == ["tiny-studio"]
    assert [entry["ranked"] for entry in data["entries"] if entry["name"] == "oracle"] == [False]
    for link in [run["report"] for run in data["runs"]] + data["captures"]["picture"]:
        assert (tmp_path / "site" / unquote(link)).resolve().is_file(), link
    empty = tmp_path / "empty"
    empty.mkdir()
    bad = unshade("site", empty, "-o", tmp_path / "other", check=False)
    assert bad.returncode == 2 and "run.json: cannot be read" in bad.stderr and not (tmp_path / "other").exists()

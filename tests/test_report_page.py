"""The report in a browser, as a reader uses it."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import unquote, urlparse

import browser
import mitsuba as mi
import numpy as np
import pytest

from conftest import unshade

pytestmark = pytest.mark.skipif(browser.find() is None, reason="no Chromium here (Debian: apt install chromium)")


@pytest.fixture(scope="module")
def report(tiny_run: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("a report") / "page"
    unshade("report", tiny_run, "-o", folder)
    return folder / "index.html"


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[browser.Page]:
    with browser.browser(tmp_path_factory.mktemp("browser")) as page:
        yield page


@pytest.fixture
def opened(page: browser.Page, report: Path) -> Iterator[browser.Page]:
    """The page, freshly loaded; whatever a test does with it, nothing fails and nothing is fetched from elsewhere."""
    page.faults.clear()
    page.requested.clear()
    page.open(report, width=1280)
    yield page
    page.run("0")
    assert page.faults == []
    assert page.requested and all(url.startswith(("file:", "data:")) for url in page.requested)


DASH = "\N{EN DASH}"


def numbers(page: browser.Page, column: int) -> list[float]:
    """The first number in each row of the key figures, dashes as NaN."""
    texts = page.run(f"[...document.querySelectorAll('.summary tbody tr')].map(row => row.cells[{column}].textContent)")
    return [float(text) if text[0].isdigit() else float("nan") for text in texts]


def test_a_click_on_a_heading_sorts_and_dashes_stay_last(opened: browser.Page) -> None:
    before = numbers(opened, 4)
    assert np.isnan(before).any() and np.isfinite(before).any()
    click = "document.querySelectorAll('.summary thead button')[%d].click()"
    for order in (1, -1):
        opened.run(click % 2)
        found = numbers(opened, 2)
        assert found == sorted(found, key=lambda value: order * value)
        assert len(set(found)) > 1
    # A method that failed has no value either.
    cell = "[...document.querySelectorAll('.summary tbody tr')].find(row => row.cells[4].textContent === '%s').cells[4]"
    opened.run(f"({cell % DASH}).textContent = 'failed'")
    for _ in range(2):
        opened.run(click % 4)
        found = numbers(opened, 4)
        assert np.isfinite(found[0]) and np.isnan(found[-1])
    opened.run(f"({cell % 'failed'}).textContent = '{DASH}'")
    opened.run(click % 4)
    np.testing.assert_array_equal(numbers(opened, 4), before)


def test_a_word_shows_its_rows_alone(opened: browser.Page) -> None:
    shown = """
        [...document.querySelectorAll('section.case .scores')[0].tBodies].flatMap(body => [...body.rows])
            .filter(row => !row.hidden).map(row => row.textContent.toLowerCase())"""
    everything = opened.run(shown)
    opened.run("""
        box = document.querySelector('section.case .filter');
        box.value = 'relit psnr'; box.dispatchEvent(new Event('input'))""")
    found = opened.run(shown)
    assert 1 < len(found) < len(everything)
    assert any("psnr" in row for row in found) and not any("ssim" in row for row in found)
    opened.run("box.value = ''; box.dispatchEvent(new Event('input'))")
    assert opened.run(shown) == everything


def test_the_slider_moves_the_edge_between_truth_and_recovered(opened: browser.Page) -> None:
    edge = "parseFloat(getComputedStyle(document.querySelector('.frames .edge')).left)"
    opened.run("for (const box of document.querySelectorAll('details')) box.open = true")
    places = []
    for at in (10, 90):
        opened.run(f"slider = document.querySelector('.stage input'); slider.value = {at}")
        opened.run("slider.dispatchEvent(new Event('input'))")
        places.append(opened.run(edge))
    width = opened.run("document.querySelector('.frames').clientWidth")
    assert (places[1] - places[0]) / width == pytest.approx(0.8, abs=0.01)


VIEWED = "document.querySelector('.viewer .values').textContent.startsWith('linear')"


def test_the_viewer_shows_linear_values_exposure_and_zoom(opened: browser.Page) -> None:
    card = "document.querySelectorAll('#first .cards')[1].querySelectorAll('.card')[1]"
    opened.run(f"{card}.querySelector('button').click()")
    opened.until(VIEWED)
    link = opened.run(f"{card}.querySelector('a').href")
    albedo = np.array(mi.Bitmap(unquote(urlparse(link).path)))
    size = opened.run("canvas = document.querySelector('.canvas'); [canvas.height, canvas.width]")
    # The page shows maps in the truth's size.
    assert albedo.shape[0] % size[0] == 0
    step = albedo.shape[0] // size[0]
    row, column = size[0] // 3, size[1] // 2
    opened.run(f"""
        where = canvas.getBoundingClientRect();
        canvas.dispatchEvent(new PointerEvent('pointermove', {{
            clientX: where.left + ({column} + .5) / canvas.width * where.width,
            clientY: where.top + ({row} + .5) / canvas.height * where.height}}))""")
    said = opened.run("document.querySelector('.viewer .values').textContent")
    assert said.startswith(f"column {column}, row {row}: ")
    found = np.array([float(text) for text in said.split(": ")[1].split()])
    half = step // 2 - (step > 1)
    texels = albedo[row * step + half : row * step + step - half, column * step + half : column * step + step - half]
    np.testing.assert_allclose(found, texels.mean(axis=(0, 1)), rtol=2e-3)

    opened.run("slider = document.querySelector('.exposure'); slider.value = -1.5")
    opened.run("slider.dispatchEvent(new Event('input'))")
    shown = opened.run(f"[...canvas.getContext('2d').getImageData({column}, {row}, 1, 1).data].slice(0, 3)")
    linear = found * 2**-1.5
    curve = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    np.testing.assert_allclose(shown, 255 * curve, atol=0.6)

    width = "canvas.getBoundingClientRect().width"
    before = opened.run(width)
    opened.run("document.querySelector('.closer').click()")
    assert opened.run(width) == pytest.approx(1.5 * before)
    opened.run("document.querySelector('.viewer .close').click()")
    assert opened.run("document.querySelector('.viewer').open") is False


def test_a_narrow_window_scrolls_down_only(page: browser.Page, report: Path) -> None:
    page.faults.clear()
    page.open(report, width=420)
    page.run("for (const box of document.querySelectorAll('details')) box.open = true")
    assert page.run("document.documentElement.scrollWidth") == 420
    outside = page.run("""
        [...document.querySelectorAll('h1, h2, h3, p, .card, .thumb, summary, figcaption, .filter')]
            .filter(part => { const box = part.getBoundingClientRect(); return box.left < 0 || box.right > 421; })
            .filter(part => !part.closest('.scroll, nav, dialog')).map(part => part.outerHTML.slice(0, 90))""")
    assert outside == []
    small = page.run("parseFloat(getComputedStyle(document.querySelector('.card b')).fontSize)")
    assert small >= 12
    assert page.faults == []


def test_tables_are_beside_the_page_as_files(report: Path) -> None:
    with (report.parent / "tables" / "key-figures.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert rows[0]["method"] == "quick" and len(rows) == 3
    figures = json.loads((report.parent / "tables" / "key-figures.json").read_text())
    for row, named in zip(figures, rows, strict=True):
        assert all(value is None or isinstance(value, float) for value in list(row.values())[2:]), row
        assert all(not value or float(value) == row[name] for name, value in list(named.items())[2:])
    full = json.loads(next(report.parent.glob("tables/*/every-score.json")).read_text())
    scores = json.loads(next(report.parent.glob("data/*/quick.json")).read_text())["rows"]
    by_id = {row["id"]: row["quick"] for row in full}
    assert len(by_id) == len(full) >= len(scores)
    row = next(row for row in scores if row["metric"] == "psnr_srgb" and row["subject"] == "view" and not row["label"])
    assert by_id[f"view/psnr_srgb@{row['region']}:none"] == row["value"]

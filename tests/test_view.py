"""The page of a head in a browser: turned, relit, asked; its values against the files and its light against Mitsuba."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import browser
import mitsuba as mi
import numpy as np
import pytest
from head_page import Head, against_the_path_tracer

import unshade as package
from conftest import CASE, unshade

pytestmark = pytest.mark.skipif(browser.find() is None, reason="no Chromium here (Debian: apt install chromium)")

METHODS = ("quick", "mean_texture")


@pytest.fixture(scope="module")
def folder(tiny_run: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("a head") / "page"
    maps = [tiny_run / "maps" / CASE / name for name in METHODS]
    unshade("view", tiny_run / "captures" / CASE, *maps, "-o", out)
    return out


@pytest.fixture(scope="module")
def chromium(tmp_path_factory: pytest.TempPathFactory) -> Iterator[browser.Page]:
    with browser.browser(tmp_path_factory.mktemp("browser")) as page:
        yield page


@pytest.fixture
def head(chromium: browser.Page, folder: Path) -> Iterator[Head]:
    """The page, freshly loaded; whatever a test does with it, nothing fails and nothing is fetched from elsewhere."""
    chromium.faults.clear()
    chromium.requested.clear()
    head = Head(chromium, folder)
    head.open()
    yield head
    chromium.run("0")
    assert chromium.faults == []
    assert all(url.startswith(("file:", "data:", "blob:", "about:")) for url in chromium.requested)


def test_the_head_is_turned_by_mouse_and_keyboard(head: Head) -> None:
    before, picture = head.state()["camera"], head.linear("truth")
    box = head.page.run(
        "(({ x, y, width, height }) => [x, y, width, height])(document.getElementById('canvas').getBoundingClientRect())"
    )
    middle = (box[0] + box[2] / 6, box[1] + box[3] / 2)
    head.page.mouse(middle, (middle[0] + 30, middle[1]), (middle[0] + 60, middle[1]))
    turned = head.state()["camera"]
    assert turned[0] < before[0] - 5 and turned[2] == pytest.approx(before[2], rel=1e-3)
    assert np.abs(head.linear("truth") - picture).mean() > 0.01
    assert head.state()["spot"] is None, "a drag is not a click"
    head.page.run("""
        stage = document.getElementById("stage"); stage.focus();
        stage.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowUp" }))""")
    assert head.state()["camera"][1] == pytest.approx(turned[1] + 5, abs=0.01)


def test_a_lamp_lights_its_side_and_casts_shadows(head: Head) -> None:
    head.choose("light", "lamp")
    halves = []
    for azimuth in (-80, 80):
        head.page.run(f"unshadeView.state.lamp.azimuth = {azimuth}")
        picture = head.linear("truth")[..., :3].sum(-1)
        halves.append([picture[:, :32].sum(), picture[:, 32:].sum()])
    assert halves[0][0] > 2 * halves[0][1] and halves[1][1] > 2 * halves[1][0]


def test_the_lamps_light_is_that_of_the_path_tracer(head: Head, tiny_run: Path) -> None:
    head.page.run("Object.assign(unshadeView.state.lamp, { azimuth: 40, elevation: 35, distance: 0.7 })")
    head.choose("light", "lamp")
    lamp = head.page.run(
        "({ position: unshadeView.stage.lamp.position.toArray(), intensity: unshadeView.stage.lamp.intensity })"
    )

    class Lamp:
        lambert_light = None

        def emitters(self) -> dict[str, Any]:
            intensity = {"type": "rgb", "value": lamp["intensity"]}
            return {"lamp": {"type": "point", "position": lamp["position"], "intensity": intensity}}

    psnr = against_the_path_tracer(head, tiny_run / "captures" / CASE, Lamp())
    print(f"lamp against the path tracer: {psnr:.1f} dB")
    assert psnr > 40


def test_a_sun_in_surroundings_casts_the_path_tracers_shadows(head: Head, tiny_run: Path, tmp_path: Path) -> None:
    from unshade.render import lights
    from unshade.scene_file import Light

    sky = np.full((64, 128, 3), 0.3, np.float32)
    # To the front (the picture's middle), 40 degrees to a side, 28 degrees above the horizon.
    sky[21:23, 49:51] = 300
    package.write_exr(tmp_path / "sun.exr", sky)
    head.page.give_file("#file", tmp_path / "sun.exr")
    head.page.until("unshadeView.state.light === 'file0'")
    model = lights.unexposed(Light("sun", "envmap", path=str(tmp_path / "sun.exr")))
    psnr = against_the_path_tracer(head, tiny_run / "captures" / CASE, model, fit_exposure=True)
    print(f"sun against the path tracer: {psnr:.1f} dB")
    assert psnr > 36


def test_every_layer_is_shown(head: Head, tiny_run: Path) -> None:
    layers = head.page.run("[...document.getElementById('layer').options].map(({ value }) => value)")
    assert {"shaded", "diffuse", "specular", "diffuse_albedo", "labels", "views", "error-diffuse_albedo"} <= set(layers)
    draw = "unshadeView.stage.draw(unshadeView.cells(), 1), document.getElementById('canvas').toDataURL()"
    seen = set()
    for layer in layers:
        head.choose("layer", layer)
        seen.add(head.page.run(draw))
    assert len(seen) == len(layers)
    head.choose("layer", "error-specular_normal")
    assert "degrees" in head.page.run("document.getElementById('scale').textContent")
    # The scale of a stated deviation ends where its values do.
    head.choose("layer", "diffuse_albedo_std")
    head.page.until("!document.getElementById('scale').textContent.includes('degrees')")
    stated = np.array(mi.Bitmap(str(tiny_run / "maps" / CASE / "quick" / "diffuse_albedo_std.exr")))[..., 1]
    top = float(head.page.run("document.getElementById('top').textContent.match(/[\\d.]+/)[0]"))
    assert top == pytest.approx(np.quantile(stated[stated > 0], 0.98), rel=0.02)


def test_parts_add_up_and_errors_are_those_of_the_metrics(head: Head) -> None:
    parts = {}
    for layer in ("shaded", "diffuse", "specular"):
        head.choose("layer", layer)
        parts[layer] = head.linear("quick")[..., :3]
    np.testing.assert_allclose(parts["shaded"], parts["diffuse"] + parts["specular"], atol=1e-5)
    colours = np.random.default_rng(3).random((20, 2, 3))
    script = "(pairs) => pairs.map(([p, g]) => unshadeView.ciede2000(unshadeView.lab(p), unshadeView.lab(g)))"
    found = head.page.run(f"({script})({json.dumps(colours.tolist())})")
    for (first, second), value in zip(colours, found):
        expected = package.metrics.ciede2000_mean(first.reshape(1, 1, 3), second.reshape(1, 1, 3))
        assert value == pytest.approx(expected, rel=1e-5)


def test_a_click_tells_the_values_of_the_files(head: Head, tiny_run: Path) -> None:
    head.choose("light", head.light_named("uniform"))
    # The middle of the first pane's forehead.
    cell = head.page.run("(({ x, y, width, height }) => [x, y, width, height])(unshadeView.cells()[0])")
    box = head.page.run("(({ x, y }) => [x, y])(document.getElementById('canvas').getBoundingClientRect())")
    head.page.mouse((box[0] + cell[0] + cell[2] * 0.5, box[1] + cell[1] + cell[3] * 0.42))
    head.page.until("unshadeView.told !== undefined")
    u, v = head.state()["spot"]
    told = head.page.run("unshadeView.told.panes.map(({ pane, values }) => ({ title: pane.title, values }))")
    folders = {"truth": tiny_run / "captures" / CASE / "truth"} | {
        name: tiny_run / "maps" / CASE / name for name in METHODS
    }
    assert [each["title"] for each in told] == list(folders)
    for each in told:
        assert "diffuse_albedo" in each["values"]
        for name, found in each["values"].items():
            picture = np.array(mi.Bitmap(str(folders[each["title"]] / f"{name}.exr")))
            picture = picture.reshape(*picture.shape[:2], -1)
            side = len(picture)
            expected = picture[min(side - 1, int((1 - v) * side)), min(side - 1, int(u * side))]
            # Half floats of an albedo; the steps of folded directions, and of confidence.
            step = 2.0**-14 if "albedo" in name else 2.0**-9 if name == "confidence" else 2.0**-11
            np.testing.assert_allclose(found, expected[: len(found)], atol=step * 1.001, rtol=2.0**-11)
    observed = head.page.run("unshadeView.told.observations.map(({ radiance, weight }) => ({ radiance, weight }))")
    assert 0 < len(observed) <= 4 and sum(each["weight"] for each in observed) == pytest.approx(1)
    assert head.page.run("document.querySelectorAll('#story .card').length") == len(observed)
    assert "texel" in head.page.run("document.querySelector('#story .facts').textContent")


def test_the_answer_names_the_worst_method_and_the_view_that_shows_it(head: Head) -> None:
    head.page.run("document.querySelector('#patches button').click()")
    head.page.until("unshadeView.told !== undefined")
    told = head.page.run("""(({ panes, predicted, observations, answer }) => ({
        panes: panes.map(({ pane, values }) => [pane.title, (pane.factor ?? 1), values.diffuse_albedo]),
        answer, cameras: observations.map(({ camera }) => camera.name), cosines: observations.map(({ cosine }) => cosine),
        sums: predicted.map(({ pane, parts }) => [pane.title, parts.map(({ diffuse, specular }) =>
            unshadeView.luminance(diffuse) + unshadeView.luminance(specular))]) }))(unshadeView.told)""")
    (_, _, exact), *methods = told["panes"]
    errors = {
        title: package.metrics.ciede2000_mean(
            factor * np.float32(rgb).reshape(1, 1, 3), np.float32(exact).reshape(1, 1, 3)
        )
        for title, factor, rgb in methods
    }
    said = told["answer"]["found"]
    assert said[0].startswith("Diffuse albedo of this texel after one factor, worst first: ")
    order = sorted(errors, key=errors.__getitem__, reverse=True)
    places = [said[0].index(f"{title} CIEDE2000 {errors[title]:.1f}") for title in order]
    assert places == sorted(places)
    assert said[1].startswith(f"{len(told['cameras'])} of ")
    sums, worst = dict(told["sums"]), order[0]
    gaps = np.abs(np.subtract(sums[worst], sums["truth"])) * told["cosines"]
    assert told["answer"]["clearest"] == gaps.argmax()
    assert f"View {told['cameras'][gaps.argmax()]} shows it best: {worst} predicts" in said[-1]
    before = head.state()["camera"]
    head.page.run("document.querySelector('.answer button').click()")
    eye = head.page.run("unshadeView.stage.camera.position.toArray()")
    view = head.page.run("unshadeView.told.observations[unshadeView.told.answer.clearest].eye")
    np.testing.assert_allclose(eye, view, atol=1e-6)
    assert head.state()["camera"] != before


def test_observed_radiance_is_the_pictures(head: Head, tiny_run: Path) -> None:
    told = head.page.run("""(async () => {
        const view = unshadeView, place = view.placeAt(view.head, ...view.scene.panes[1].worst[0].uv);
        const found = await view.observations(view.scene, place);
        return found.map(({ camera, x, y, radiance }) => ({ name: camera.name, x, y, radiance }));
    })()""")
    assert told
    for each in told:
        picture = np.array(mi.Bitmap(str(tiny_run / "captures" / CASE / "images" / f"{each['name']}.exr")))[..., :3]
        left, top = int(np.floor(each["x"] - 0.5)), int(np.floor(each["y"] - 0.5))
        around = picture[top : top + 2, left : left + 2].reshape(-1, 3)
        assert (np.array(each["radiance"]) <= around.max(0) * 1.005).all()
        assert (np.array(each["radiance"]) >= around.min(0) * 0.995).all()


def test_the_address_restores_the_state(head: Head) -> None:
    fragment = (
        "#camera=25,10,0.5,0,0,0.05&lens=20&light=lamp&lamp=-30,20,0.8&turn=0&layer=error-diffuse_albedo"
        "&exposure=0.5&factor=0&panes=truth,method1&swipe=0.3"
    )
    head.open(fragment)
    head.page.run("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    state = head.state()
    assert state["layer"] == "error-diffuse_albedo" and state["swipe"] == 0.3 and state["shown"] == ["truth", "method1"]
    assert state["lamp"] == {"azimuth": -30, "elevation": 20, "distance": 0.8} and state["exposure"] == 0.5
    np.testing.assert_allclose(state["camera"], [25, 10, 0.5, 0, 0, 0.05], atol=1e-3)
    picture, address = head.linear("mean_texture"), head.address()
    head.open(address)
    assert head.state() == state
    np.testing.assert_array_equal(head.linear("mean_texture"), picture)
    edge = head.page.run("unshadeView.cells().map(({ left, right }) => [left, right])")
    width = head.page.run("document.getElementById('stage').clientWidth")
    assert edge == [[0, round(0.3 * width)], [round(0.3 * width), width]]
    head.open("#camera=1,2&light=nonsense&layer=none&panes=nobody&lamp=x")
    assert head.state()["layer"] == "shaded" and len(head.state()["shown"]) == 3


def test_a_worst_spot_is_a_click_away(head: Head) -> None:
    spots = head.page.run("[...document.querySelectorAll('#patches button')].map(({ textContent }) => textContent)")
    values = [float(re.match(r"[\d.]+", text)[0]) for text in spots]
    assert 0 < len(spots) <= 10 and values == sorted(values, reverse=True)
    assert all("times what the method states" in text for text in spots)
    head.page.run("document.querySelector('#patches button').click()")
    head.page.until("document.querySelector('#story .facts') !== null")
    state = head.state()
    assert state["spot"] and state["layer"] == "error-diffuse_albedo"
    assert head.page.run("document.querySelectorAll('#patches [aria-current]').length") == 1
    # The link restores the spot with its story; the front view is a click away.
    address, camera = head.address(), state["camera"]
    head.open(address)
    head.page.until("document.querySelector('#story .facts') !== null")
    np.testing.assert_allclose(head.state()["spot"], state["spot"], atol=1e-6)
    head.page.run("document.getElementById('front').click()")
    assert head.state()["camera"][:2] == [0, 0] != camera[:2]


def test_surroundings_from_a_file_are_exposed_as_lights_are(head: Head, tmp_path: Path) -> None:
    """A file with the same radiance everywhere is the uniform light, whatever the radiance."""
    package.write_exr(tmp_path / "grey.exr", np.full((16, 32, 3), 7.0, np.float32))
    head.choose("light", head.light_named("uniform"))
    expected = head.linear("truth")
    head.page.give_file("#file", tmp_path / "grey.exr")
    head.page.until("unshadeView.state.light === 'file0'")
    found = head.linear("truth")
    assert expected[..., :3].max() > 0.1
    np.testing.assert_allclose(found, expected, atol=0.01)
    package.write_exr(tmp_path / "square.exr", np.full((16, 16, 3), 7.0, np.float32))
    head.page.give_file("#file", tmp_path / "square.exr")
    head.page.until("document.getElementById('notice').textContent.includes('2 : 1')")


@pytest.mark.parametrize("ending", ["exr", "hdr"])
def test_a_dropped_file_stands_as_the_captures_light_does(
    head: Head, tiny_run: Path, tmp_path: Path, ending: str
) -> None:
    """The capture's own light from a file: neither mirrored nor upside down."""
    head.choose("light", "truth")
    expected = head.linear("truth")[..., :3]
    light = mi.Bitmap(str(tiny_run / "captures" / CASE / "truth" / "light.exr")).convert(
        mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False
    )
    light.write(str(tmp_path / f"light.{ending}"))
    # Chosen with its listener asleep, then dropped on the page.
    head.page.run(
        "document.querySelector('#file').addEventListener('change', (e) => e.stopImmediatePropagation(), true)"
    )
    head.page.give_file("#file", tmp_path / f"light.{ending}")
    head.page.run("""(() => { const dataTransfer = new DataTransfer();
        dataTransfer.items.add(document.getElementById('file').files[0]);
        document.dispatchEvent(new DragEvent('drop', { dataTransfer, bubbles: true, cancelable: true })); })()""")
    head.page.until("unshadeView.state.light === 'file0'")
    found = head.linear("truth")[..., :3]
    # The capture's lamps were exposed where they stand, those of a file at infinity.
    factor = expected.mean() / found.mean()
    assert factor == pytest.approx(1, abs=0.1)
    assert np.abs(factor * found - expected).mean() < 0.02 * expected.mean()


def test_the_suites_lights_are_those_of_the_files(head: Head, tiny_run: Path) -> None:
    files = sorted((tiny_run / "captures" / CASE / "truth" / "relit_lights").glob("*.exr"))
    assert files
    names = head.page.run("[...document.getElementById('light').options].map(({ textContent }) => textContent)")
    assert {file.stem for file in files} <= set(names)
    for i, file in enumerate(files):
        head.choose("light", f"light{i}")
        found = head.page.run(f"""(async () => {{
            const light = unshadeView.lights.find(({{ id }}) => id === "light{i}"), {{ width, height, numbers }} = await light.read();
            return {{ title: light.title, width, height, numbers: [...numbers.subarray(0, 3 * width * height)] }};
        }})()""")
        expected = np.array(mi.Bitmap(str(file)))[..., :3]
        assert found["title"] == file.stem and (found["height"], found["width"]) == expected.shape[:2]
        np.testing.assert_allclose(found["numbers"], expected.ravel(), rtol=2.0**-10, atol=1e-6)
        assert head.linear("truth")[..., :3].max() > 0.1


def test_a_capture_without_truth_is_shown_and_told(
    chromium: browser.Page, photographs: Path, tiny_run: Path, tmp_path: Path
) -> None:
    """Photographs have no truth: no errors, no worst spots, and predictions by the light that the method found."""
    unshade("view", photographs, tiny_run / "maps" / CASE / "quick", "-o", tmp_path / "page")
    chromium.faults.clear()
    head = Head(chromium, tmp_path / "page")
    head.open("#light=method0")
    assert [pane["title"] for pane in head.page.run("unshadeView.scene.panes")] == ["quick"]
    assert head.page.run("document.querySelectorAll('#layer option[value^=error]').length") == 0
    assert head.state()["light"] == "method0" and head.linear("quick")[..., :3].max() > 0.1
    head.page.run("document.getElementById('stage').focus()")
    head.page.run("document.getElementById('stage').dispatchEvent(new KeyboardEvent('keydown', { key: 'Enter' }))")
    head.page.until("unshadeView.told !== undefined")
    assert "as recovered by quick" in head.page.run("document.getElementById('story').textContent")
    assert chromium.faults == []


def test_a_phones_width_is_enough(head: Head) -> None:
    head.open(width=420)
    assert head.page.run("document.documentElement.scrollWidth") <= 420
    stage = head.page.run("(({ clientWidth: w, clientHeight: h }) => [w, h])(document.getElementById('stage'))")
    assert stage[0] == 420 and stage[1] >= 300
    head.page.run("document.querySelector('#patches button').click()")
    head.page.until("document.querySelector('#story .facts') !== null")
    assert head.page.run("document.documentElement.scrollWidth") <= 420
    assert len(head.page.run("unshadeView.cells()")) == 3


def test_a_report_links_to_its_heads_and_loads_them_when_opened(
    chromium: browser.Page, tiny_run: Path, tmp_path: Path
) -> None:
    report = tiny_run / "report"
    unshade("site", tiny_run, "-o", tmp_path / "site")
    links = json.loads((tmp_path / "site" / "leaderboard.json").read_text())["captures"]["head"]
    assert links and all((tmp_path / "site" / link).is_file() for link in links)
    chromium.requested.clear()
    chromium.faults.clear()
    chromium.open(report / "index.html", 1200)
    link = chromium.run("document.querySelector('.case a[href^=\"heads/\"]').getAttribute('href')")
    assert not any("heads/" in url for url in chromium.requested)
    chromium.open(report / link, 800, 480)
    chromium.run("unshadeView.ready")
    assert chromium.run("unshadeView.scene.panes.map(({ title }) => title).length") == 3
    assert chromium.faults == [] and all(url.startswith(("file:", "data:", "blob:")) for url in chromium.requested)


def test_a_notebook_shows_the_page_itself(chromium: browser.Page, tiny_run: Path, tmp_path: Path) -> None:
    page = package.view(tiny_run / "captures" / CASE, tiny_run / "maps" / CASE / "quick")
    (tmp_path / "notebook.html").write_text("<!doctype html><meta charset=utf-8>" + page._repr_html_())
    chromium.open(tmp_path / "notebook.html", 800, 480)
    chromium.until("frames[0].unshadeView?.ready !== undefined", 60)
    assert chromium.run("frames[0].unshadeView.ready.then(() => frames[0].unshadeView.scene.panes.length)") == 2
    assert page.path.exists() and "HeadPage" in repr(page)


def test_without_webgl_the_page_says_so_and_shows_pictures(folder: Path, tmp_path: Path) -> None:
    with browser.browser(tmp_path) as page:
        page.before_scripts("HTMLCanvasElement.prototype.getContext = new Proxy(HTMLCanvasElement.prototype.getContext, {"
                            "apply: (get, canvas, given) => given[0] === 'webgl2' ? null : Reflect.apply(get, canvas, given) })")  # fmt: skip
        page.open(folder / "index.html", 800)
        page.run("unshadeView.ready")
        assert "WebGL" in page.run("document.getElementById('notice').textContent")
        assert page.run("document.querySelectorAll('#stills canvas').length") > 8
        assert page.faults == []


def test_bad_input_is_one_line_and_leaves_nothing(tiny_run: Path, tmp_path: Path) -> None:
    capture, maps = tiny_run / "captures" / CASE, tiny_run / "maps" / CASE / "quick"
    for arguments, said in [
        ([capture, maps, maps, maps, maps], "at most 3"),
        ([capture, tiny_run / "scores"], "diffuse_albedo.exr"),
        ([tiny_run / "scores", maps], "transforms.json"),
    ]:
        done = unshade("view", *arguments, "-o", tmp_path / "page", check=False)
        assert done.returncode == 2 and said in done.stderr and done.stderr.count("\n") == 1, done.stderr
        assert not (tmp_path / "page").exists()

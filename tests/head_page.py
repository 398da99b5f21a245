"""The page of a head in the browser, with its head drawn."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import browser
import mitsuba as mi
import numpy as np


class Head:
    """The page with its head drawn."""

    def __init__(self, page: browser.Page, folder: Path) -> None:
        self.page, self.folder = page, folder

    def open(self, fragment: str = "", width: int = 800) -> None:
        # Small, because WebGL in software draws it.
        self.page.open(self.folder / "index.html", width, 480, fragment)
        self.page.run("unshadeView.ready")

    def choose(self, control: str, value: str) -> None:
        """Sets a control and waits until the picture is drawn."""
        self.page.run(f"""(async () => {{
            const control = document.getElementById("{control}");
            control.value = {json.dumps(value)};
            control.dispatchEvent(new Event("change"));
            control.dispatchEvent(new Event("input"));
            await unshadeView.refresh();
        }})()""")

    def light_named(self, title: str) -> str:
        """The value of the light of a title in its list."""
        return self.page.run(
            f"[...document.getElementById('light').options].find(({{ textContent }}) => textContent === '{title}').value"
        )

    def linear(self, pane: str, width: int = 64, height: int = 64) -> np.ndarray:
        """Linear values (height, width, 4) of a pane."""
        script = f"""(async () => {{
            const pane = unshadeView.scene.panes.find(({{ title }}) => title === "{pane}");
            await unshadeView.refresh();
            return [...unshadeView.stage.linear(pane, {width}, {height})].map((x) => Number(x.toPrecision(7)));
        }})()"""
        return np.array(self.page.run(script), np.float32).reshape(height, width, 4)

    def address(self) -> str:
        """The part of the address from #, once it states what is shown: a frame may come later than a change."""
        self.page.until("location.hash === unshadeView.toAddress(unshadeView.state)")
        return self.page.run("location.hash")

    def state(self) -> dict[str, Any]:
        return self.page.run("JSON.parse(JSON.stringify(unshadeView.state))")


def against_the_path_tracer(head: Head, capture: Path, light: Any, fit_exposure: bool = False) -> float:
    """PSNR of sRGB values within the eroded mask: direct light of the true maps, from the first training view."""
    from unshade.camera.camera import Camera
    from unshade.render.scene import HeadScene
    from unshade.surface import read_surface

    size, fine = 128, 4
    view = head.page.run("unshadeView.scene.views.list[0]")
    head.page.run("unshadeView.jump(unshadeView.scene.views.list[0])")
    found = head.linear("truth", size * fine, size * fine).reshape(size, fine, size, fine, 4).mean((1, 3))
    surface = read_surface(capture / "truth", capture, None, print)
    lit = HeadScene(surface.mesh, [], surface.maps).lit(light)
    matrix = np.array(view["camera_to_world"]).reshape(4, 4).T
    camera = Camera("000", size, size, view["focal"][0] * size / view["width"], matrix, True)
    path = mi.load_dict({"type": "path", "max_depth": 2, "hide_emitters": True})
    expected = np.array(mi.render(lit.scene, sensor=camera.sensor(256), integrator=path, spp=256))[..., :3]
    mask = found[..., 3] == 1
    for axis in (0, 1):
        mask &= np.logical_and.reduce([np.roll(mask, shift, axis) for shift in (-2, -1, 1, 2)])
    found, expected = found[mask][:, :3], expected[mask]
    assert mask.mean() > 0.15
    if fit_exposure:
        expected = expected * ((found * expected).sum() / (expected**2).sum())
    assert expected.mean() > 0.05
    curve = lambda x: np.where(
        x.clip(0, 1) <= 0.0031308, 12.92 * x.clip(0, 1), 1.055 * x.clip(1e-9, 1) ** (1 / 2.4) - 0.055
    )
    return float(-10 * np.log10(((curve(found) - curve(expected)) ** 2).mean()))

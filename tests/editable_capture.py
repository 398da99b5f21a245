"""A capture folder that a test changes at will, and what its solve must keep to."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import unshade
from unshade.files.pictures import read_exr, read_gray, read_rgb, write_exr, write_gray

CONFIG = """
base = "fast"
regions.texture_size = 32
transport = { texture_size = 32, rows = 6 }
joint = { grey_steps = 10, steps = 10 }
relief.steps = 40
albedo.steps = 5
maps.texture_size = 64
"""
"""A solve of half a second."""


@dataclass
class Editable:
    """A capture folder of a test's own."""

    folder: Path

    @property
    def transforms(self) -> dict[str, Any]:
        return json.loads((self.folder / "transforms.json").read_text())

    @transforms.setter
    def transforms(self, document: dict[str, Any]) -> None:
        (self.folder / "transforms.json").write_text(json.dumps(document))

    @property
    def training(self) -> list[str]:
        return [Path(name).stem for name in self.transforms["train_filenames"]]

    def keep_training(self, count: int) -> None:
        document = self.transforms
        document["train_filenames"] = document["train_filenames"][:count]
        self.transforms = document

    def change_frame(self, name: str, change: Callable[[dict[str, Any]], object]) -> None:
        document = self.transforms
        change(next(frame for frame in document["frames"] if frame["name"] == name))
        self.transforms = document

    def change_image(self, name: str, change: Callable[[np.ndarray], np.ndarray]) -> None:
        path = self.folder / "images" / f"{name}.exr"
        write_exr(path, {"": change(read_rgb(path)).astype(np.float32)})

    def change_png(self, kind: str, name: str, change: Callable[[np.ndarray], np.ndarray]) -> None:
        path = self.folder / kind / f"{name}.png"
        write_gray(path, np.ascontiguousarray(change(read_gray(path)).astype(np.uint8)))

    def change_mesh(self, change: Callable[[dict[str, np.ndarray]], None]) -> None:
        """Arrays ``v``, ``vt``, ``vn`` and corners ``f`` (from 0, the same for all three); an
        empty ``vn`` writes no normals."""
        mesh = unshade.Capture(self.folder).mesh
        arrays = dict(zip(("v", "vt", "vn", "f"), (mesh[key] for key in ("vertices", "uvs", "normals", "triangles"))))
        change(arrays)
        corner = " %d/%d/%d" if len(arrays["vn"]) else " %d/%d"
        arrays["f"] = arrays["f"].repeat(corner.count("d"), axis=1) + 1
        lines = {
            "v": "v %.9g %.9g %.9g\n",
            "vt": "vt %.9g %.9g\n",
            "vn": "vn %.9g %.9g %.9g\n",
            "f": f"f{3 * corner}\n",
        }
        text = [line * len(arrays[key]) % tuple(arrays[key].ravel().tolist()) for key, line in lines.items()]
        (self.folder / "mesh.obj").write_text("".join(text))

    def solve(self, config: str = CONFIG) -> unshade.Maps:
        """Maps whose every value is checked, withheld views included."""
        out = self.folder.with_name("maps")
        maps = unshade.solve(unshade.Capture(self.folder), config=config, out=out)
        size = maps.diffuse_albedo.shape[0]
        assert maps.diffuse_albedo.shape == (size, size, 3) and maps.specular_albedo.shape == (size, size)
        for albedo, maximum in ((maps.diffuse_albedo, 20.0), (maps.specular_albedo, 1.0)):
            assert np.isfinite(albedo).all() and albedo.max() < maximum
            assert albedo.min() >= 0 or "paper" in config  # which leaves them free
        for normal in (maps.diffuse_normal, maps.specular_normal):
            np.testing.assert_allclose(np.linalg.norm(normal, axis=-1), 1, atol=1e-4)
        assert set(np.unique(maps.coverage)) <= {0, 255} and maps.coverage.any()
        for frame in self.transforms["test_filenames"]:
            view = read_exr(out / "views" / Path(frame).name)  # refuses what is not finite
            assert len(view) >= 9 and max(np.abs(channel).max() for channel in view.values()) < 1e3
        return maps

    def refusal(self) -> str:
        """The one line that the capture is refused with."""
        with pytest.raises(unshade.errors.CaptureError) as caught:
            self.solve()
        message = str(caught.value)
        assert "\n" not in message and str(self.folder) in message and ";" in message
        return message

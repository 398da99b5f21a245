"""Writes an imported capture: pictures, masks, labels, mesh, ``transforms.json`` and ``import.json``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .. import _native
from ..files.folder import ResumableFolder
from ..files.pictures import make_folder, write_bytes, write_gray, write_json
from ..stated_light import LIGHT_FRAMES
from .chart_mesh import ChartMesh
from .photographs import ImportedView

RECORD = "import.json"


class CaptureWriter:
    """A capture folder under construction; it appears with `commit`. An interrupted import with the same ``key``
    resumes. Raises `StorageError` where it may not be written."""

    def __init__(self, out: Path, key: str) -> None:
        self._folder = ResumableFolder(out, key)
        self._path = self._folder.path
        self._frames: list[dict[str, Any]] = []
        self._train: list[str] = []
        self._test: list[str] = []
        self._labelled = False

    def mesh(self, mesh: ChartMesh) -> None:
        write_bytes(self._path / "mesh.obj", mesh.text())

    def view(self, taken: ImportedView, *, withheld: bool, light: str | None) -> None:
        """Writes one view with its mask and the name of its light, if it has one. A camera keeps its lens only if
        ``transforms.json`` can state it."""
        name, camera = taken.name, taken.camera
        image = f"images/{name}.exr"
        frame: dict[str, Any] = {
            "name": name,
            "file_path": image,
            "mask_path": f"masks/{name}.png",
            "camera_model": "PINHOLE" if taken.lens.straight else "OPENCV",
            "w": camera.width,
            "h": camera.height,
            "fl_x": camera.focal[0],
            "fl_y": camera.focal[1],
            "cx": camera.centre[0],
            "cy": camera.centre[1],
            **taken.lens.terms,
            "transform_matrix": camera.camera_to_world.tolist(),
        }
        if light is not None:
            frame["light"] = light
        if taken.labels is not None:
            frame["label_path"] = f"labels/{name}.png"
            self._labelled = True
        self._frames.append(frame)
        (self._test if withheld else self._train).append(image)
        if (self._path / image).is_file():
            return
        for kind, plane in (("masks", taken.mask), ("labels", taken.labels)):
            if plane is not None:
                write_gray(self._path / kind / f"{name}.png", np.ascontiguousarray(plane))
        # The picture is the last file, because it marks the view as finished; it appears whole or not at all.
        make_folder(self._path / "images")
        _native.write_colour(self._path / image, taken.radiance)

    def transforms(self, labels: Sequence[tuple[str, int]], light_frame: str, *, unknown_exposure: bool) -> None:
        """Writes the cameras; ``labels`` are the names and ids of label pictures, ``light_frame`` is what the light
        stands still with, ``unknown_exposure`` whether frames have unknown factors."""
        document: dict[str, Any] = {
            "mesh": "mesh.obj",
            "frames": self._frames,
            "train_filenames": self._train,
            "test_filenames": self._test,
        }
        if light_frame != LIGHT_FRAMES[0]:
            document["light_frame"] = light_frame
        if unknown_exposure:
            document["exposure"] = "unknown"
        if self._labelled:
            document["label_names"] = {str(number): name for name, number in labels}
        write_json(self._path / "transforms.json", document)

    def record(self, document: dict[str, Any]) -> None:
        """Writes `import.json`: the sources, and the assumptions."""
        write_json(self._path / RECORD, document, ensure_ascii=False)

    def commit(self) -> None:
        self._folder.commit()

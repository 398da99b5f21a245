"""Writes an imported capture: pictures, masks, labels, mesh, ``transforms.json`` and ``import.json``."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from .. import _native
from ..errors import StorageError
from ..render.folder import ResumableFolder
from .chart_mesh import ChartMesh
from .photographs import Taken

RECORD = "import.json"


class CaptureWriter:
    """A capture folder under construction; it appears with `commit`. An interrupted import with the same ``key``
    is taken up. Raises `StorageError` where it may not be written."""

    def __init__(self, out: Path, key: str) -> None:
        self._out = out
        self._folder = ResumableFolder(out, key)
        self._path = self._folder.path
        self._frames: list[dict[str, Any]] = []
        self._train: list[str] = []
        self._test: list[str] = []
        self._labelled = False

    def mesh(self, mesh: ChartMesh) -> None:
        self._write("mesh.obj", mesh.text())

    def view(self, taken: Taken, *, withheld: bool) -> None:
        """One view with its mask; every camera is a pinhole but those whose lens a capture can say."""
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
        if taken.labels is not None:
            frame["label_path"] = f"labels/{name}.png"
            self._labelled = True
        self._frames.append(frame)
        (self._test if withheld else self._train).append(image)
        if (self._path / image).is_file():
            return
        if taken.mask is not None:
            self._gray(f"masks/{name}.png", taken.mask)
        if taken.labels is not None:
            self._gray(f"labels/{name}.png", taken.labels)
        # Last, since it marks the view as finished; it appears whole or not at all.
        _native.write_colour(self._made(image), taken.radiance)

    def transforms(self, labels: Sequence[tuple[str, int]]) -> None:
        """The cameras; ``labels`` are the names and ids of label pictures."""
        document: dict[str, Any] = {
            "mesh": "mesh.obj",
            "frames": self._frames,
            "train_filenames": self._train,
            "test_filenames": self._test,
        }
        if self._labelled:
            document["label_names"] = {str(number): name for name, number in labels}
        self._write("transforms.json", (json.dumps(document, indent=1) + "\n").encode())

    def record(self, document: dict[str, Any]) -> None:
        """Writes `import.json`: what was read, and what had to be assumed."""
        self._write(RECORD, (json.dumps(document, indent=1, ensure_ascii=False) + "\n").encode())

    def commit(self) -> None:
        self._folder.commit()

    def _gray(self, name: str, plane: NDArray[np.uint8]) -> None:
        path = self._made(name)
        try:
            Image.fromarray(np.ascontiguousarray(plane)).save(path, format="PNG")
        except OSError as error:
            raise self._unwritten(error) from error

    def _write(self, name: str, data: bytes) -> None:
        path = self._made(name)
        try:
            path.write_bytes(data)
        except OSError as error:
            raise self._unwritten(error) from error

    def _made(self, name: str) -> Path:
        path = self._path / name
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise self._unwritten(error) from error
        return path

    def _unwritten(self, error: OSError) -> StorageError:
        return StorageError(f"{self._out}: cannot be written: {error.strerror}; make room or choose another folder")

"""Outputs of stages by their content, in a folder or behind a URL of fsspec that all machines reach."""

from __future__ import annotations

import json
import os
import shutil
import tarfile
import tempfile
import uuid
from pathlib import Path
from typing import Any

import fsspec
from fsspec.implementations.local import LocalFileSystem

from ..errors import ClusterError


class Store:
    """``objects/<content>.tar`` holds an output, ``keys/<key>.json`` the content of a key."""

    def __init__(self, url: str) -> None:
        try:
            self._files, self._root = fsspec.core.url_to_fs(url)
            self._files.makedirs(f"{self._root}/objects", exist_ok=True)
            self._files.makedirs(f"{self._root}/keys", exist_ok=True)
        except Exception as error:
            raise ClusterError(f"{url}: cannot be used as a store: {error}; name a shared folder or a URL") from error
        self.url = url

    def contains(self, content: str) -> bool:
        return bool(self._files.exists(self._object(content)))

    def put(self, content: str, output: Path) -> None:
        """Keeps a file or folder under the hash of its content."""
        if self.contains(content):
            return
        with tempfile.NamedTemporaryFile(suffix=".tar") as packed:
            with tarfile.open(packed.name, "w") as tar:
                tar.add(output, arcname="output")
            self._write(packed.name, self._object(content))

    def get(self, content: str, output: Path) -> None:
        """Unpacks the content of a hash to ``output``, which appears completely or not at all."""
        output.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix=".unshade-", dir=output.parent) as folder:
            packed = Path(folder) / "packed.tar"
            self._files.get_file(self._object(content), str(packed))
            with tarfile.open(packed) as tar:
                tar.extractall(folder, filter="data")
            if output.is_dir():
                shutil.rmtree(output)
            os.replace(Path(folder) / "output", output)

    def note(self, key: str, done: dict[str, Any]) -> None:
        """Records the outcome of a key; called last, so that its output is there."""
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            json.dump(done, file)
            file.flush()
            self._write(file.name, self._key(key))

    def known(self, key: str) -> dict[str, Any] | None:
        """The record of a key, if its output is still there."""
        if not self._files.exists(self._key(key)):
            return None
        done: dict[str, Any] = json.loads(self._files.cat_file(self._key(key)))
        return done if self.contains(done["record"]["content"]) else None

    def remove(self) -> None:
        """Removes everything."""
        self._files.rm(self._root, recursive=True)

    def _object(self, content: str) -> str:
        return f"{self._root}/objects/{content}.tar"

    def _key(self, key: str) -> str:
        return f"{self._root}/keys/{key}.json"

    def _write(self, source: str, target: str) -> None:
        """Writes completely or not at all: object stores do so, and in a folder the file is renamed."""
        if not isinstance(self._files, LocalFileSystem):
            self._files.put_file(source, target)
            return
        partial = f"{target}.{uuid.uuid4().hex}.partial"
        shutil.copyfile(source, partial)
        os.replace(partial, target)

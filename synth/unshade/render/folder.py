"""A folder that is written completely or not at all, and taken up where it was left.

Work goes into ``X.partial``, which carries a key of everything that decides its content.
A later attempt with the same key keeps what is finished; with another key it starts anew.
"""

from __future__ import annotations

import hashlib
import os
import shutil
from pathlib import Path

from ..errors import StorageError

_KEY_FILE = "key.txt"


def content_hash(path: Path) -> str:
    """Hash of a file's bytes, or ``none`` where there is no file."""
    return hashlib.blake2b(path.read_bytes(), digest_size=16).hexdigest() if path.is_file() else "none"


class ResumableFolder:
    """``target`` under construction in ``path``."""

    def __init__(self, target: Path, key: str) -> None:
        self.target = target
        self.path = target.with_name(f"{target.name}.partial")
        digest = hashlib.blake2b(key.encode(), digest_size=16).hexdigest()
        try:
            if not self._continues(digest):
                if self.path.exists():
                    shutil.rmtree(self.path)
                self.path.mkdir(parents=True)
                (self.path / _KEY_FILE).write_text(digest)
        except OSError as error:
            raise _unwritable(self.path, error) from error

    def _continues(self, digest: str) -> bool:
        key_file = self.path / _KEY_FILE
        return key_file.is_file() and key_file.read_text() == digest

    def commit(self) -> None:
        """Puts the complete folder in the target's place, replacing what was there."""
        try:
            for left in self.path.rglob("*.partial"):
                left.unlink()
            if self.target.exists():
                shutil.rmtree(self.target)
            (self.path / _KEY_FILE).unlink()
            os.replace(self.path, self.target)
        except OSError as error:
            raise _unwritable(self.target, error) from error


def _unwritable(path: Path, error: OSError) -> StorageError:
    return StorageError(f"{path}: cannot be written: {error.strerror}; make room or choose another folder")

"""A folder that is written completely or not at all, and resumed after an interruption.

Work goes into ``X.partial``, which carries a key of everything that decides its content.
A later attempt with the same key keeps what is finished; with another key it starts anew.
A folder that unshade did not write is never replaced.
"""

from __future__ import annotations

import hashlib
from pathlib import Path

from .. import _native
from .pictures import unwritten


def content_hash(path: Path) -> str:
    """Hash of a file's bytes, or ``none`` where there is no file."""
    return hashlib.blake2b(path.read_bytes(), digest_size=16).hexdigest() if path.is_file() else "none"


class ResumableFolder:
    """``target`` under construction in ``path``. Raises `StorageError` where it may not be written."""

    def __init__(self, target: Path, key: str) -> None:
        self.target = target
        self._key = hashlib.blake2b(key.encode(), digest_size=16).hexdigest()
        self.path = Path(_native.begin_folder(target, self._key))

    def commit(self) -> None:
        """Puts the complete folder in the target's place, replacing what was there."""
        try:
            for left in self.path.rglob("*.partial"):
                left.unlink()
        except OSError as error:
            raise unwritten(self.target, error) from error
        _native.commit_folder(self.target, self._key)

"""A key for values: equal values have equal keys, whatever they are made of."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from typing import Any

import numpy as np


def content_key(*values: Any) -> str:
    """BLAKE2 hash of dataclasses, arrays, mappings, sequences, enumerations, texts and numbers.

    Raises `TypeError` for anything else, rather than hash where it lies in memory.
    """
    digest = hashlib.blake2b(digest_size=20)
    _enter(digest, values)
    return digest.hexdigest()


def _enter(digest, value: Any) -> None:
    if value is None or isinstance(value, (bool, int, float, str, np.generic)):
        _item(digest, type(value).__name__, repr(value).encode())
    elif isinstance(value, np.ndarray):
        _item(digest, f"{value.dtype.str}{value.shape}", np.ascontiguousarray(value).data)
    elif isinstance(value, Enum):
        _item(digest, type(value).__name__, value.name.encode())
    elif is_dataclass(value) and not isinstance(value, type):
        _item(digest, type(value).__name__, b"")
        for field in fields(value):
            _enter(digest, getattr(value, field.name))
    elif isinstance(value, Mapping):
        _item(digest, "mapping", str(len(value)).encode())
        for key, item in value.items():
            _enter(digest, key)
            _enter(digest, item)
    elif isinstance(value, (tuple, list)):
        _item(digest, "sequence", str(len(value)).encode())
        for item in value:
            _enter(digest, item)
    else:
        raise TypeError(f"a {type(value).__name__} has no content key")


def _item(digest, kind: str, content) -> None:
    # Lengths keep neighbours apart.
    digest.update(f"{kind}:{memoryview(content).nbytes}:".encode())
    digest.update(content)

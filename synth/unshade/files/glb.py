"""The container of binary glTF 2.0: a JSON document and a buffer (glTF 2.0 specification, 4.4)."""

from __future__ import annotations

import json
import struct
from typing import Any

_JSON_CHUNK, _BINARY_CHUNK = 0x4E4F534A, 0x004E4942


def packed(document: dict[str, Any], binary: bytes) -> bytes:
    """The bytes of a GLB; ``document`` gets the buffer, padded to whole words."""
    binary = bytes(binary) + b"\0" * (-len(binary) % 4)
    words = json.dumps(document | {"buffers": [{"byteLength": len(binary)}]}, separators=(",", ":")).encode()
    words += b" " * (-len(words) % 4)
    chunks = ((_JSON_CHUNK, words), (_BINARY_CHUNK, binary))
    body = b"".join(struct.pack("<II", len(data), kind) + data for kind, data in chunks)
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


def unpacked(data: bytes) -> tuple[Any, bytes | None]:
    """The document and the buffer of a GLB. Raises `ValueError`, in words, for anything else."""
    if data[:4] != b"glTF" or len(data) < 20 or struct.unpack_from("<I", data, 4)[0] != 2:
        raise ValueError("is not binary glTF 2.0")
    chunks: dict[int, bytes] = {}
    at = 12
    while at + 8 <= len(data):
        length, kind = struct.unpack_from("<II", data, at)
        if at + 8 + length > len(data):
            raise ValueError(f"ends within a chunk of {length} bytes")
        chunks.setdefault(kind, data[at + 8 : at + 8 + length])
        at += 8 + length
    if _JSON_CHUNK not in chunks:
        raise ValueError("is not binary glTF 2.0")
    return json.loads(chunks[_JSON_CHUNK]), chunks.get(_BINARY_CHUNK)

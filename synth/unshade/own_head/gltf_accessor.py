"""Numbers of a glTF file: accessors, with integers that stand for fractions, strides and sparse values."""

from __future__ import annotations

from typing import Any

import numpy as np

_KINDS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
"""Component types (glTF 2.0 specification, 3.6.2.2)."""

_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}

_MAX_ZEROS = 1 << 24
"""Elements of an accessor that no bytes stand behind."""


def item(document: dict[str, Any], key: str, number: Any) -> dict[str, Any]:
    """The element of a list of the document, by its number."""
    items = document.get(key, [])
    if not isinstance(number, int) or not 0 <= number < len(items):
        raise ValueError(f"there is no {key}[{number}]")
    return items[number]


class Accessors:
    """The accessors of a document, read from its buffers."""

    def __init__(self, document: dict[str, Any], buffers: list[bytes | None]) -> None:
        self._document = document
        self._buffers = buffers

    def is_empty(self, number: int) -> bool:
        """Whether nothing stands behind an accessor: an extension would have to fill it."""
        accessor = item(self._document, "accessors", number)
        return "bufferView" not in accessor and "sparse" not in accessor

    def read(self, number: int, width: int) -> np.ndarray:
        """Values (count, width): f32 as they are, integers as fractions (f64) or as they are."""
        accessor = item(self._document, "accessors", number)
        values = self._raw(accessor, number)
        if values.shape[1] != width:
            raise ValueError(f"accessors[{number}] has {values.shape[1]} numbers per element; expected {width}")
        if accessor.get("normalized") and values.dtype.kind in "iu":
            return np.maximum(values / np.iinfo(values.dtype).max, -1.0)
        return values if values.dtype.kind == "f" else values.astype(np.float64)

    def read_indices(self, number: int) -> np.ndarray:
        """Whole numbers (count,) i64."""
        values = self._raw(item(self._document, "accessors", number), number)
        if values.dtype.kind != "u" or values.shape[1] != 1:
            raise ValueError(f"accessors[{number}] holds no indices")
        return values[:, 0].astype(np.int64)

    def _raw(self, accessor: dict[str, Any], number: int) -> np.ndarray:
        kind, width, count = _KINDS.get(accessor["componentType"]), _WIDTHS.get(accessor["type"]), accessor["count"]
        if kind is None or width is None or not isinstance(count, int) or count < 0:
            raise ValueError(f"accessors[{number}] is of no known kind")
        if "bufferView" in accessor:
            values = self._view(accessor["bufferView"], accessor.get("byteOffset", 0), kind, width, count)
        elif count <= _MAX_ZEROS:
            values = np.zeros((count, width), kind)
        else:
            raise ValueError(f"accessors[{number}] has {count} elements and no bytes")
        if "sparse" in accessor:
            sparse = accessor["sparse"]
            few = sparse["count"]
            if not isinstance(few, int) or not 0 <= few <= count:
                raise ValueError(f"accessors[{number}] has {few} sparse values of {count}")
            at, new = sparse["indices"], sparse["values"]
            places = self._view(at["bufferView"], at.get("byteOffset", 0), _KINDS[at["componentType"]], 1, few)[:, 0]
            if few and not 0 <= places.min() <= places.max() < count:
                raise ValueError(f"accessors[{number}] has a sparse value beyond its end")
            values = values.copy()
            values[places] = self._view(new["bufferView"], new.get("byteOffset", 0), kind, width, few)
        return values

    def _view(self, number: int, offset: int, kind: str, width: int, count: int) -> np.ndarray:
        """Elements (count, width) within a buffer view; nothing is copied before its ends are checked."""
        view = item(self._document, "bufferViews", number)
        buffers = self._buffers
        buffer = view["buffer"]
        if not isinstance(buffer, int) or not 0 <= buffer < len(buffers) or buffers[buffer] is None:
            raise ValueError(f"bufferViews[{number}] has no bytes")
        data = buffers[buffer]
        start, length, size = view.get("byteOffset", 0), view["byteLength"], np.dtype(kind).itemsize * width
        stride = view.get("byteStride", size)
        if not all(isinstance(value, int) and value >= 0 for value in (start, length, offset, stride)) or stride < size:
            raise ValueError(f"bufferViews[{number}] has lengths that cannot be")
        needed = offset + (count - 1) * stride + size if count else 0
        if needed > length or start + length > len(data):
            raise ValueError(f"bufferViews[{number}] ends before its {count} elements do")
        return (
            np.ndarray((count, width), kind, data, start + offset, (stride, np.dtype(kind).itemsize))
            if count
            else np.zeros((0, width), kind)
        )

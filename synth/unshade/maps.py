"""`Maps`: reflectance maps as numpy arrays."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import Any, ClassVar, Generic, TypeVar, cast, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from .errors import MapsError

_Path = str | os.PathLike[str]
_Number = TypeVar("_Number", np.float32, np.uint8)


class _Map(Generic[_Number]):
    """A map of `Maps`: an array, or None; what is assigned is checked and copied."""

    def __init__(self, channels: int, doc: str) -> None:
        self.channels = channels
        self.__doc__ = doc

    def __set_name__(self, owner: type[Maps], name: str) -> None:
        self.name = name

    @overload
    def __get__(self, maps: None, owner: type[Maps]) -> _Map[_Number]: ...
    @overload
    def __get__(self, maps: Maps, owner: type[Maps]) -> NDArray[_Number] | None: ...
    def __get__(self, maps: Maps | None, owner: type[Maps]) -> _Map[_Number] | NDArray[_Number] | None:
        if maps is None:
            return self
        array = cast("dict[str, NDArray[_Number]]", maps._arrays).get(self.name)  # pyright: ignore[reportPrivateUsage]
        return None if array is None else array.view()

    def __set__(self, maps: Maps, value: ArrayLike | None) -> None:
        maps._set(self.name, self.channels, value)  # pyright: ignore[reportPrivateUsage]


class Maps:
    """Square reflectance maps of one size; a map that a method does not recover is None.

    A map may be given as anything numpy makes a float array of; it is kept as float32. Reading one
    gives a view that cannot be written to, without a copy; assign a new array to change a map. A
    map of another size than the others, with other channels, or with NaN where there is coverage
    (anywhere without one) raises ``errors.MapsError``, which names it. Maps with equal values are
    equal, wherever a solve was stopped.

    ``maps["diffuse_albedo"]`` is the map of this name and raises KeyError where it is None; iteration,
    ``in`` and ``keys()`` list the names of the present maps.
    """

    __slots__ = ("_arrays", "interrupted")

    diffuse_albedo = _Map[np.float32](3, "(size, size, 3) linear Rec.709 reflectance.")
    specular_albedo = _Map[np.float32](1, "(size, size) reflectance at normal incidence, 0 to 0.05.")
    diffuse_normal = _Map[np.float32](3, "(size, size, 3) unit vectors in object space.")
    specular_normal = _Map[np.float32](3, "(size, size, 3) unit vectors in object space.")
    confidence = _Map[np.float32](1, "(size, size) 0 to 1: the solver's own trust in the diffuse albedo.")
    roughness = _Map[np.float32](3, "(size, size, 3) GGX alphas of the two lobes, and the share of the first.")
    coverage = _Map[np.uint8](1, "(size, size) 255 where a map had data; booleans become 0 and 255.")

    interrupted: str | None
    __hash__: ClassVar[None]  # type: ignore[assignment]

    def __init__(
        self,
        *,
        diffuse_albedo: ArrayLike | None = None,
        specular_albedo: ArrayLike | None = None,
        diffuse_normal: ArrayLike | None = None,
        specular_normal: ArrayLike | None = None,
        confidence: ArrayLike | None = None,
        roughness: ArrayLike | None = None,
        coverage: ArrayLike | None = None,
    ) -> None:
        """Each map as an array, or None. Raises ``errors.MapsError``."""
        self._arrays: dict[str, NDArray[Any]] = {}
        self.interrupted = None
        # The coverage is the first, because it selects the texels of the others that count.
        self["coverage"] = coverage
        self["diffuse_albedo"] = diffuse_albedo
        self["specular_albedo"] = specular_albedo
        self["diffuse_normal"] = diffuse_normal
        self["specular_normal"] = specular_normal
        self["confidence"] = confidence
        self["roughness"] = roughness

    @classmethod
    def read(cls, path: _Path) -> Maps:
        """Read whatever maps the folder has. Raises ``errors.MapsError``."""
        return cls._of(*_native.read_maps(path))

    @classmethod
    def _of(cls, arrays: dict[str, NDArray[Any]], interrupted: str | None) -> Maps:
        """Maps that the core has checked, without a copy; ``interrupted`` says where a solve was stopped."""
        maps = cls()
        for name, array in arrays.items():
            array.flags.writeable = False
            maps._arrays[name] = array
        maps.interrupted = interrupted
        return maps

    def write(self, path: _Path, *, light: ArrayLike | None = None) -> None:
        """Write the folder, completely or not at all; texels without coverage that hold no number become 0.

        ``light``, if the method recovers one, is written as ``light.exr``: radiance (rows, 2 rows, 3) of an environment
        at infinity, lat-long as ``truth/light.exr``, in the exposure in which the maps reproduce the photographs; the
        maps are then relit in it too. Raises ``errors.MapsError`` for a light of another shape or with NaN.
        """
        _native.write_maps(self._arrays, path, light)

    @property
    def size(self) -> int | None:
        """Texels along a side; None without any map."""
        return next((array.shape[0] for array in self._arrays.values()), None)

    def resize(self, side: int) -> Maps:
        """Return maps of ``side`` x ``side`` texels.

        A smaller map has the mean over each new texel's area, a larger one is interpolated linearly; texels without
        coverage have no weight. Normals keep the length 1. A new texel is covered where half of it was. Raises
        ``errors.MapsError`` for a side that is not from 1 to 16384.
        """
        if not 1 <= side <= 16384:
            raise MapsError(f"side is {side}; give a size from 1 to 16384 texels")
        size = self.size
        if size is None or side == size:
            return self._made()
        taps = _taps(size, side)
        coverage = self.coverage
        covered = np.ones((size, size), np.float32) if coverage is None else (coverage > 127).astype(np.float32)
        weight = taps @ covered @ taps.T
        maps: dict[str, NDArray[Any]] = {}
        for name, array in self._arrays.items():
            if name == "coverage":
                maps[name] = weight >= 0.5
                continue
            planes = array.reshape(size, size, -1)
            known = np.where(covered[..., None] > 0, planes, 0)
            sums = np.stack([taps @ known[..., c] @ taps.T for c in range(known.shape[-1])], -1)
            mean = sums / np.maximum(weight, 1e-6)[..., None]
            if name.endswith("_normal"):
                mean /= np.maximum(np.linalg.norm(mean, axis=-1, keepdims=True), 1e-6)
            maps[name] = mean.reshape(side, side, *array.shape[2:])
        return Maps(**maps)

    def keys(self) -> list[str]:
        """Return the names of the maps that there are."""
        return [name for name in NAMES if name in self._arrays]

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    def __len__(self) -> int:
        return len(self._arrays)

    def __contains__(self, name: object) -> bool:
        return name in self._arrays

    def __getitem__(self, name: str) -> NDArray[Any]:
        if name not in self._arrays:
            raise KeyError(f"{name!r} is not a map that there is; there are {', '.join(self.keys()) or 'none'}")
        return self._arrays[name].view()

    def __setitem__(self, name: str, value: ArrayLike | None) -> None:
        if name not in NAMES:
            raise KeyError(f"{name!r} cannot be a map; use one of {', '.join(NAMES)}")
        setattr(self, name, value)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Maps):
            return NotImplemented
        return self._arrays.keys() == other._arrays.keys() and all(
            np.array_equal(array, other._arrays[name], equal_nan=array.dtype != np.uint8)
            for name, array in self._arrays.items()
        )

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (dict(self._arrays), self.interrupted)

    def __repr__(self) -> str:
        if self.size is None:
            return "Maps(no map)"
        stopped = "" if self.interrupted is None else f"; stopped {self.interrupted}"
        return f"Maps({self.size} x {self.size}: {', '.join(self.keys())}{stopped})"

    def _repr_html_(self) -> str:
        from .thumbnails import of_maps

        return of_maps(repr(self), ((name, self[name]) for name in self))

    def _made(self) -> Maps:
        return _restored(dict(self._arrays), self.interrupted)

    def _set(self, name: str, channels: int, value: ArrayLike | None) -> None:
        array: NDArray[Any] | None = None
        if value is not None:
            array = _native.coverage_array(value) if name == "coverage" else _native.map_array(name, value)
            self._check_size(name, channels, array)
        covered: NDArray[Any] | None = array if name == "coverage" else self._arrays.get("coverage")
        checked: dict[str, NDArray[Any]] = self._arrays if name == "coverage" else {}
        if array is not None and name != "coverage":
            checked = {name: array}
        for other, values in checked.items():
            if other != "coverage":
                _check_finite(other, values, covered)
        if array is None:
            self._arrays.pop(name, None)
        else:
            array.flags.writeable = False
            self._arrays[name] = array

    def _check_size(self, name: str, channels: int, array: NDArray[Any]) -> None:
        side = next((other.shape[0] for key, other in self._arrays.items() if key != name), None)
        height, width = array.shape[:2]
        found = array.shape[2] if array.ndim > 2 else 1
        if width == height > 0 and found == channels and side in (None, width):
            return
        wanted = ", ".join([str(side or "size")] * 2 + [str(channels)] * (channels > 1))
        raise MapsError(f"{name}: has shape {array.shape}, expected ({wanted}); maps are square, of one size")


NAMES = tuple(name for name, value in vars(Maps).items() if isinstance(value, _Map))
"""The names of all maps."""


def _restored(arrays: dict[str, NDArray[Any]], interrupted: str | None) -> Maps:
    """Maps for pickles and copies; the arrays are theirs."""
    own = {name: array.copy() if array.flags.writeable else array for name, array in arrays.items()}
    return Maps._of(own, interrupted)  # pyright: ignore[reportPrivateUsage]


def _check_finite(name: str, array: NDArray[Any], coverage: NDArray[Any] | None) -> None:
    """Refuses a texel that has data and not a number in it."""
    wrong = ~np.isfinite(array.reshape(*array.shape[:2], -1))
    if coverage is not None:
        wrong &= (coverage > 127)[..., None]
    if not wrong.any():
        return
    row, column, channel = map(int, np.argwhere(wrong)[0])
    value = array.reshape(*array.shape[:2], -1)[row, column, channel]
    shown = "NaN" if np.isnan(value) else str(value)
    fix = "state by coverage= where there is data" if coverage is None else "take the texel out of the coverage"
    raise MapsError(f"{name}: is {shown} at column {column}, row {row}, channel {channel}; fix the texel, or {fix}")


def _taps(size: int, side: int) -> NDArray[np.float32]:
    """Weights (side, size) of the old texels of a row in the new: areas where it shrinks, else linear."""
    if side < size:
        edges = np.arange(side + 1) * size / side
        texels = np.arange(size)
        shared = np.minimum(edges[1:, None], texels + 1) - np.maximum(edges[:-1, None], texels)
        return np.asarray(np.maximum(shared, 0) * side / size, np.float32)
    centres = np.clip((np.arange(side) + 0.5) * size / side - 0.5, 0, size - 1)
    return np.asarray(np.maximum(1 - np.abs(centres[:, None] - np.arange(size)), 0), np.float32)


__all__ = ["NAMES", "Maps"]

"""Metrics that users write: `metric` makes one of a function, and a suite, `score` or the command line scores it."""

from __future__ import annotations

import hashlib
import importlib
import importlib.util
import json
import math
import os
import re
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from types import ModuleType
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from . import _native
from .errors import MetricError

Values = NDArray[np.float32]
Function = Callable[[Values, Values, NDArray[np.bool_]], float | None]
Subject = Literal[
    "view", "relit", "diffuse_albedo", "specular_albedo", "diffuse_normal", "specular_normal", "roughness"
]

SUBJECTS: tuple[Subject, ...] = (
    "view", "relit", "diffuse_albedo", "specular_albedo", "diffuse_normal", "specular_normal", "roughness",
)  # fmt: skip
"""Subjects that a metric can be scored of: pictures of withheld views, relit pictures, maps."""


@dataclass(frozen=True)
class OwnMetric:
    """A metric of a user; calling it calls the function."""

    id: str
    """As in rows of scores."""
    name: str
    unit: str
    """Empty for a pure number."""
    direction: Literal["higher", "lower", "one"]
    """Which values are better: higher ones, lower ones, those near one."""
    definition: str
    link: str
    of: tuple[Subject, ...]
    """Subjects that it is scored of."""
    function: Function = field(repr=False)

    def __call__(self, prediction: Values, truth: Values, mask: NDArray[np.bool_]) -> float | None:
        return self.function(prediction, truth, mask)

    def stated(self) -> dict[str, Any]:
        """Returns what scores state of it."""
        return {name: value for name, value in asdict(self).items() if name != "function"}


def metric(
    *,
    of: Subject | Sequence[Subject],
    direction: Literal["higher", "lower", "one"],
    unit: str = "",
    id: str | None = None,
    name: str | None = None,
    definition: str | None = None,
    link: str = "",
) -> Callable[[Function], OwnMetric]:
    """Make a metric of a function ``(prediction, truth, mask) -> float | None``.

    The function is called for every picture and map of the subjects ``of``: linear float32 arrays (height, width,
    3) or, of maps with one channel, (height, width), and a boolean mask (height, width) of the pixels that count,
    eroded once by 5 x 5. None says that it is not defined. A row of the scores is the mean over its pictures.

    ``id`` is the function's name, ``definition`` its docstring, without another; ``direction`` says which values
    are better: ``higher``, ``lower``, or near ``one``. Raises ``errors.MetricError`` for what cannot be.
    """
    subjects = (of,) if isinstance(of, str) else tuple(of)

    def decorate(function: Function) -> OwnMetric:
        own = getattr(function, "__name__", type(function).__name__)
        key = own if id is None else id
        words = definition if definition is not None else " ".join((function.__doc__ or own).split())
        made = OwnMetric(key, name or key, unit, direction, words, link, subjects, function)
        _check(made)
        return made

    return decorate


def _check(own: OwnMetric) -> None:
    def refuse(reason: str) -> MetricError:
        return MetricError(f"metric {own.id!r}: {reason}")

    if not re.fullmatch(r"[a-z0-9_]+", own.id):
        raise refuse("the id has other letters than a-z, 0-9 and _")
    if own.direction not in ("higher", "lower", "one"):
        raise refuse(f"direction is {own.direction!r}; use higher, lower or one")
    unknown = [subject for subject in own.of if subject not in SUBJECTS]
    if unknown or not own.of:
        raise refuse(f"of has {', '.join(map(repr, unknown)) or 'nothing'}; use some of {', '.join(SUBJECTS)}")
    if any(own.id == row[0] for row in _native.metric_definitions()):
        raise refuse("unshade has a metric of this id; choose another")


def found(names: Iterable[str | OwnMetric], folder: Path) -> tuple[list[OwnMetric], str]:
    """The metrics of these names, and a hash of their sources.

    A name is ``module:function``, ``file.py`` (all of its metrics) or ``file.py:function``, in ``folder``.
    Raises `MetricError`.
    """
    before = set(sys.modules)
    metrics: list[OwnMetric] = []
    files: set[Path] = set()
    for name in names:
        if isinstance(name, OwnMetric):
            metrics.append(name)
            continue
        place, _, function = name.rpartition(":") if re.search(r":[A-Za-z_]\w*$", name) else (name, "", "")
        module = _module(place, folder, name)
        if module.__file__:
            files.add(Path(module.__file__))
        metrics += _of_module(module, function, name)
    ids = [own.id for own in metrics]
    for own in metrics:
        if ids.count(own.id) > 1:
            raise MetricError(f"two metrics are called {own.id!r}; rename one")
    for module in (sys.modules[name] for name in set(sys.modules) - before):
        file = getattr(module, "__file__", None)
        if file and Path(file).resolve().is_relative_to(folder.resolve()):
            files.add(Path(file))
    sources = hashlib.sha256()
    for file in sorted(files):
        sources.update(file.name.encode() + b"\0" + file.read_bytes())
    return metrics, sources.hexdigest()


def _module(place: str, folder: Path, name: str) -> ModuleType:
    try:
        if not place.endswith(".py"):
            sys.path.insert(0, str(folder))
            try:
                return importlib.import_module(place)
            finally:
                sys.path.remove(str(folder))
        file = folder / place
        if not file.is_file():
            raise MetricError(f"{name}: there is no file {file}")
        spec = importlib.util.spec_from_file_location(f"unshade_metrics_{file.stem}", file)
        if spec is None or spec.loader is None:
            raise MetricError(f"{name}: {file} is not a Python file")
        module = importlib.util.module_from_spec(spec)
        sys.modules[spec.name] = module
        spec.loader.exec_module(module)
    except MetricError:
        raise
    except Exception as error:
        raise MetricError(f"{name}: cannot be imported: {type(error).__name__}: {error}") from error
    return module


def _of_module(module: ModuleType, function: str, name: str) -> list[OwnMetric]:
    own = {key: value for key, value in vars(module).items() if isinstance(value, OwnMetric)}
    if not function:
        if not own:
            raise MetricError(f"{name}: has no metric; write @unshade.metric(...) above a function")
        return list(own.values())
    if function not in own:
        what = "is not a metric; write @unshade.metric(...) above it" if hasattr(module, function) else "is missing"
        raise MetricError(f"{name}: {function} {what}; there are {', '.join(own) or 'none'}")
    return [own[function]]


def measured(own: OwnMetric, shown: Sequence[Mapping[str, Any]]) -> list[float | None]:
    """The metric of each of the pictures and maps (`_native.shown_json`) among its subjects.

    Raises `MetricError` for a value that is not a number, and names the function that raised.
    """
    return [_value(own, pair) for pair in shown if pair["subject"] in own.of]


def _value(own: OwnMetric, pair: Mapping[str, Any]) -> float | None:
    prediction, truth, mask = _arrays(pair)
    where = "/".join(filter(None, (pair["subject"], pair["light"], pair["frame"])))
    try:
        value = own(prediction, truth, mask)
    except Exception as error:
        trace = error.__traceback__
        while trace is not None and trace.tb_next is not None:
            trace = trace.tb_next
        at = "" if trace is None else f"{trace.tb_frame.f_code.co_filename}:{trace.tb_lineno}: "
        raise MetricError(f"{at}metric {own.id!r} raised {type(error).__name__} for {where}: {error}") from error
    if value is None:
        return None
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not math.isfinite(number):
        raise MetricError(f"metric {own.id!r} returned {value!r} for {where}; return a finite number or None")
    return number


def _arrays(pair: Mapping[str, Any]) -> tuple[Values, Values, NDArray[np.bool_]]:
    ndimage: Any = importlib.import_module("scipy.ndimage")
    names = {"specular_albedo": ["Y"], "roughness": None}.get(pair["subject"], ["R", "G", "B"])
    colour = pair["subject"] in ("view", "relit", "diffuse_albedo")
    prediction, truth = (
        np.nan_to_num(_native.read_exr(pair[which], names, colour=colour, finite=False)[1])
        for which in ("picture", "truth")
    )
    mask: NDArray[np.bool_] = ndimage.binary_erosion(_native.read_gray(pair["mask"]) > 127, np.ones((5, 5)))
    if prediction.shape != truth.shape:
        # A map of another size, linearly at the true map's texel centres, as unshade's own metrics take it.
        centres: list[NDArray[np.float64]] = [
            (np.arange(new) + 0.5) * old / new - 0.5 for new, old in zip(truth.shape[:2], prediction.shape[:2])
        ]
        places = np.meshgrid(*centres, indexing="ij")
        planes = [ndimage.map_coordinates(prediction[..., c], places, order=1, mode="nearest")
                  for c in range(prediction.shape[2])]  # fmt: skip
        prediction = np.stack(planes, -1)
    prediction = np.asarray(prediction * pair["factor"], np.float32)
    if truth.shape[2] == 1:
        prediction, truth = prediction[..., 0], truth[..., 0]
    return np.asarray(prediction, np.float32), np.asarray(truth, np.float32), mask


def rows(
    metrics: Sequence[str | OwnMetric], capture: os.PathLike[str] | str, maps: os.PathLike[str] | str,
    relit: os.PathLike[str] | str | None, factor: float | None,
) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:  # fmt: skip
    """The statements of metrics and their rows, as scores hold them. Raises `MetricError`."""
    chosen = found(metrics, Path.cwd())[0]
    shown = json.loads(_native.shown_json(capture, maps, relit, factor))
    made: list[dict[str, Any]] = []
    for own in chosen:
        pairs = [pair for pair in shown if pair["subject"] in own.of]
        stated = json.dumps(own.stated())
        made += json.loads(_native.judged_rows_json(capture, json.dumps(pairs), stated, measured(own, pairs)))
    return [own.stated() for own in chosen], made


def answer(request: Mapping[str, Any]) -> dict[str, Any]:
    """Answers a suite's request: the statements of its metrics, a hash of their sources, and the values of ``pairs``."""
    metrics, key = found(request["names"], Path(request["folder"]))
    values = [measured(own, request["pairs"]) for own in metrics]
    return {"metrics": [own.stated() for own in metrics], "key": key, "values": values}

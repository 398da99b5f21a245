"""Every metric as a function: ``unshade.metrics.psnr_srgb(prediction, truth, mask)``.

``prediction`` and ``truth`` are float32 (height, width, channels) or (height, width), linear;
``mask`` is boolean. ``erode=True`` shrinks the mask once by 5 x 5. ``scale`` fits a factor on the
prediction first: ``none``, ``global``, ``channel`` or ``median``. The result is None where a
metric is not defined, such as a correlation with a constant.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from unshade._native import measure as _measure
from unshade._native import metric_definitions as _metric_definitions


class Definition(NamedTuple):
    """What a metric is."""

    id: str
    name: str
    unit: str
    direction: str
    definition: str
    link: str


DEFINITIONS: dict[str, Definition] = {
    row[0]: Definition(*row) for row in _metric_definitions()
}


def _function(definition: Definition) -> Callable[..., float | None]:
    def metric(prediction, truth, mask=None, *, erode=False, scale="none"):
        return _measure(definition.id, prediction, truth, mask, erode=erode, scale=scale)

    metric.__name__ = metric.__qualname__ = definition.id
    metric.__doc__ = f"{definition.name} [{definition.unit}]: {definition.definition}"
    return metric


globals().update({name: _function(row) for name, row in DEFINITIONS.items()})
__all__ = ["DEFINITIONS", "Definition", *DEFINITIONS]

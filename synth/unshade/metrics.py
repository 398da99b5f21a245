"""Every metric as a function: ``unshade.metrics.psnr_srgb(prediction, truth, mask)``.

``prediction`` and ``truth`` are linear, (height, width, channels) or (height, width), of float or
nested lists; they are compared as float32. ``mask`` selects the pixels that count: booleans, zeros and
ones, or 0 to 255, of which values above 127 do. Pixels outside the mask may hold anything, NaN too.
``erode=True`` shrinks the mask (without one, the whole picture) once by 5 x 5. ``scale`` fits a
factor on the prediction first: ``none``, ``global``, ``channel`` or ``median``.

Some metrics compare with more, a keyword each: ``labels`` (height, width), region ids from 0 to 255;
``shading`` and ``specular``, the true diffuse shading and specular layer, as pictures; ``confidence``
(height, width), larger for more trust; ``deviation``, the stated standard deviation of every value.

:func:`evaluate` computes many of one pair at once, on all cores, and what they share once.

``lpips_...`` need the extra ``lpips`` (PyTorch), and pictures of 32 pixels a side or more.

The result is None where a metric is not defined, such as a correlation with a constant. Arrays that
cannot be meant raise :class:`unshade.errors.MetricError`, which names the argument.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from inspect import Parameter, Signature
from typing import NamedTuple

from unshade._native import measure as _measure
from unshade._native import metric_definitions as _metric_definitions
from unshade.perceptual import NETS
from unshade.perceptual import distance as _lpips


class Definition(NamedTuple):
    """Id, words, unit and direction of a metric; ``needs`` names an argument beside the mask, or is empty."""

    id: str
    name: str
    unit: str
    direction: str
    definition: str
    link: str
    needs: str


_NETS = {f"lpips_{net}_0_1": net for net in NETS}

DEFINITIONS: dict[str, Definition] = {row[0]: Definition(*row) for row in _metric_definitions()}


def evaluate(
    names: Iterable[str], prediction, truth, mask=None, *, erode=False, scale="none", **beside
) -> dict[str, float | None]:  # fmt: skip
    """The metrics ``names`` of one pair, by name; arguments as those of each, which get what they need of ``beside``.

    On all cores, and what several need is computed once: much faster than a call for each. The values are the same.
    """
    names = list(names)
    known = {definition.needs for definition in DEFINITIONS.values()} - {""}
    for name in beside:
        if name not in known:
            raise TypeError(f"evaluate() got an unexpected keyword argument {name!r}")
    own = [name for name in names if name not in _NETS]
    pair = (prediction, truth, mask)
    values = dict(zip(own, _measure(own, *pair, erode=erode, scale=scale, beside=beside), strict=True))
    return {
        name: _lpips(_NETS[name], *pair, erode=erode, scale=scale) if name in _NETS else values[name]
        for name in names
    }  # fmt: skip


def _function(definition: Definition) -> Callable[..., float | None]:
    needs = definition.needs

    def metric(prediction, truth, mask=None, *, erode=False, scale="none", **beside):
        for name in beside:
            if name != needs:
                raise TypeError(f"{definition.id}() got an unexpected keyword argument {name!r}")
        if definition.id in _NETS:
            return _lpips(_NETS[definition.id], prediction, truth, mask, erode=erode, scale=scale)
        return _measure(
            [definition.id], prediction, truth, mask, erode=erode, scale=scale, beside=beside
        )[0]  # fmt: skip

    parameters = [
        Parameter("prediction", Parameter.POSITIONAL_OR_KEYWORD),
        Parameter("truth", Parameter.POSITIONAL_OR_KEYWORD),
        Parameter("mask", Parameter.POSITIONAL_OR_KEYWORD, default=None),
        *([Parameter(needs, Parameter.KEYWORD_ONLY)] if needs else []),
        Parameter("erode", Parameter.KEYWORD_ONLY, default=False),
        Parameter("scale", Parameter.KEYWORD_ONLY, default="none"),
    ]
    metric.__signature__ = Signature(parameters)
    metric.__name__ = metric.__qualname__ = definition.id
    unit = f" [{definition.unit}]" if definition.unit else ""
    metric.__doc__ = f"{definition.name}{unit}: {definition.definition}"
    return metric


globals().update({name: _function(row) for name, row in DEFINITIONS.items()})
__all__ = ["DEFINITIONS", "Definition", "evaluate", *DEFINITIONS]

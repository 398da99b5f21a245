"""Names of views: what a user may call a photograph, and which view that is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from ..errors import CaptureError
from .source import Source, SourceView

_DEPTH = 6
"""Parts of a photograph's path that may distinguish it from others."""

_NAMED = 8
"""Views that a message names."""


def tails(picture: Path) -> list[str]:
    """The ends of a photograph's path, whole names, the longest first: ``a/cam1/1.jpg``, ``cam1/1.jpg``, ``1.jpg``."""
    parts = picture.parts[-_DEPTH:]
    return ["/".join(parts[start:]) for start in range(len(parts))]


def without_ending(name: str) -> str:
    """A name or path without the ending of its file."""
    head, dot, ending = name.rpartition(".")
    return head if dot and head and "/" not in ending else name


def short_names(views: Sequence[SourceView]) -> list[str]:
    """The shortest end of each photograph's path that only it has, as far as one has."""
    counts: dict[str, int] = {}
    for view in views:
        for tail in tails(view.picture):
            counts[tail] = counts.get(tail, 0) + 1
    return [next((t for t in reversed(tails(v.picture)) if counts[t] == 1), str(v.picture)) for v in views]


def listed(names: Sequence[str]) -> str:
    """Names for a message, as many as fit."""
    return ", ".join(names[:_NAMED]) + (f" and {len(names) - _NAMED} more" if len(names) > _NAMED else "")


def named_views(source: Source, names: Sequence[str], option: str) -> set[str]:
    """The views that ``names`` are: names of views, or ends of their photographs' paths with or without the file's
    ending. Raises `CaptureError` for a name of several views, or of none; ``option`` is the one that names came by.
    """
    found: set[str] = set()
    for name in names:
        plain = "/".join(part for part in name.replace("\\", "/").split("/") if part not in ("", "."))
        matching = [view for view in source.views if plain == view.name or _is_end(plain, view.picture)]
        if not matching:
            there = listed([view.name for view in source.views])
            raise CaptureError(f"{option}: there is no view {name!r}; there are {there}")
        if len(matching) > 1:
            raise CaptureError(
                f"{option}: {name!r} could be {' or '.join(short_names(matching))}; state the path, such as "
                f"{short_names(matching)[0]}"
            )
        found.add(matching[0].name)
    return found


def without(source: Source, names: set[str], reason: str) -> Source:
    """The source without the views of these names, which it lists as left out. Raises `CaptureError` if none is left."""
    views = tuple(view for view in source.views if view.name not in names)
    if not views:
        raise CaptureError(f"{source.origin}: all {len(names)} views are left out ({reason}); keep some")
    gone = tuple((view.name, reason) for view in source.views if view.name in names)
    withheld = tuple(name for name in source.withheld if name not in names)
    return replace(source, views=views, withheld=withheld, left_out=(*source.left_out, *gone))


def _is_end(name: str, picture: Path) -> bool:
    return any(name in (tail, without_ending(tail)) for tail in tails(picture))


def withheld_views(source: Source, holdout: int | tuple[str, ...] | None) -> set[str]:
    """The names of the views that are set aside: those that the file states, every ``holdout``-th, or those named.
    Raises `CaptureError`."""
    names = [view.name for view in source.views]
    if holdout is None:
        withheld = set(source.withheld)
    elif isinstance(holdout, int):
        withheld = set(names[holdout - 1 :: holdout])
        if not withheld:
            raise CaptureError(f"holdout is {holdout}, but there are {len(names)} views; state at most {len(names)}")
    else:
        withheld = named_views(source, holdout, "holdout")
    if len(withheld) >= len(names):
        raise CaptureError(f"{source.origin}: all {len(names)} views are withheld; leave some to train on")
    return withheld

"""The summary of an import: its last line, also in ``import.json``."""

from __future__ import annotations

from statistics import median

from .photographs import ImportedView
from .source import Source
from .view_names import listed


def summary(views: int, stated: int, upright: str, masks: str, overlap: float | None) -> str:
    """The last line of an import of ``views`` of the ``stated`` views of a file. ``upright`` is how the head
    was found upright, ``masks`` where they are from; ``overlap`` is the median intersection over union of silhouettes and
    masks, None where the masks are the silhouettes themselves or have no outline.
    """
    if overlap is not None:
        fit = f"silhouettes overlap {overlap:.2f}"
    else:
        what = "are the mesh's silhouette" if masks == "silhouette" else "have no outline"
        fit = f"masks {what}, so the fit of the cameras is unchecked"
    return f"imported {views} of {stated} views, {upright}, {fit}"


def left_out_by_reason(source: Source) -> list[str]:
    """A line for each reason for which views are left out, with the count and the names."""
    names: dict[str, list[str]] = {}
    for name, reason in source.left_out:
        names.setdefault(reason, []).append(name)
    stated = len(source.views) + len(source.left_out)
    return [f"left out {len(some)} of {stated} views, {listed(some)}: {reason}" for reason, some in names.items()]


class ViewStatistics:
    """Metadata of the photographs and the overlap of each silhouette with its mask, collected as views are read."""

    def __init__(self) -> None:
        self.curves: set[str] = set()
        self.profiles: set[str] = set()
        self.overlaps: dict[str, float] = {}
        self._exposures: list[float] = []
        self._unmasked: list[str] = []

    def note(self, taken: ImportedView, overlap: float | None) -> None:
        self.curves.add(taken.photograph.curve)
        self.profiles.add(taken.photograph.profile or "none: Rec.709 primaries are assumed")
        if taken.photograph.exposure is not None:
            self._exposures.append(taken.photograph.exposure)
        if taken.mask is not None and not taken.mask.any():
            self._unmasked.append(taken.name)
        if overlap is not None:
            self.overlaps[taken.name] = round(overlap, 4)

    @property
    def overlap(self) -> float | None:
        """Median over the views with informative masks, None without one."""
        return round(median(self.overlaps.values()), 4) if self.overlaps else None

    def below(self, least: float) -> dict[str, float]:
        """The views whose overlap is less, the worst first."""
        ordered = sorted(self.overlaps.items(), key=lambda item: item[1])
        return {name: overlap for name, overlap in ordered if overlap < least}

    def notes(self, *, even: bool) -> set[str]:
        notes: set[str] = set()
        if not even and self._exposures and max(self._exposures) > 1.05 * min(self._exposures):
            factor = max(self._exposures) / min(self._exposures)
            notes.add(f"exposures differ by a factor of {factor:.3g} between views; even_exposure divides by them")
        if self._unmasked:
            notes.add(f"no face in the masks of {', '.join(self._unmasked)}")
        return notes

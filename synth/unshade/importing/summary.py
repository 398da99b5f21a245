"""The facts that an import states of itself: its last line, and the same in ``import.json``."""

from __future__ import annotations

from .photographs import Taken


def summary(views: int, stated: int, upright: str, overlap: float | None) -> str:
    """The last line of an import of ``views`` of the ``stated`` views of a file. ``upright`` says by what the head
    is upright; ``overlap`` is the median intersection over union of silhouettes and masks, None where the masks
    are the silhouettes themselves.
    """
    fit = (
        "masks are the mesh's silhouette, so nothing tells whether the cameras fit"
        if overlap is None
        else f"silhouettes overlap {overlap:.2f}"
    )
    return f"imported {views} of {stated} views, {upright}, {fit}"


class Sightings:
    """Metadata of the photographs, collected as they are read."""

    def __init__(self) -> None:
        self.curves: set[str] = set()
        self.profiles: set[str] = set()
        self._exposures: list[float] = []
        self._unmasked: list[str] = []

    def note(self, taken: Taken) -> None:
        self.curves.add(taken.photograph.curve)
        self.profiles.add(taken.photograph.profile or "none: Rec.709 primaries are assumed")
        if taken.photograph.exposure is not None:
            self._exposures.append(taken.photograph.exposure)
        if taken.mask is None or not taken.mask.any():
            self._unmasked.append(taken.name)

    def notes(self, *, even: bool) -> set[str]:
        notes: set[str] = set()
        if not even and self._exposures and max(self._exposures) > 1.05 * min(self._exposures):
            factor = max(self._exposures) / min(self._exposures)
            notes.add(f"exposures differ by a factor of {factor:.3g} between views; even_exposure divides by them")
        if self._unmasked:
            notes.add(f"no face in the masks of {', '.join(self._unmasked)}")
        return notes

"""The choices of an import, which decide what its files leave open."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ..errors import CaptureError
from ..stated_light import LIGHT_FRAMES
from .pictures import check_curve
from .placement import PLACES, UNITS
from .uv_choice import UVS

HULL = "hull"
"""The mesh that is carved from the masks."""

MASKS = ("alpha", "silhouette", "grabcut")
"""Masks that no file holds."""


@dataclass(frozen=True)
class Choices:
    """The choices that files leave open; the fields are those of `import_capture`."""

    mesh: Path | str | None = None
    objects: tuple[str, ...] = ()
    uv: str = "auto"
    pictures: Path | None = None
    masks: Path | str | None = None
    labels: Path | None = None
    parser: str | None = None
    curve: str = "auto"
    brackets: int = 1
    even_exposure: bool = False
    unknown_exposure: bool = False
    frames: int | None = None
    holdout: int | tuple[str, ...] | None = None
    shrink: int = 1
    unit: str | None = None
    place: str = "auto"
    front: str | None = None
    apply: bool = False
    skip_missing: bool = False
    leave_out: tuple[str, ...] = ()
    light_frame: str | None = None

    def check(self) -> None:
        """Refuses values out of range. Raises `CaptureError` or `PictureError`."""
        check_curve(self.curve)
        if self.unit is not None and self.unit not in UNITS:
            raise CaptureError(f"unit {self.unit!r} is unknown; there are {', '.join(UNITS)}")
        if self.light_frame is not None and self.light_frame not in LIGHT_FRAMES:
            raise CaptureError(f"light_frame {self.light_frame!r} is unknown; there are {', '.join(LIGHT_FRAMES)}")
        if self.uv not in UVS:
            raise CaptureError(f"uv {self.uv!r} is unknown; there are {', '.join(UVS)}")
        if self.place not in PLACES:
            raise CaptureError(f"place {self.place!r} is unknown; there are {', '.join(PLACES)}")
        for name, value, maximum in (("brackets", self.brackets, 32), ("shrink", self.shrink, 64)):
            if not 1 <= value <= maximum:
                raise CaptureError(f"{name} is {value}; it must be from 1 to {maximum}")
        if self.frames is not None and self.frames < 3:
            raise CaptureError(f"frames is {self.frames}; a capture needs at least three")
        if self.unknown_exposure and self.even_exposure:
            raise CaptureError("unknown_exposure is for exposures that no file states; leave it or even_exposure out")
        if isinstance(self.holdout, int) and self.holdout < 2:
            raise CaptureError(f"holdout is {self.holdout}; every second view is the most that can be withheld")
        if self.labels is not None and self.parser is None:
            raise CaptureError("labels need the parser that made them; state its name or a JSON file of names by id")
        if self.mesh == HULL and self.masks == "silhouette":
            raise CaptureError(
                "mesh hull is carved from masks, so masks cannot be its silhouette; name masks or grabcut"
            )
        for folder in (self.masks, self.labels, self.pictures):
            if isinstance(folder, Path) and not folder.is_dir():
                raise CaptureError(f"{folder}: is not a folder; name one, or of masks {', '.join(MASKS)}")

"""The `[image_formation]` table."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ..errors import SceneError
from ..tables import Table, changes, numbers, one_of, read, real, vector


@dataclass(frozen=True)
class Formation:
    """How a camera turns radiance into the picture that solvers get; all off by default.

    The picture stays linear radiance in the scene's own units: what the sensor recorded is
    decoded and divided by the exposure, as a calibrated photograph would be read.
    """

    exposure_stops: float = real(0.0, -16, 16)
    """Light on the sensor, in powers of two: moves clipping, noise and code values."""
    white_level: float | None = real(None, high=1e6, above=0)
    """Exposed radiance at which a pixel saturates; ``None`` never does."""
    full_well_electrons: float | None = real(None, high=1e9, above=0)
    """Electrons at the white level: their counting is the shot noise; ``None`` is without."""
    read_noise_electrons: float = real(0.0, 0, 1e6)
    """Standard deviation of the noise that reading adds to every pixel."""
    bits: int | None = one_of(8, 16, default=None)
    """8 or 16 bits a channel, code 0 at black and the largest at the white level."""
    transfer: str = one_of("srgb", "linear")
    """``srgb`` or ``linear``: how code values are spaced."""
    brackets_stops: tuple[float, ...] | None = numbers("2 to 9 different numbers, as [-2, 0, 2]", 2, 9, -16, 16)
    """Exposures relative to ``exposure_stops``, in powers of two, whose pictures are merged to one of high dynamic
    range (`formation.brackets`); ``None`` is one exposure."""
    motion_pixels: float = real(0.0, 0, 1000)
    """Length of the streak that a point in the middle of the picture leaves (pixels)."""
    motion_degrees: float = real(0.0, 0, 30)
    """Turn of the camera while the shutter is open (degrees), in place of ``motion_pixels``."""
    motion_direction_degrees: float | None = real(None)
    """Direction of the streak, from right towards up; ``None`` draws one for every view."""
    aperture_radius_mm: float = real(0.0, 0, 100)
    """Radius of the thin lens; 0 is a pinhole, sharp everywhere."""
    focus_distance_metres: float | None = real(None, high=1e6, above=0)
    """Distance along the optical axis of what is sharp; ``None`` is the plane of the eyes."""
    lens_distortion: tuple[float, float, float, float] | None = vector(None, "four numbers [k1, k2, p1, p2]", 4)
    """k1, k2, p1, p2 of OpenCV's model in all training views."""
    pose_noise_pixels: float = real(0.0, 0, 100)
    """Error of the stated poses: rms displacement of the mesh in the picture, per axis."""
    pose_noise_degrees: float = real(0.0, 0, 10)
    """Error of the stated poses: standard deviation of the turn about each camera axis."""
    pose_noise_mm: float = real(0.0, 0, 100)
    """Error of the stated poses: standard deviation of the shift along each camera axis."""

    gain_stops: float = real(0.0, 0, 4)
    """Automatic exposure: standard deviation, in powers of two, of a factor on each training picture that is stated
    nowhere; the capture says that exposures are unknown."""
    white_balance_stops: float = real(0.0, 0, 2)
    """Automatic white balance: the same of the red and of the blue channel beside it."""

    @property
    def hides_exposure(self) -> bool:
        """Whether training pictures have unknown factors."""
        return self.gain_stops > 0 or self.white_balance_stops > 0

    def to_table(self) -> dict[str, Any]:
        """Keys that differ from the defaults, with their values, as the scene file has them."""
        return changes(self)


def parse_formation(values: Mapping[str, Any], place: str) -> Formation:
    table = Table(values, place)
    formation = read(Formation, table)
    _require_sense(formation, table)
    return formation


def _require_sense(formation: Formation, table: Table) -> None:
    """Refuses keys that would do nothing, or twice the same."""

    def needs(key: str, other: str, given: bool, example: str) -> None:
        if key in table and not given:
            raise table.wrong(key, f"does nothing without {other}; write {other} = {example}")

    white = formation.white_level is not None
    needs("full_well_electrons", "white_level", white, "1.0")
    needs("bits", "white_level", white, "1.0")
    needs("read_noise_electrons", "full_well_electrons", formation.full_well_electrons is not None, "20000")
    needs("exposure_stops", "white_level", white, "1.0")
    needs("transfer", "bits", formation.bits is not None, "8")
    needs("brackets_stops", "bits", formation.bits is not None, "8")
    moves = formation.motion_pixels > 0 or formation.motion_degrees > 0
    needs("motion_direction_degrees", "motion_pixels", moves, "2.0")
    needs("focus_distance_metres", "aperture_radius_mm", formation.aperture_radius_mm > 0, "2.0")
    if formation.motion_pixels and formation.motion_degrees:
        raise SceneError(
            f"motion_pixels and motion_degrees in {table.place} say the same thing; keep one", key="motion_pixels"
        )
    if formation.pose_noise_pixels and (formation.pose_noise_degrees or formation.pose_noise_mm):
        raise SceneError(
            f"pose_noise_pixels in {table.place} stands for pose_noise_degrees and pose_noise_mm; keep it or them",
            key="pose_noise_pixels",
        )

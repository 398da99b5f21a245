"""The `[image_formation]` table."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any

from ..errors import SceneError
from .checks import choice, known_keys, number

TRANSFERS = ("srgb", "linear")
BITS = (8, 16)


@dataclass(frozen=True)
class Formation:
    """How a camera turns radiance into the picture that solvers get; all off by default.

    The picture stays linear radiance in the scene's own units: what the sensor recorded is
    decoded and divided by the exposure, as a calibrated photograph would be read.
    """

    exposure_stops: float = 0.0
    """Light on the sensor, in powers of two: moves clipping, noise and code values."""
    white_level: float | None = None
    """Exposed radiance at which a pixel saturates; ``None`` never does."""
    full_well_electrons: float | None = None
    """Electrons at the white level: their counting is the shot noise; ``None`` is without."""
    read_noise_electrons: float = 0.0
    """Standard deviation of the noise that reading adds to every pixel."""
    bits: int | None = None
    """8 or 16 bits a channel, code 0 at black and the largest at the white level."""
    transfer: str = "srgb"
    """``srgb`` or ``linear``: how code values are spaced."""
    motion_pixels: float = 0.0
    """Length of the streak that a point in the middle of the picture leaves (pixels)."""
    motion_degrees: float = 0.0
    """Turn of the camera while the shutter is open (degrees), in place of ``motion_pixels``."""
    motion_direction_degrees: float | None = None
    """Direction of the streak, from right towards up; ``None`` draws one for every view."""
    aperture_radius_mm: float = 0.0
    """Radius of the thin lens; 0 is a pinhole, sharp everywhere."""
    focus_distance_metres: float | None = None
    """Distance along the optical axis of what is sharp; ``None`` is the plane of the eyes."""
    lens_distortion: tuple[float, float, float, float] | None = None
    """k1, k2, p1, p2 of OpenCV's model in all training views."""
    pose_noise_pixels: float = 0.0
    """Error of the stated poses: rms displacement of the mesh in the picture, per axis."""
    pose_noise_degrees: float = 0.0
    """Error of the stated poses: standard deviation of the turn about each camera axis."""
    pose_noise_mm: float = 0.0
    """Error of the stated poses: standard deviation of the shift along each camera axis."""

    def to_table(self) -> dict[str, Any]:
        """Keys that differ from the defaults, with their values, as the scene file has them."""
        return {key: value for key, value in asdict(self).items() if value != getattr(Formation(), key)}


def parse_formation(table: Mapping[str, Any], place: str) -> Formation:
    known_keys(table, [field.name for field in fields(Formation)], place)
    formation = Formation(
        exposure_stops=_between(table, "exposure_stops", place, 0.0, -16, 16),
        white_level=_positive(table, "white_level", place),
        full_well_electrons=_positive(table, "full_well_electrons", place, 1e9),
        read_noise_electrons=_between(table, "read_noise_electrons", place, 0.0, 0, 1e6),
        bits=_bits(table, place),
        transfer=choice(table, "transfer", TRANSFERS, place) if "transfer" in table else Formation.transfer,
        motion_pixels=_between(table, "motion_pixels", place, 0.0, 0, 1000),
        motion_degrees=_between(table, "motion_degrees", place, 0.0, 0, 30),
        motion_direction_degrees=_optional(table, "motion_direction_degrees", place),
        aperture_radius_mm=_between(table, "aperture_radius_mm", place, 0.0, 0, 100),
        focus_distance_metres=_positive(table, "focus_distance_metres", place),
        lens_distortion=_distortion(table, place),
        pose_noise_pixels=_between(table, "pose_noise_pixels", place, 0.0, 0, 100),
        pose_noise_degrees=_between(table, "pose_noise_degrees", place, 0.0, 0, 10),
        pose_noise_mm=_between(table, "pose_noise_mm", place, 0.0, 0, 100),
    )
    _require_sense(formation, table, place)
    return formation


def _require_sense(formation: Formation, table: Mapping[str, Any], place: str) -> None:
    """Refuses keys that would do nothing, or twice the same."""

    def needs(key: str, other: str, given: bool, example: str) -> None:
        if key in table and not given:
            raise SceneError(f"{key} in {place} does nothing without {other}; write {other} = {example}")

    white = formation.white_level is not None
    needs("full_well_electrons", "white_level", white, "1.0")
    needs("bits", "white_level", white, "1.0")
    needs("read_noise_electrons", "full_well_electrons", formation.full_well_electrons is not None, "20000")
    needs("exposure_stops", "white_level", white, "1.0")
    needs("transfer", "bits", formation.bits is not None, "8")
    moves = formation.motion_pixels > 0 or formation.motion_degrees > 0
    needs("motion_direction_degrees", "motion_pixels", moves, "2.0")
    needs("focus_distance_metres", "aperture_radius_mm", formation.aperture_radius_mm > 0, "2.0")
    if formation.motion_pixels and formation.motion_degrees:
        raise SceneError(f"motion_pixels and motion_degrees in {place} say the same thing; keep one")
    if formation.pose_noise_pixels and (formation.pose_noise_degrees or formation.pose_noise_mm):
        raise SceneError(
            f"pose_noise_pixels in {place} stands for pose_noise_degrees and pose_noise_mm; keep it or them"
        )


def _between(table: Mapping[str, Any], key: str, place: str, default: float, low: float, high: float) -> float:
    value = number(table, key, place, default)
    if not low <= value <= high:
        raise SceneError(f"{key} in {place} is {value:g}; use a number from {low:g} to {high:g}")
    return value


def _optional(table: Mapping[str, Any], key: str, place: str) -> float | None:
    return number(table, key, place, 0.0) if key in table else None


def _positive(table: Mapping[str, Any], key: str, place: str, maximum: float = 1e6) -> float | None:
    if key not in table:
        return None
    value = number(table, key, place, 0.0, above=0.0)
    if value > maximum:
        raise SceneError(f"{key} in {place} is {value:g}; use at most {maximum:g}")
    return value


def _bits(table: Mapping[str, Any], place: str) -> int | None:
    bits = table.get("bits")
    if bits is not None and (isinstance(bits, bool) or bits not in BITS):
        raise SceneError(f"bits in {place} is {bits!r}; use 8 or 16")
    return None if bits is None else int(bits)


def _distortion(table: Mapping[str, Any], place: str) -> tuple[float, float, float, float] | None:
    if "lens_distortion" not in table:
        return None
    terms = table["lens_distortion"]
    fine = isinstance(terms, (list, tuple)) and len(terms) == 4
    if not fine or not all(isinstance(t, (int, float)) and not isinstance(t, bool) and math.isfinite(t) for t in terms):
        raise SceneError(f"lens_distortion in {place} is {terms!r}; use four numbers [k1, k2, p1, p2]")
    return tuple(float(term) for term in terms)

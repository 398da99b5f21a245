"""Photographs as linear Rec.709 radiance: PNG, JPEG, TIFF, WebP, EXR and Radiance files."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from fractions import Fraction
from io import BytesIO
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageCms, UnidentifiedImageError

from .. import _native
from ..errors import PictureError
from ..srgb import decoded
from .colour_space import ADOBE_RGB, ADOBE_TO_REC709, exif_colour_space
from .orientation import ORIENTATION, as_stored

Floats = NDArray[np.float32]

CURVES = ("auto", "srgb", "linear", "rec709", "gamma=<number>")
"""Names of transfer curves."""

_RAW = (
    ".3fr",
    ".arw",
    ".cr2",
    ".cr3",
    ".crw",
    ".dng",
    ".iiq",
    ".nef",
    ".nrw",
    ".orf",
    ".pef",
    ".raf",
    ".raw",
    ".rw2",
    ".srw",
    ".x3f",
)
_RADIANCE = (".exr", ".hdr")
_READ = (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp")

_MAX_PIXELS = 1 << 28

_EXPOSURE_TIME, _F_NUMBER, _ISO, _EXIF, _PROFILE = 0x829A, 0x829D, 0x8827, 0x8769, 0x8773

_NAMED_CURVES = (
    ("linear", "linear"),
    ("g10", "linear"),
    ("srgb", "srgb"),
    ("s rgb", "srgb"),
    ("display p3", "srgb"),
    ("adobe rgb", "gamma=2.19921875"),
    ("prophoto", "gamma=1.8"),
    ("romm", "gamma=1.8"),
    ("709", "rec709"),
)
"""Parts of an ICC profile's name, and the curve of each."""

_SAME_PRIMARIES = 2e-3
"""How far a profile's primaries may be from Rec.709's and still be these: profiles are rounded."""


@dataclass(frozen=True)
class Photograph:
    """A picture as stored, EXIF orientation not applied.

    ``radiance`` [H, W, 3] float32, linear Rec.709; ``alpha`` [H, W] 0 to 1. ``profile`` is the name of its colour
    space, None where neither a profile nor EXIF states it. ``exposure`` is what the camera let through,
    time x ISO / f-number², where the file states it; ``codes`` are the 8-bit values [H, W, 3] (R, G, B) where that
    is what it holds. ``colour_warning`` is what EXIF leaves open about its colours, in words.
    """

    radiance: Floats
    alpha: Floats | None
    orientation: int
    curve: str
    profile: str | None
    exposure: float | None
    codes: NDArray[np.uint8] | None
    colour_warning: str | None = None


@dataclass(frozen=True)
class Plane:
    """A mask's or label picture's ``values`` [H, W] as stored, and the EXIF ``orientation`` that its file states."""

    values: NDArray[Any]
    orientation: int


@dataclass(frozen=True)
class _Header:
    """Metadata of a file: its size as stored (pixels), EXIF orientation, ICC profile, gamma of a PNG, exposure,
    and the colour space that EXIF states with the grounds for it."""

    width: int
    height: int
    orientation: int
    icc: bytes | None
    gamma: float | None
    exposure: float | None
    space: tuple[str | None, str]


def orientation_and_size(path: Path) -> tuple[int, int, int]:
    """The EXIF orientation, width and height (pixels, as stored) of a photograph. Raises `PictureError`."""
    if path.suffix.lower() not in _READ:
        radiance = read_photograph(path).radiance
        return 1, radiance.shape[1], radiance.shape[0]
    header = _header(path, *_file(path))
    return header.orientation, header.width, header.height


def read_photograph(path: Path, curve: str = "auto") -> Photograph:
    """Reads a picture. ``curve`` is one of `CURVES`; ``auto`` takes the profile's, else sRGB for 8 bits.

    Raises `PictureError`.
    """
    ending = path.suffix.lower()
    if ending in _RAW:
        raise PictureError(
            f"{path}: is a raw file; develop it without a tone curve to a linear 16-bit TIFF "
            "(dcraw -4 -T, darktable, RawTherapee) and state its curve, linear"
        )
    if ending in _RADIANCE:
        return _radiance(path)
    if ending not in _READ:
        raise PictureError(f"{path}: is not a supported picture format; write PNG, JPEG, TIFF, EXR or HDR")
    data, turned = _file(path)
    header = _header(path, data, turned)
    codes = _decoded(path, data)
    profile, name = _profile(path, header.icc)
    space, grounds = (None, "") if name else header.space
    if space == ADOBE_RGB:
        profile, name = ADOBE_TO_REC709, f"{ADOBE_RGB}, by {grounds}"
    curve = _curve(path, curve, codes, name, header.gamma)
    colours = _colours(codes)
    values = codes.astype(np.float32) / np.float32(np.iinfo(codes.dtype).max if codes.dtype.kind == "u" else 1)
    linear = decode(_colours(values), curve)
    if profile is not None:
        linear = (linear @ profile.T.astype(np.float32)).clip(0)
    return Photograph(
        radiance=np.ascontiguousarray(linear, np.float32),
        alpha=np.ascontiguousarray(values[..., 3]) if values.ndim == 3 and values.shape[2] == 4 else None,
        orientation=header.orientation,
        curve=curve,
        profile=name,
        exposure=header.exposure,
        codes=colours if codes.dtype == np.uint8 else None,
        colour_warning=grounds if space is None and grounds else None,
    )


def check_curve(curve: str) -> str:
    """The curve's name, if it is one of `CURVES`. Raises `PictureError`."""
    if curve in CURVES[:-1]:
        return curve
    name, _, number = curve.partition("=")
    try:
        gamma = float(number)
    except ValueError:
        gamma = math.nan
    if name != "gamma" or not 0.2 <= gamma <= 5:
        raise PictureError(f"curve {curve!r} is unknown; there are {', '.join(CURVES)}, the number from 0.2 to 5")
    return curve


def decode(values: Floats, curve: str) -> Floats:
    """Linear values of those of a picture (0 to 1)."""
    if curve == "linear":
        return values
    if curve == "srgb":
        return decoded(values).astype(np.float32)
    if curve == "rec709":
        return np.where(values < 0.081, values / 4.5, ((values + 0.099) / 1.099) ** (1 / 0.45)).astype(np.float32)
    return (values.clip(0) ** float(curve.partition("=")[2])).astype(np.float32)


def read_plane(path: Path) -> Plane:
    """Reads a mask or label picture; of an indexed PNG its values are the indices, of colours with alpha the alpha.
    Raises `PictureError`.
    """
    try:
        data, turned = as_stored(path.read_bytes())
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            warnings.simplefilter("error", Image.DecompressionBombWarning)
            with Image.open(BytesIO(data)) as image:
                orientation = _exif_orientation(image.getexif(), turned)
                if image.mode in ("RGBA", "LA"):
                    return Plane(np.asarray(image.getchannel("A")), orientation)
                if image.mode in ("P", "L", "1", "I;16", "I"):
                    return Plane(np.asarray(image), orientation)
                planes = np.asarray(image.convert("RGB"))
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError, Image.DecompressionBombWarning) as error:
        raise PictureError(f"{path}: cannot be read: {_reason(error)}; write a grey or indexed PNG") from error
    if (planes != planes[..., :1]).any():
        raise PictureError(f"{path}: is a picture of colours; write a grey or indexed PNG, one value for a pixel")
    return Plane(planes[..., 0], orientation)


def _radiance(path: Path) -> Photograph:
    alpha = None
    if path.suffix.lower() == ".exr" and "A" in _native.exr_channels(path):
        alpha = _native.read_exr(path, ["A"])[1][..., 0]
    # Renderers' reconstruction and sensors' noise go below black.
    radiance = np.maximum(_native.read_colour(path), 0)
    return Photograph(radiance, alpha, 1, "linear", None, None, None)


def _file(path: Path) -> tuple[bytes, int | None]:
    """A file's bytes, decoded as stored by every library, and the orientation that a TIFF file states."""
    try:
        return as_stored(path.read_bytes())
    except FileNotFoundError as error:
        raise PictureError(f"{path}: there is no such picture; name the folder that holds it") from error
    except OSError as error:
        raise PictureError(f"{path}: cannot be read: {_reason(error)}; write PNG, JPEG or TIFF again") from error


def _header(path: Path, data: bytes, turned: int | None) -> _Header:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            exif, width, height, info = _metadata(path, data)
            if width * height > _MAX_PIXELS:
                raise PictureError(f"{path}: is {width} x {height}; write it with fewer than {_MAX_PIXELS} pixels")
            tags = exif.get_ifd(_EXIF)
            gamma = info.get("gamma")
            return _Header(
                width,
                height,
                _exif_orientation(exif, turned),
                info.get("icc_profile"),
                gamma if isinstance(gamma, float) else None,
                _exposure(tags | dict(exif)),
                exif_colour_space(tags, exif, path.name),
            )
    except (OSError, ValueError, SyntaxError, TypeError, Image.DecompressionBombError) as error:
        raise PictureError(f"{path}: cannot be read: {_reason(error)}; write PNG, JPEG or TIFF again") from error


def _metadata(path: Path, data: bytes) -> tuple[Image.Exif, int, int, dict[Any, Any]]:
    """EXIF, width and height (pixels), and what else Pillow finds in a file."""
    try:
        with Image.open(BytesIO(data)) as image:
            return image.getexif(), image.width, image.height, image.info
    except UnidentifiedImageError:
        if data[:2] not in (b"II", b"MM"):
            raise
        # Pillow lacks colours of floating point and some large TIFF files; their tags are EXIF like any other.
        exif = Image.Exif()
        exif.load(data)
        height, width = _decoded(path, data).shape[:2]
        return exif, width, height, {"icc_profile": exif.get(_PROFILE)}


def _exif_orientation(exif: Image.Exif, turned: int | None) -> int:
    orientation = exif.get(ORIENTATION, 1) if turned is None else turned
    return orientation if orientation in range(1, 9) else 1


def _exposure(tags: dict[int, Any]) -> float | None:
    try:
        iso = tags.get(_ISO, 100)
        iso = iso[0] if isinstance(iso, tuple) else iso
        # A lens without electronics states an f-number of 0.
        stop = float(Fraction(tags.get(_F_NUMBER, 0)))
        value = float(Fraction(tags[_EXPOSURE_TIME])) * float(iso) / (stop * stop or 1.0)
    except (KeyError, ValueError, TypeError, ZeroDivisionError, OverflowError):
        return None
    return value if 0 < value < math.inf else None


def _decoded(path: Path, data: bytes) -> NDArray[Any]:
    """Codes [H, W(, C)] in OpenCV's order of channels, EXIF orientation not applied."""
    try:
        codes = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED)
    except cv2.error as error:
        raise PictureError(f"{path}: cannot be read: {_reason(error)}; write PNG, JPEG or TIFF again") from error
    if codes is None:
        raise PictureError(
            f"{path}: cannot be read: its data are damaged or of an unknown kind; write PNG, JPEG or TIFF again"
        )
    if codes.dtype not in (np.uint8, np.uint16, np.float32):
        raise PictureError(f"{path}: holds {codes.dtype} values; write 8 or 16 bits, or float32")
    if codes.dtype == np.float32 and not np.isfinite(codes).all():
        raise PictureError(f"{path}: holds values that are not finite; write it again")
    return codes


def _colours(codes: NDArray[Any]) -> NDArray[Any]:
    """R, G, B [H, W, 3] of what OpenCV read."""
    if codes.ndim == 2:
        return np.repeat(codes[..., None], 3, 2)
    return np.ascontiguousarray(codes[..., 2::-1])


def _profile(path: Path, icc: bytes | None) -> tuple[NDArray[np.float64] | None, str | None]:
    """The matrix from the profile's primaries to Rec.709's, unless they are these, and its name."""
    if not icc:
        return None, None
    try:
        profile = ImageCms.ImageCmsProfile(BytesIO(icc))
        name = ImageCms.getProfileDescription(profile).strip()
    except (OSError, ImageCms.PyCMSError) as error:
        raise PictureError(
            f"{path}: its colour profile cannot be read: {_reason(error)}; convert it to sRGB"
        ) from error
    core: Any = profile.profile
    primaries, ours = _primaries(core), _primaries(ImageCms.createProfile("sRGB"))
    if core.xcolor_space.strip() == "GRAY" or ours is None:
        return None, name
    if primaries is None:
        raise PictureError(
            f"{path}: its colour profile {name!r} is not a matrix of primaries; convert the picture to sRGB"
        )
    matrix = np.linalg.inv(ours) @ primaries
    return (None if np.abs(matrix - np.eye(3)).max() < _SAME_PRIMARIES else matrix), name


def _primaries(profile: Any) -> NDArray[np.float64] | None:
    """Columns of CIE XYZ, relative to D50, of a profile's red, green and blue."""
    colorants = [profile.red_colorant, profile.green_colorant, profile.blue_colorant]
    if any(colorant is None for colorant in colorants):
        return None
    return np.array([colorant[0] for colorant in colorants]).T


def _curve(path: Path, curve: str, codes: NDArray[Any], name: str | None, gamma: float | None) -> str:
    if check_curve(curve) != "auto":
        return curve
    if codes.dtype == np.float32:
        return "linear"
    if name:
        found = [known for part, known in _NAMED_CURVES if part in name.lower().replace("_", " ")]
        if found:
            return found[0]
        raise PictureError(f"{path}: the curve of its colour profile {name!r} is not known by name; state the curve")
    if gamma is not None and abs(gamma - 1) < 1e-3:
        return "linear"
    if codes.dtype == np.uint16 and path.suffix.lower() in (".tif", ".tiff"):
        raise PictureError(
            f"{path}: is a 16-bit TIFF without a colour profile, linear or not; state the curve: linear or srgb"
        )
    return "srgb"


def _reason(error: Exception) -> str:
    said = getattr(error, "strerror", None) or getattr(error, "err", None) or str(error)
    return " ".join(str(said).split()) or type(error).__name__

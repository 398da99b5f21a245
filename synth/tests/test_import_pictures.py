"""Photographs of others: transfer curves, colour profiles, orientations, brackets, and what is refused."""

from __future__ import annotations

import struct
from io import BytesIO
from pathlib import Path

import cv2
import numpy as np
import pytest
import tifffile
from PIL import Image, ImageCms, ImageOps

from unshade.errors import PictureError
from unshade.importing.brackets import bracket, merged
from unshade.importing.orientation import inverse, oriented
from unshade.importing.photographs import Reading, take
from unshade.importing.pictures import read_photograph, read_plane
from unshade.importing.source import Source, SourceView

RANDOM = np.random.default_rng(1)
CODES = RANDOM.integers(0, 256, (6, 10, 3), dtype=np.uint8)


def _srgb(codes: np.ndarray) -> np.ndarray:
    """IEC 61966-2-1, from the standard's text."""
    values = codes / np.iinfo(codes.dtype).max
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


def _profile(name: str, primaries: list[list[float]], gamma: float) -> bytes:
    """A colour profile of three primaries (CIE XYZ under D50) and one gamma: ICC.1:2001, nothing but what it must have."""

    def tag_xyz(xyz: list[float]) -> bytes:
        return b"XYZ \0\0\0\0" + struct.pack(">3i", *(round(v * 65536) for v in xyz))

    text = name.encode() + b"\0"
    desc = b"desc\0\0\0\0" + struct.pack(">I", len(text)) + text + b"\0" * (4 + 4 + 2 + 1 + 67)
    curve = b"curv\0\0\0\0" + struct.pack(">IH", 1, round(gamma * 256)) + b"\0\0"
    tags = {b"desc": desc, b"cprt": b"text\0\0\0\0none\0", b"wtpt": tag_xyz([0.9642, 1.0, 0.8249])}
    tags |= {key: tag_xyz(xyz) for key, xyz in zip((b"rXYZ", b"gXYZ", b"bXYZ"), primaries)}
    tags |= dict.fromkeys((b"rTRC", b"gTRC", b"bTRC"), curve)
    table, data, start = struct.pack(">I", len(tags)), b"", 128 + 4 + 12 * len(tags)
    for key, content in tags.items():
        content += b"\0" * (-len(content) % 4)
        table += key + struct.pack(">II", start + len(data), len(content))
        data += content
    head = struct.pack(">I4sI4s4s4s", start + len(data), b"lcms", 0x02100000, b"mntr", b"RGB ", b"XYZ ")
    head += struct.pack(">6H", 2026, 1, 1, 0, 0, 0) + b"acsp" + b"\0" * 28 + struct.pack(">3i", 63190, 65536, 54061)
    return head.ljust(128, b"\0") + table + data


ADOBE = _profile(
    "Adobe RGB (1998)",
    [[0.60974, 0.31111, 0.01947], [0.20528, 0.62567, 0.06087], [0.14919, 0.06322, 0.74457]],
    2.19921875,
)


def test_eight_and_sixteen_bits_through_the_srgb_curve(tmp_path: Path) -> None:
    Image.fromarray(CODES).save(tmp_path / "a.png")
    np.testing.assert_allclose(read_photograph(tmp_path / "a.png").radiance, _srgb(CODES), atol=1e-6)
    deep = RANDOM.integers(0, 65536, (6, 10, 3), dtype=np.uint16)
    cv2.imwrite(str(tmp_path / "b.png"), deep[..., ::-1])
    np.testing.assert_allclose(read_photograph(tmp_path / "b.png").radiance, _srgb(deep), atol=1e-6)
    cv2.imwrite(str(tmp_path / "c.tif"), deep[..., ::-1])
    with pytest.raises(PictureError, match="16-bit TIFF without a colour profile.* state the curve"):
        read_photograph(tmp_path / "c.tif")
    np.testing.assert_allclose(read_photograph(tmp_path / "c.tif", "linear").radiance, deep / 65535, atol=1e-6)
    np.testing.assert_allclose(
        read_photograph(tmp_path / "c.tif", "gamma=2.2").radiance, (deep / 65535) ** 2.2, atol=1e-5
    )
    grey = CODES[..., 0]
    Image.fromarray(grey).save(tmp_path / "d.png")
    np.testing.assert_allclose(read_photograph(tmp_path / "d.png").radiance[..., 2], _srgb(grey), atol=1e-6)


def test_a_profile_is_converted_as_littlecms_does(tmp_path: Path) -> None:
    muted = (60 + CODES // 2).astype(np.uint8)  # inside Rec.709
    Image.fromarray(muted).save(tmp_path / "a.png", icc_profile=ADOBE)
    read = read_photograph(tmp_path / "a.png")
    assert read.profile == "Adobe RGB (1998)" and read.curve == "gamma=2.19921875"
    adobe, srgb = ImageCms.ImageCmsProfile(BytesIO(ADOBE)), ImageCms.createProfile("sRGB")
    intent = ImageCms.Intent.RELATIVE_COLORIMETRIC
    codes = np.asarray(ImageCms.profileToProfile(Image.fromarray(muted), adobe, srgb, renderingIntent=intent))
    inside = (codes > 5) & (codes < 250)
    assert inside.mean() > 0.5
    ours = np.where(
        read.radiance <= 0.0031308, 12.92 * read.radiance, 1.055 * read.radiance.clip(1e-9) ** (1 / 2.4) - 0.055
    )
    assert np.abs(ours * 255 - codes)[inside].max() < 1.5
    unknown = _profile("Scanner of Mine", [[0.6, 0.3, 0.02], [0.2, 0.6, 0.06], [0.15, 0.07, 0.74]], 1.9)
    Image.fromarray(muted).save(tmp_path / "b.png", icc_profile=unknown)
    with pytest.raises(PictureError, match="'Scanner of Mine' is not known by name; state the curve"):
        read_photograph(tmp_path / "b.png")
    assert read_photograph(tmp_path / "b.png", "gamma=1.9").profile == "Scanner of Mine"
    Image.fromarray(muted).save(tmp_path / "c.png", icc_profile=ImageCms.ImageCmsProfile(srgb).tobytes())
    np.testing.assert_allclose(read_photograph(tmp_path / "c.png").radiance, _srgb(muted), atol=1e-6)


def _write(path: Path, values: np.ndarray, orientation: int, big: bool = False) -> None:
    """Colours or a mask with an EXIF orientation, by libraries that store pixels as they are given."""
    if path.suffix == ".tif":
        kind = "rgb" if values.ndim == 3 else "minisblack"
        tag = [(274, "H", 1, orientation, True)]
        tifffile.imwrite(path, values, photometric=kind, bigtiff=big, byteorder=">" if big else "<", extratags=tag)
    else:
        exif = Image.Exif()
        exif[274] = orientation
        Image.fromarray(values).save(path, exif=exif, quality=100, subsampling=0, lossless=True)


SHOWN = {
    1: lambda a: a, 2: np.fliplr, 3: lambda a: np.rot90(a, 2), 4: np.flipud,
    5: lambda a: a.swapaxes(0, 1), 6: lambda a: np.rot90(a, -1), 7: lambda a: np.rot90(a, 2).swapaxes(0, 1), 8: np.rot90,
}  # fmt: skip
"""EXIF 2.3: where rows and columns of the stored picture begin as it is shown."""


@pytest.mark.parametrize("shown", [False, True], ids=["cameras-of-stored-pixels", "cameras-of-shown-pixels"])
@pytest.mark.parametrize(
    ("ending", "dtype", "big"),
    [
        (".jpg", np.uint8, False),
        (".png", np.uint8, False),
        (".webp", np.uint8, False),
        (".tif", np.uint8, False),
        (".tif", np.uint16, True),
        (".tif", np.float32, False),
    ],
)
def test_orientation_is_applied_once_or_left_out_whoever_decodes(
    ending: str, dtype: type, big: bool, shown: bool, tmp_path: Path
) -> None:
    """Pictures, masks and labels come to lie in the camera's pixels, as EXIF's text has it, for all eight."""
    smooth = np.stack([*np.meshgrid(np.linspace(40, 200, 24), np.linspace(90, 220, 16)), np.full((16, 24), 77.0)], -1)
    values = smooth.astype(np.uint8).astype(dtype) * np.asarray(
        {np.uint16: 257, np.float32: 1 / 255}.get(dtype, 1), dtype
    )
    mask = np.where(smooth[..., 0] + smooth[..., 1] > 300, 255, 0).astype(np.uint8)
    for orientation, show in SHOWN.items():
        expected, seen = (show(a) if shown else a for a in (values, mask))
        _write(tmp_path / f"p{ending}", values, orientation, big)
        # A mask in the camera's pixels without a tag; one with the photograph's tag; labels as they are shown.
        _write(tmp_path / "plain.png", seen, 1)
        _write(tmp_path / "tagged.tif", mask, orientation)
        _write(tmp_path / "labels.tif", np.where(mask, 2, 0).astype(np.uint8), orientation)
        height, width = seen.shape
        for file in ("plain.png", "tagged.tif"):
            view = SourceView(
                "p", tmp_path / f"p{ending}", np.eye(4), (30.0, 30.0), None, width, height,
                mask=tmp_path / file, label=tmp_path / "labels.tif",
            )  # fmt: skip
            source = Source(tmp_path, (view,), exif_applied=shown)
            taken = take(source, view, Reading("linear", 1, None, False, False, {2: "nose"}), set())
            scale = 1 if dtype == np.float32 else np.iinfo(dtype).max
            np.testing.assert_allclose(taken.radiance, expected / scale, atol=0.02 if ending == ".jpg" else 1e-6)
            np.testing.assert_array_equal(taken.mask, seen)
            np.testing.assert_array_equal(np.asarray(taken.labels) > 0, seen > 0)
        _write(tmp_path / "tagged.png", mask, orientation)
        with Image.open(tmp_path / "tagged.png") as image:
            np.testing.assert_array_equal(oriented(mask, orientation), np.asarray(ImageOps.exif_transpose(image)))
        np.testing.assert_array_equal(oriented(oriented(mask, orientation), inverse(orientation)), mask)


@pytest.mark.parametrize(
    ("exif", "name", "profile"),
    [
        (
            {0xA001: 65535, 0xA005: {1: "R03"}},
            "a.png",
            "Adobe RGB (1998), by EXIF (ColorSpace 65535, InteropIndex R03)",
        ),
        ({0xA001: 2}, "b.png", "Adobe RGB (1998), by EXIF (ColorSpace 2)"),
        ({0xA001: 65535}, "_DSC001.png", "Adobe RGB (1998), by EXIF (ColorSpace 65535) and the underscore that begins"),
        ({0xA001: 65535, 0xA005: {1: "R98"}}, "_c.png", None),
        ({0xA001: 1}, "_d.png", None),
        ({0xA001: 65535}, "e.png", None),
    ],
)
def test_colours_that_exif_alone_states(exif: dict, name: str, profile: str | None, tmp_path: Path) -> None:
    tags = Image.Exif()
    tags[0x8769] = exif
    Image.fromarray(CODES).save(tmp_path / name, exif=tags)
    read = read_photograph(tmp_path / name)
    assert (read.profile or "").startswith(profile or "") and (read.profile is None) == (profile is None)
    Image.fromarray(CODES).save(tmp_path / "with.png", icc_profile=ADOBE)
    expected = read_photograph(tmp_path / "with.png").radiance if profile else _srgb(CODES)
    np.testing.assert_allclose(read.radiance, expected, atol=1e-3)
    assert (read.colour_warning is not None) == (name == "e.png")


def test_brackets_become_one_radiance(tmp_path: Path) -> None:
    """A scene of four decades, exposed three times; the merge knows what each picture clips."""
    scene = np.geomspace(2e-3, 20, 160)[None, :, None].repeat(24, 0).repeat(3, 2)
    for number, seconds in enumerate((0.05, 0.5, 5.0)):
        linear = (scene * seconds).clip(0, 1)
        codes = np.round(
            255 * np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
        ).astype(np.uint8)
        exif = Image.Exif()
        exif[0x8769] = {0x829A: seconds, 0x829D: 1.0, 0x8827: 100}
        Image.fromarray(codes).save(tmp_path / f"a{number}.png", exif=exif)
    paths = bracket(tmp_path / "a0.png", 3)
    radiance, first = merged(paths, "auto")
    assert first.exposure == pytest.approx(0.05 * 100)
    # Where the darkest picture has codes and the lightest is not clipped in all.
    inside = (scene > 4e-3) & (scene < 18)
    ratio = radiance[inside] / (scene[inside] / 100)
    assert np.abs(np.log(ratio)).max() < 0.12 and abs(np.log(ratio).mean()) < 0.02
    with pytest.raises(PictureError, match="brackets are 4 each"):
        bracket(tmp_path / "a0.png", 4)
    Image.fromarray(CODES).save(tmp_path / "b.png")
    with pytest.raises(PictureError, match="no exposure time in its EXIF"):
        merged([tmp_path / "b.png", tmp_path / "b.png"], "auto")
    with pytest.raises(PictureError, match="all pictures of its bracket have one exposure"):
        merged([paths[0], paths[0]], "auto")


def test_alpha_masks_and_indexed_labels(tmp_path: Path) -> None:
    alpha = np.where(np.arange(10) < 4, 255, 0).astype(np.uint8)[None].repeat(6, 0)
    Image.fromarray(np.dstack([CODES, alpha])).save(tmp_path / "a.png")
    read = read_photograph(tmp_path / "a.png")
    assert read.alpha is not None
    np.testing.assert_array_equal(read.alpha * 255, alpha)
    np.testing.assert_array_equal(read_plane(tmp_path / "a.png").values, alpha)
    indexed = Image.fromarray((np.arange(60) % 7).astype(np.uint8).reshape(6, 10), mode="P")
    indexed.putpalette([value for index in range(7) for value in (index * 30, 255 - index, 9)])
    indexed.save(tmp_path / "b.png")
    np.testing.assert_array_equal(read_plane(tmp_path / "b.png").values, (np.arange(60) % 7).reshape(6, 10))
    Image.fromarray(CODES).save(tmp_path / "c.png")
    with pytest.raises(PictureError, match="is a picture of colours"):
        read_plane(tmp_path / "c.png")


def test_files_that_are_not_photographs_are_refused_in_one_line(tmp_path: Path) -> None:
    (tmp_path / "a.CR2").write_bytes(b"II*\0")
    (tmp_path / "b.jpg").write_bytes(b"no picture")
    (tmp_path / "c.gif").write_bytes(b"GIF89a")
    Image.fromarray(CODES).save(tmp_path / "d.png")
    (tmp_path / "d.png").write_bytes((tmp_path / "d.png").read_bytes()[:60])
    for name, words in (
        ("a.CR2", "raw file; develop it"),
        ("b.jpg", "cannot be read"),
        ("c.gif", "not a supported picture format"),
        ("d.png", "cannot be read"),
        ("e.png", "there is no such picture"),
    ):
        with pytest.raises(PictureError, match=words) as refusal:
            read_photograph(tmp_path / name)
        assert "\n" not in str(refusal.value) and name in str(refusal.value)
    Image.fromarray(CODES).save(tmp_path / "f.png")
    for curve in ("log", "gamma=9", "gamma="):
        with pytest.raises(PictureError, match="is unknown; there are auto, srgb"):
            read_photograph(tmp_path / "f.png", curve)

"""Pictures of all stages read by one rule; files are written by others than the reader's own writer."""

import colour
import mitsuba as mi
import numpy as np
import own_head_files as files
import pytest
from exr_files import ACESCG, XYZ, write_exr_file
from PIL import Image

from unshade.errors import PictureError
from unshade.face import FaceError
from unshade.files.pictures import read_exr, read_gray, read_light, read_rgb, write_exr
from unshade.heads import build_head
from unshade.own_head.map_files import read_labels, read_normals, read_picture
from unshade.render import lights
from unshade.render.relight import read_maps
from unshade.scene_file import Light
from unshade.scene_file.face import parse_face


def planes(height=8, width=16, seed=0):
    return np.random.default_rng(seed).random((height, width, 3)).astype(np.float32)


def rgb(picture):
    return dict(zip("RGB", np.moveaxis(picture, -1, 0)))


def test_mitsubas_files_are_read_to_the_bit(tmp_path):
    picture = planes(33, 21)
    write_exr(tmp_path / "a.exr", {"": picture, "diffuse": 2 * picture, "Z": picture[..., 0]})
    channels = read_exr(tmp_path / "a.exr")
    assert set(channels) == {*"RGBZ", *(f"diffuse.{c}" for c in "RGB")}
    np.testing.assert_array_equal(channels["diffuse.G"], 2 * picture[..., 1])
    np.testing.assert_array_equal(read_rgb(tmp_path / "a.exr"), picture)
    bitmap = mi.Bitmap(picture).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float16, False)
    bitmap.write(str(tmp_path / "half.exr"))
    np.testing.assert_array_equal(
        read_rgb(tmp_path / "half.exr"), np.array(mi.Bitmap(str(tmp_path / "half.exr")), np.float32)
    )
    mi.Bitmap(picture).write(str(tmp_path / "a.hdr"))
    np.testing.assert_array_equal(read_rgb(tmp_path / "a.hdr"), np.array(mi.Bitmap(str(tmp_path / "a.hdr"))))


@pytest.mark.parametrize("corner", [(4, 2), (-8, -3), (12, 0)])
def test_lights_are_placed_in_the_display_window(tmp_path, corner):
    picture = planes()
    write_exr_file(tmp_path / "sky.exr", rgb(picture) | {"Z": picture[..., 0]}, corner=corner, display=(16, 8))
    expected = np.zeros((8, 16, 3), np.float32)
    for y, x in np.ndindex(8, 16):
        if 0 <= y - corner[1] < 8 and 0 <= x - corner[0] < 16:
            expected[y, x] = picture[y - corner[1], x - corner[0]]
    found = lights.environment(Light("sky", "envmap", path=str(tmp_path / "sky.exr"), clamp=100.0))
    np.testing.assert_array_equal(found.picture, expected)


def test_primaries_are_converted_for_colours_alone(tmp_path):
    picture = planes()
    write_exr_file(tmp_path / "a.exr", rgb(picture), chromaticities=ACESCG)
    expected = colour.RGB_to_RGB(picture, "ACEScg", "ITU-R BT.709", "Bradford")
    np.testing.assert_allclose(read_rgb(tmp_path / "a.exr"), expected, atol=1e-3)
    np.testing.assert_allclose(read_picture(str(tmp_path / "a.exr"), colour=True), expected, atol=1e-3)
    np.testing.assert_array_equal(read_picture(str(tmp_path / "a.exr")), picture)
    np.testing.assert_allclose(read_exr(tmp_path / "a.exr", colour=True)["G"], expected[..., 1], atol=1e-3)


def test_layers_of_colour_are_converted_too(tmp_path):
    picture = planes()
    layer = {f"View.Combined.{name}": plane for name, plane in rgb(picture).items()}
    write_exr_file(tmp_path / "a.exr", layer | {"View.Depth.Z": picture[..., 0]}, chromaticities=ACESCG)
    found = read_exr(tmp_path / "a.exr", colour=True)
    np.testing.assert_array_equal(np.stack([found[c] for c in "RGB"], -1), read_rgb(tmp_path / "a.exr"))
    assert np.abs(found["R"] - picture[..., 0]).max() > 0.05


LAYOUTS = {"16 x 16, the shape of a light probe": (16, 16), "in a row": (96, 16), "of a cube map's cross": (32, 24)}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_lights_of_other_layouts_are_named(layout, tmp_path):
    width, height = LAYOUTS[layout]
    write_exr(tmp_path / "l.exr", {"": planes(height, width)})
    with pytest.raises(PictureError, match=f"l.exr: is .*{layout}.*lat-long picture of 2 : 1"):
        lights.environment(Light("l", "envmap", path=str(tmp_path / "l.exr")))


def test_cube_maps_and_photographs_are_named(tmp_path):
    write_exr_file(tmp_path / "cube.exr", rgb(planes()), envmap=1)
    with pytest.raises(PictureError, match=r"is a cube map \(envmap = cube\)"):
        read_light(tmp_path / "cube.exr")
    write_exr_file(tmp_path / "latlong.exr", rgb(planes()), envmap=0)
    assert read_light(tmp_path / "latlong.exr").shape == (8, 16, 3)
    Image.new("RGB", (16, 8)).save(tmp_path / "l.jpg")
    with pytest.raises(PictureError, match="l.jpg: is a JPEG; pictures are linear float EXR"):
        read_light(tmp_path / "l.jpg")


def test_own_heads_state_their_primaries(tmp_path):
    files.write_obj(tmp_path / "scan.obj")
    albedo = np.full((8, 8, 3), [0.30, 0.32, 0.28], np.float32)
    write_exr_file(tmp_path / "xyz.exr", rgb(albedo), chromaticities=XYZ)
    table = files.TABLE | {"mesh": "scan.obj", "diffuse_albedo": "xyz.exr", "diffuse_albedo_space": "linear"}
    head = build_head(parse_face(table, "[face]", tmp_path))
    expected = colour.XYZ_to_RGB(albedo[0, 0], "ITU-R BT.709", apply_cctf_encoding=False)
    np.testing.assert_allclose(
        head.maps.diffuse_albedo[head.maps.inside], np.broadcast_to(expected, (head.maps.inside.sum(), 3)), atol=2e-3
    )


def test_pictures_without_normals_are_named(tmp_path):
    Image.new("L", (8, 8), 200).save(tmp_path / "bump.png")
    with pytest.raises(FaceError, match="bump.png: has one channel, as a bump map"):
        read_normals(str(tmp_path / "bump.png"))
    n = np.random.default_rng(1).normal(size=(32, 32, 3))
    n = (n / np.linalg.norm(n, axis=-1, keepdims=True)).astype(np.float32)
    write_exr(tmp_path / "coded.exr", {"": n / 2 + 0.5})
    with pytest.raises(FaceError, match=r"coded.exr: holds n/2 \+ 1/2"):
        read_normals(str(tmp_path / "coded.exr"))
    write_exr(tmp_path / "n.exr", {"": n})
    np.testing.assert_array_equal(read_normals(str(tmp_path / "n.exr")), n)
    flat = np.broadcast_to(np.float32([0, 0, 1]), (8, 8, 3))
    write_exr(tmp_path / "flat.exr", {"": flat})
    np.testing.assert_array_equal(read_normals(str(tmp_path / "flat.exr")), flat)


def test_pngs_of_one_channel_alone_are_masks(tmp_path):
    grey = np.arange(64, dtype=np.uint8).reshape(8, 8)
    Image.fromarray(grey).save(tmp_path / "grey.png")
    np.testing.assert_array_equal(read_gray(tmp_path / "grey.png"), grey)
    Image.fromarray(grey % 2 == 1).save(tmp_path / "bits.png")
    np.testing.assert_array_equal(read_gray(tmp_path / "bits.png"), grey % 2 * 255)
    np.testing.assert_array_equal(read_labels(str(tmp_path / "bits.png"), 8), grey % 2)
    for mode in ("P", "LA", "RGB"):
        Image.fromarray(grey).convert(mode).save(tmp_path / "other.png")
        with pytest.raises(PictureError, match="other.png: expected 8-bit grey, found"):
            read_gray(tmp_path / "other.png")


def test_uncovered_texels_of_maps_may_hold_anything(tmp_path):
    albedo = np.full((8, 8, 3), 0.4, np.float32)
    albedo[2, 3, 1] = np.nan
    mi.Bitmap(albedo).write(str(tmp_path / "diffuse_albedo.exr"))
    with pytest.raises(PictureError, match="nan in channel G at column 3, row 2"):
        read_maps(tmp_path, print)
    coverage = np.full((8, 8), 255, np.uint8)
    coverage[2, 3] = 0
    Image.fromarray(coverage).save(tmp_path / "coverage.png")
    found = read_maps(tmp_path, print).diffuse_albedo
    assert (found[2, 3] == 0).all() and np.isfinite(found).all() and found[0, 0, 0] == np.float32(0.4)


def test_damaged_files_are_refused_in_one_line(tmp_path):
    write_exr(tmp_path / "a.exr", {"": planes()})
    whole = (tmp_path / "a.exr").read_bytes()
    for length in (3, 40, len(whole) // 2, len(whole) - 1):
        (tmp_path / "b.exr").write_bytes(whole[:length])
        with pytest.raises(PictureError, match="b.exr: cannot be read") as caught:
            read_rgb(tmp_path / "b.exr")
        assert "\n" not in str(caught.value)
    with pytest.raises(PictureError, match="none.exr: cannot be read"):
        read_rgb(tmp_path / "none.exr")

"""Plain pictures, and what no export takes."""

import json
import shutil

import export_toy
import numpy as np
import pytest

from unshade import _native
from unshade.errors import CaptureError, ExportError, MapsError, StorageError
from unshade.exporting.assets import Options, export
from unshade.exporting.texture_files import png_bytes, srgb
from unshade.files.pictures import read_exr
from unshade.srgb import decoded

NAMES = ("diffuse_albedo", "specular_albedo", "roughness", "diffuse_normal", "specular_normal")


@pytest.fixture(scope="module")
def capture(tmp_path_factory):
    return export_toy.captured_once(tmp_path_factory)


@pytest.fixture(scope="module")
def sets(capture, tmp_path_factory):
    folder = tmp_path_factory.mktemp("pictures")
    for bits in (8, 16):
        export_toy.exported(capture, folder / f"{bits}", "png", bits=bits)
    export_toy.exported(capture, folder / "down", "png", green_up=False)
    return folder


def stacked(folder, name):
    planes = read_exr(folder / f"{name}.exr")
    return planes["Y"] if "Y" in planes else np.stack([planes[c] for c in "RGB"], -1)


@pytest.mark.parametrize(("bits", "step"), [(8, 1 / 255), (16, 1 / 65535)])
def test_pngs_hold_the_numbers_of_the_exrs(sets, bits, step):
    for name in NAMES:
        codes = _native.read_png(sets / f"{bits}" / f"{name}.png")
        values = stacked(sets / f"{bits}", name)
        expected = {"diffuse_albedo": srgb(values), "specular_albedo": values / 0.05}.get(name, values)
        if name.endswith("normal"):
            expected = values / 2 + 0.5
        np.testing.assert_allclose(codes.squeeze(), expected.clip(0, 1), atol=0.51 * step, err_msg=name)


def test_roughness_is_the_root_of_an_alpha_between_the_lobes(sets, capture):
    truth = read_exr(capture / "truth/roughness.exr")
    alpha = stacked(sets / "16", "roughness") ** 2
    assert (alpha > truth["alpha1"] - 0.01).all() and (alpha < truth["alpha2"]).all()


def test_green_turns_and_nothing_else(sets):
    for name in NAMES:
        up, down = stacked(sets / "16", name), stacked(sets / "down", name)
        expected = up * np.float32([1, -1, 1]) if name.endswith("normal") else up
        np.testing.assert_array_equal(expected, down)


def test_srgb_is_its_own_inverse():
    values = np.linspace(0, 1, 300)
    np.testing.assert_allclose(decoded(srgb(values)), values, atol=1e-6)
    np.testing.assert_allclose(srgb(np.array([0.18, 0.5, 2.0])), [0.46135, 0.73536, 1.0], atol=1e-4)


def test_a_png_has_the_bits_that_were_asked_for():
    for bits in (8, 16):
        header = png_bytes(np.zeros((2, 3, 3)), bits)[:33]
        assert header[:4] == b"\x89PNG" and header[24] == bits and header[25] == 2


def attempt(maps, out, *, capture=None, mesh=None, **options):
    chosen = Options(**{"format": "png", "fidelity": False} | options)
    return export(maps, out, capture, mesh, chosen, export_toy.no_progress, export_toy.no_warning)


def test_maps_without_a_mesh_are_refused(capture, tmp_path):
    with pytest.raises(CaptureError, match="--capture"):
        attempt(capture / "truth", tmp_path / "out")


def test_an_obj_serves_as_well(capture, tmp_path, sets):
    attempt(capture / "truth", tmp_path / "out", mesh=capture / "mesh.obj")
    for name in NAMES:
        np.testing.assert_allclose(stacked(tmp_path / "out", name), stacked(sets / "16", name), atol=1e-5)
    document = json.loads((tmp_path / "out/asset.json").read_text())
    assert document["format"] == "png" and document["texels"] == 64


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "UV"),
        ("v 0 0 0\n", "0 meshes"),
        ("v 0 0 0\nf 1 2 9\n", "cannot be read"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt .5 .5\nvt .5 .5\nvt .5 .5\nf 1/1 2/2 3/3\n", "cover no texel"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 2\nf 1/1 2/2 3/3\n", "unit square"),
    ],
)
def test_meshes_that_cannot_serve_are_refused(capture, tmp_path, text, words):
    mesh = tmp_path / "mesh.obj"
    mesh.write_text(text)
    with pytest.raises(CaptureError, match=words):
        attempt(capture / "truth", tmp_path / "out", mesh=mesh)
    assert not (tmp_path / "out").exists()


def test_a_missing_albedo_is_refused(capture, tmp_path):
    maps = export_toy.copied_maps(capture, tmp_path / "maps")
    (maps / "diffuse_albedo.exr").unlink()
    with pytest.raises(MapsError, match="diffuse_albedo.exr is missing"):
        attempt(maps, tmp_path / "out", capture=capture)


def test_maps_of_the_albedo_alone_have_the_meshs_normals(capture, tmp_path):
    maps = export_toy.copied_maps(capture, tmp_path / "maps")
    for name in NAMES[1:]:
        (maps / f"{name}.exr").unlink()
    attempt(maps, tmp_path / "out", capture=capture)
    normal = stacked(tmp_path / "out", "specular_normal")
    np.testing.assert_allclose(normal, np.broadcast_to([0, 0, 1], normal.shape), atol=1e-5)
    assert (stacked(tmp_path / "out", "specular_albedo") == 0).all()


def test_no_other_format_is_taken(capture, tmp_path):
    with pytest.raises(ExportError, match="usdz: is not a format; use one of gltf"):
        attempt(capture / "truth", tmp_path / "out", capture=capture, format="usdz")


def test_folders_of_others_are_not_replaced(capture, tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    (out / "mine.txt").write_text("mine")
    with pytest.raises(StorageError):
        attempt(capture / "truth", out, capture=capture)
    assert (out / "mine.txt").read_text() == "mine"
    shutil.rmtree(out)
    attempt(capture / "truth", out, capture=capture)
    attempt(capture / "truth", out, capture=capture, bits=8)
    assert _native.read_png(out / "roughness.png").shape == (64, 64, 1)

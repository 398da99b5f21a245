"""A Mitsuba scene that renders as it is."""

import json
import os
import subprocess
import sys

import export_toy
import mitsuba as mi
import numpy as np
import pytest

from unshade.render import llvm


@pytest.fixture(scope="module")
def capture(tmp_path_factory):
    return export_toy.captured_once(tmp_path_factory)


@pytest.fixture(scope="module")
def made(capture, tmp_path_factory):
    out = tmp_path_factory.mktemp("mitsuba") / "asset"
    return out, export_toy.exported(capture, out, "mitsuba")


def test_the_skin_itself_loses_nothing(made):
    rows = [row for row in made[1] if row["material"] == "exact"]
    assert {row["light"] for row in rows} == {"studio", "uniform"}
    for row in rows:
        # What is left is the rounding of the mesh's text.
        assert row["psnr_srgb"] is None or row["psnr_srgb"] > 70
        assert row["diffuse_ratio"] == pytest.approx(1, abs=1e-4)
        assert row["specular_ratio"] == pytest.approx(1, abs=1e-4)


def test_stock_plugins_lose_little(made):
    for row in (row for row in made[1] if row["material"] == "scene"):
        assert row["psnr_srgb"] > 36
        assert row["diffuse_ratio"] == pytest.approx(1, abs=0.01)
        # Glass's Fresnel term lies up to a quarter above Schlick's at middle angles.
        assert row["specular_ratio"] == pytest.approx(1.06, abs=0.07)


def test_stock_mitsuba_renders_it_from_any_folder(made, tmp_path):
    """In a process that knows nothing of unshade; its picture shows the face where the capture does."""
    code = (
        "import sys, mitsuba as mi; mi.set_variant('scalar_rgb'); scene = mi.load_file(sys.argv[1]);"
        "mi.util.write_bitmap(sys.argv[2], mi.render(scene, spp=4), write_async=False)"
    )
    picture = tmp_path / "picture.exr"
    subprocess.run([sys.executable, "-c", code, str(made[0] / "scene.xml"), str(picture)], check=True, cwd=tmp_path)
    found = np.array(mi.Bitmap(str(picture)))[..., :3]
    assert found.shape == (32, 40, 3) and np.isfinite(found).all()
    assert found[16, 20].mean() > 0.02


def test_the_other_scene_comes_with_its_plugin(made, tmp_path):
    text = (made[0] / "exact.xml").read_text()
    assert 'type="skin"' in text and "unshade" not in (made[0] / "skin.py").read_text()
    words = [sys.executable, "render.py", "exact.xml", str(tmp_path / "picture.exr")]
    library = llvm.choose("llvm_ad_rgb").llvm.path
    subprocess.run(words, check=True, cwd=made[0], env={**os.environ, "DRJIT_LIBLLVM_PATH": library})
    found = np.array(mi.Bitmap(str(tmp_path / "picture.exr")))[..., :3]
    strip = np.asarray(mi.Bitmap(str(made[0] / "fidelity/exact-studio.png")))[:, :40]
    codes = np.clip(found, 0, 1) ** (1 / 2.2) * 255
    seen = np.s_[10:22, 14:26]
    assert np.abs(codes[seen].mean() - strip[seen].mean()) < 8


def test_nothing_names_a_place_of_this_machine(made):
    for name in ("scene.xml", "exact.xml", "asset.json", "fidelity.json", "render.py"):
        assert str(made[0].parent) not in (made[0] / name).read_text()
    assert json.loads((made[0] / "asset.json").read_text())["format"] == "mitsuba"

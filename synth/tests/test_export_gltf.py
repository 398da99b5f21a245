"""glTF: valid by the Khronos validator, read by others, and what it loses is measured."""

import io
import json
import shutil
import subprocess
from pathlib import Path

import export_toy
import numpy as np
import pytest
import trimesh
from PIL import Image

from unshade import surface
from unshade.exporting import fidelity, layered_bsdf, read_gltf
from unshade.files import glb
from unshade.files.pictures import read_exr

ROOT = Path(__file__).parents[2]
VALIDATE = """
const validator = require(process.argv[1]);
validator.validateBytes(new Uint8Array(require("fs").readFileSync(process.argv[2])))
  .then(report => console.log(JSON.stringify(report.issues)));
"""


@pytest.fixture(scope="module")
def capture(tmp_path_factory):
    return export_toy.captured_once(tmp_path_factory)


@pytest.fixture(scope="module")
def made(capture, tmp_path_factory):
    out = tmp_path_factory.mktemp("gltf") / "asset"
    return out, export_toy.exported(capture, out, "gltf")


def test_the_khronos_validator_finds_nothing(made):
    node, package = shutil.which("node"), ROOT / ".tools/node_modules/gltf-validator"
    if node is None or not package.is_dir():
        pytest.skip("the Khronos glTF validator is missing: make validators (needs node and npm)")
    words = [node, "-e", VALIDATE, str(package), str(made[0] / "face.glb")]
    issues = json.loads(subprocess.run(words, capture_output=True, text=True, check=True).stdout)
    assert issues["messages"] == [] and issues["numErrors"] == 0


def test_another_reader_finds_shape_and_colours(made, capture):
    scene = trimesh.load(made[0] / "face.glb")
    (mesh,) = scene.geometry.values()
    truth = surface.read_surface(capture / "truth", capture, None, export_toy.no_warning)
    assert len(mesh.faces) == len(truth.mesh.triangles)
    corners = np.asarray(mesh.vertices)[mesh.faces]
    np.testing.assert_allclose(corners, truth.mesh.vertices[truth.mesh.triangles], atol=1e-7)
    # trimesh has v up, as we have.
    np.testing.assert_allclose(mesh.visual.uv[mesh.faces], truth.mesh.uv[truth.mesh.triangles], atol=1e-6)
    colour = np.asarray(mesh.visual.material.baseColorTexture.convert("RGB"))[20, 30] / 255
    linear = ((colour + 0.055) / 1.055) ** 2.4
    albedo = np.stack([read_exr(capture / "truth/diffuse_albedo.exr")[c][20, 30] for c in "RGB"])
    # What the surface reflects first, 1 to 6 %, is put on top.
    assert (linear / albedo > 1.0).all() and (linear / albedo < 1.08).all()


def test_it_states_what_it_uses(made):
    document = glb.unpacked((made[0] / "face.glb").read_bytes())[0]
    material = document["materials"][0]
    assert (
        set(material["extensions"])
        == set(document["extensionsUsed"])
        == {"KHR_materials_ior", "KHR_materials_specular"}
    )
    asset = json.loads((made[0] / "asset.json").read_text())
    # The toy's specular albedo reaches 0.05.
    assert asset["ior"] == material["extensions"]["KHR_materials_ior"]["ior"] == pytest.approx(1.576, abs=2e-3)
    assert 0 < asset["lobe_energy_misplaced_mean"] <= asset["lobe_energy_misplaced_largest"] < 0.3


def test_little_is_lost(made):
    rows = {row["light"]: row for row in made[1]}
    assert set(rows) == {"studio", "uniform"}
    for row in rows.values():
        assert row["psnr_srgb"] > 38
        assert row["diffuse_ratio"] == pytest.approx(1, abs=0.02)
        assert row["specular_ratio"] == pytest.approx(1, abs=0.12)
    document = json.loads((made[0] / "fidelity.json").read_text())
    assert document["rows"] == made[1] and document["protocol"]["id"] == "unshade-fidelity-1"


def with_picture(path, name, change):
    """The GLB with one of its pictures changed: the new one is put behind all others."""
    document, binary = glb.unpacked(path.read_bytes())
    (image,) = (image for image in document["images"] if image["name"] == name)
    view = document["bufferViews"][image["bufferView"]]
    picture = np.asarray(Image.open(io.BytesIO(binary[view["byteOffset"] :][: view["byteLength"]])))
    stream = io.BytesIO()
    Image.fromarray(change(picture.copy())).save(stream, format="PNG")
    new = stream.getvalue()
    view.update(byteOffset=len(binary), byteLength=len(new))
    path.write_bytes(glb.packed(document, binary + new))


def flipped_green(picture):
    picture[..., 1] = 255 - picture[..., 1]
    return picture


def alpha_for_its_root(picture):
    picture[..., 1] = np.rint((picture[..., 1] / 255.0) ** 2 * 255)
    return picture


@pytest.mark.parametrize(("picture", "fault"), [("normal", flipped_green), ("roughness", alpha_for_its_root)])
def test_a_planted_fault_costs_decibels(capture, tmp_path, monkeypatch, picture, fault):
    # One normal for both layers, so that having but one costs nothing.
    maps = export_toy.copied_maps(capture, tmp_path / "maps")
    shutil.copy(maps / "specular_normal.exr", maps / "diffuse_normal.exr")
    # 8 bits, since the fault is planted by another library, which has no RGB of 16.
    sound = export_toy.exported(capture, tmp_path / "sound", "gltf", maps, bits=8)
    shutil.copy(tmp_path / "sound/face.glb", tmp_path / "face.glb")
    with_picture(tmp_path / "face.glb", picture, fault)
    layered_bsdf.register()
    shape = read_gltf.gltf_shape(tmp_path / "face.glb")
    monkeypatch.setattr(fidelity, "build_head", export_toy.render_toy.toy_face)
    truth = surface.read_surface(maps, capture, None, export_toy.no_warning)
    setting = fidelity.setting_of(capture, truth)
    ours = fidelity.reference(setting, truth)
    rows = fidelity.compare(setting, ours, {"gltf": shape}, tmp_path / "pictures", export_toy.no_progress)
    studio = {row["light"]: row["psnr_srgb"] for row in rows}["studio"]
    assert studio < sound[0]["psnr_srgb"] - 3


def test_the_same_maps_give_the_same_bytes(made, capture, tmp_path):
    export_toy.exported(capture, tmp_path / "again", "gltf", fidelity=False)
    assert (tmp_path / "again/face.glb").read_bytes() == (made[0] / "face.glb").read_bytes()

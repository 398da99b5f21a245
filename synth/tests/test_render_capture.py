"""Captures and relighting as folders: complete, repeatable, resumable, and true."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import render_toy

from unshade.errors import CaptureError, MapsError, PictureError, StorageError
from unshade.face.ita import Tone
from unshade.files.pictures import read_exr, read_gray, read_rgb, write_exr
from unshade.render import capture, llvm, relight, shots
from unshade.render.rigs import cameras
from unshade.render.scene_text import scene_text
from unshade.render.truth_scene import captured_scene
from unshade.scene_file import CapturedMesh, Formation, LabelFaults, parse_scene

CHOICE = llvm.choose("llvm_ad_rgb")


@pytest.fixture(autouse=True)
def toy(monkeypatch):
    """The procedural head in place of the painted one, for speed."""
    for module in (capture, relight):
        monkeypatch.setattr(module, "build_head", render_toy.toy_face)
    monkeypatch.setattr(capture, "face_ita", toy_tone)


def toy_tone(maps, chart):
    """The toy has neither forehead nor cheeks."""
    return Tone({}, 20.0, "tan")


def scene(**render):
    return parse_scene(render_toy.toy_table(**render), "toy", Path())


def no_progress(done, total, what):
    pass


def files(folder):
    """Every file but the mark that lists them."""
    paths = (p for p in sorted(folder.rglob("*")) if p.is_file() and p.name != ".unshade")
    return {str(p.relative_to(folder)): p.read_bytes() for p in paths}


@pytest.fixture(scope="module")
def captured(tmp_path_factory):
    out = tmp_path_factory.mktemp("captured") / "capture"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(capture, "build_head", render_toy.toy_face)
        patch.setattr(capture, "face_ita", toy_tone)
        capture.synthesise(scene(), out, CHOICE, no_progress)
    return out


def test_the_folder_is_complete(captured):
    frames, test = ["000", "001", "002", "003"], "003"
    expected = {"transforms.json", "mesh.obj", "truth/scene.toml", "truth/light.exr"}
    expected |= {
        f"{kind}/{name}.{end}"
        for name in frames
        for kind, end in (("images", "exr"), ("masks", "png"), ("labels", "png"))
    }
    expected |= {f"truth/layers/{name}.exr" for name in frames}
    expected |= {
        f"truth/{name}.exr"
        for name in ("diffuse_albedo", "specular_albedo", "diffuse_normal", "specular_normal", "roughness")
    }
    expected |= {"truth/skin_tone.json", "truth/relit_lights/uniform.exr"}
    expected |= {f"truth/{name}.png" for name in ("labels", "coverage", "views")}
    expected |= {f"truth/relit/{light}/{test}.exr" for light in ("studio", "uniform")}
    assert set(files(captured)) == expected
    transforms = json.loads((captured / "transforms.json").read_text())
    assert transforms["train_filenames"] == [f"images/{name}.exr" for name in frames[:3]]
    assert transforms["test_filenames"] == ["images/003.exr"]
    assert set(read_exr(captured / "truth/specular_albedo.exr")) == {"Y"}
    layered = {f"{layer}.{c}" for layer in ("diffuse", "specular", "variance", "half") for c in "RGB"}
    assert set(read_exr(captured / "truth/layers/000.exr")) == layered
    assert set(read_exr(captured / "truth/relit/uniform/003.exr")) == layered | set("RGB")


def test_pictures_are_the_sum_of_their_layers(captured):
    for name in ("000", "003"):
        image, layers = read_exr(captured / f"images/{name}.exr"), read_exr(captured / f"truth/layers/{name}.exr")
        for c in "RGB":
            assert (image[c] == layers[f"diffuse.{c}"] + layers[f"specular.{c}"]).all()
    own = read_exr(captured / "truth/relit/studio/003.exr")
    assert all((own[c] == image[c]).all() for c in "RGB")


def test_masks_labels_and_coverage_agree(captured):
    for name in ("000", "001", "002", "003"):
        mask, labels = (read_gray(captured / f"{kind}/{name}.png") for kind in ("masks", "labels"))
        assert set(np.unique(mask)) == {0, 255}
        assert ((labels > 0) == (mask > 0)).mean() > 0.99 and (labels[mask == 0] == 0).all()
    views, coverage = read_gray(captured / "truth/views.png"), read_gray(captured / "truth/coverage.png")
    assert views.max() == 3 and ((views > 0) == (coverage == 255)).all()
    assert (coverage[read_gray(captured / "truth/labels.png") == 0] == 0).all()


def test_two_runs_give_identical_bytes(captured, tmp_path):
    capture.synthesise(scene(), tmp_path / "again", CHOICE, no_progress)
    assert files(tmp_path / "again") == files(captured)


class Killed(Exception):
    pass


def kill_at(step):
    def kill(done, total, what):
        if what.startswith(step):
            raise Killed

    return kill


@pytest.mark.parametrize("step", ["view 000", "view 002", "visibility"])
def test_an_interrupted_capture_goes_on_to_the_same_bytes(captured, tmp_path, step):
    seen = []

    out = tmp_path / "capture"
    with pytest.raises(Killed):
        capture.synthesise(scene(), out, CHOICE, kill_at(step))
    assert not out.exists()
    # A picture that was being written is no picture.
    (tmp_path / "capture.partial/images").mkdir(exist_ok=True)
    (tmp_path / "capture.partial/images/002.exr.partial").write_bytes(b"half")
    kept = {p: p.stat().st_mtime_ns for p in (tmp_path / "capture.partial/images").glob("*.exr")}
    capture.synthesise(scene(), out, CHOICE, lambda done, total, what: seen.append((done, total)))
    assert files(out) == files(captured)
    assert {p.name: (out / "images" / p.name).stat().st_mtime_ns for p in kept} == {p.name: t for p, t in kept.items()}
    assert seen[-1][0] == seen[-1][1] and [done for done, _ in seen] == sorted(done for done, _ in seen)


def test_leftovers_of_another_scene_are_not_used(captured, tmp_path):
    with pytest.raises(Killed):
        capture.synthesise(scene(seed=5), tmp_path / "capture", CHOICE, kill_at("view 002"))
    capture.synthesise(scene(), tmp_path / "capture", CHOICE, no_progress)
    assert files(tmp_path / "capture") == files(captured)


def test_only_what_changed_is_rendered_again(captured, tmp_path, monkeypatch):
    monkeypatch.setenv("UNSHADE_RENDER_CACHE", str(tmp_path / "renders"))
    rendered = []
    genuine = shots.render_tier
    monkeypatch.setattr(shots, "render_tier", lambda *args, **named: rendered.append(1) or genuine(*args, **named))

    def count(scene, name):
        rendered.clear()
        capture.synthesise(scene, tmp_path / name, CHOICE, no_progress)
        return len(rendered)

    lights = len(scene().relight)
    assert count(replace(scene(), relight=()), "first") == len(scene_cameras())
    # The same pictures, and those of the other lights.
    assert count(scene(), "second") == lights * sum(not camera.train for camera in scene_cameras())
    assert files(tmp_path / "second") == files(captured)
    assert count(scene(samples=8), "third") > lights


def scene_cameras():
    return cameras(scene().rig, 16, 16)


def test_image_formation_leaves_the_truth_alone(captured, tmp_path):
    formed = replace(
        scene(),
        formation=Formation(
            white_level=1.0,
            full_well_electrons=500.0,
            bits=8,
            lens_distortion=(0.3, 0.0, 0.0, 0.0),
            pose_noise_pixels=0.5,
        ),
        captured_mesh=CapturedMesh(smoothing_mm=4.0),
    )
    out = tmp_path / "capture"
    capture.synthesise(formed, out, CHOICE, no_progress)
    made, perfect = files(out), files(captured)
    same = {name for name in perfect if made[name] == perfect[name]}
    changed = {f"images/{name}.exr" for name in ("000", "001", "002")} | {
        "mesh.obj",
        "transforms.json",
        "truth/scene.toml",
    }
    lensed = {f"{kind}/{name}.png" for kind in ("masks", "labels") for name in ("000", "001", "002")}
    # Which texels the distorted views see may change, too; the truth of pictures and maps does not.
    seen = {"truth/views.png", "truth/coverage.png"}
    assert set(perfect) - same - seen == changed | lensed
    assert set(made) - set(perfect) == {"truth/captured_mesh.json"}
    poses, exact = (json.loads(folder["transforms.json"]) for folder in (made, perfect))
    assert poses["camera_model"] == "OPENCV" and [frame.get("k1") for frame in poses["frames"]] == [0.3, 0.3, 0.3, None]
    moved = [a["transform_matrix"] != b["transform_matrix"] for a, b in zip(poses["frames"], exact["frames"])]
    assert moved == [True, True, True, False]
    assert (
        captured_scene(out).formation == formed.formation and captured_scene(out).captured_mesh == formed.captured_mesh
    )


def test_automatic_exposure_is_a_factor_that_only_the_truth_states(captured, tmp_path):
    hidden = replace(scene(), formation=Formation(gain_stops=0.5, white_balance_stops=0.2))
    out = tmp_path / "capture"
    capture.synthesise(hidden, out, CHOICE, no_progress)
    made, perfect = files(out), files(captured)
    pictures = {f"images/{name}.exr" for name in ("000", "001", "002")}
    assert {name for name in perfect if made[name] != perfect[name]} == pictures | {
        "transforms.json",
        "truth/scene.toml",
    }
    assert set(made) - set(perfect) == {"truth/gains.json"}
    document, gains = json.loads(made["transforms.json"]), json.loads(made["truth/gains.json"])
    assert document.pop("exposure") == "unknown" and document == json.loads(perfect["transforms.json"])
    assert sorted(gains) == ["000", "001", "002"]
    for name, gain in gains.items():
        seen, plain = (read_rgb(folder / f"images/{name}.exr") for folder in (out, captured))
        np.testing.assert_allclose(seen, plain * np.float32(gain), rtol=1e-5)
        assert gain[0] != gain[1] != gain[2] and 0.1 < min(gain) < max(gain) < 10


def test_faulty_labels_change_labels_alone_and_render_nothing_anew(captured, tmp_path, monkeypatch):
    monkeypatch.setenv("UNSHADE_RENDER_CACHE", str(tmp_path / "renders"))
    capture.synthesise(scene(), tmp_path / "first", CHOICE, no_progress)
    monkeypatch.setattr(shots, "render_tier", None)
    for name, faults in (("mistaken", LabelFaults(boundary_error=0.3)), ("none", LabelFaults(omit=True))):
        capture.synthesise(replace(scene(), labels=faults), tmp_path / name, CHOICE, no_progress)
        assert captured_scene(tmp_path / name).labels == faults
    made, perfect = files(tmp_path / "mistaken"), files(captured)
    changed = {f"labels/{name}.png" for name in ("000", "001", "002")} | {"truth/scene.toml"}
    assert set(made) == set(perfect) and {name for name in perfect if made[name] != perfect[name]} == changed
    for name in ("000", "001", "002"):
        labels, mask = (read_gray(tmp_path / "mistaken" / kind / f"{name}.png") for kind in ("labels", "masks"))
        assert (labels[mask == 0] == 0).all() and set(np.unique(labels)) == set(
            np.unique(read_gray(captured / f"labels/{name}.png"))
        )
    made = files(tmp_path / "none")
    assert set(perfect) - set(made) == {f"labels/{name}.png" for name in ("000", "001", "002", "003")}
    assert {name for name in made if made[name] != perfect[name]} == {"transforms.json", "truth/scene.toml"}
    stated, unlabelled = (json.loads(found["transforms.json"]) for found in (perfect, made))
    assert stated["label_names"]["1"] == "skin" and stated["label_names"]["5"] == "ear"
    assert "label_names" not in unlabelled and all("label_path" not in frame for frame in unlabelled["frames"])


def test_denoising_is_named_and_removes_noise(captured, tmp_path):
    quiet = replace(scene(), render=replace(scene().render, denoise="oidn"), relight=())
    out = tmp_path / "capture"
    capture.synthesise(quiet, out, CHOICE, no_progress)
    assert captured_scene(out).render.denoise == "oidn"
    reference = replace(scene(), render=replace(scene().render, samples=1024, seed=9), relight=())
    capture.synthesise(reference, tmp_path / "reference", CHOICE, no_progress)
    mask = read_gray(captured / "masks/003.png") > 0
    pictures = [rgb(folder / "images/003.exr")[mask] for folder in (out, captured, tmp_path / "reference")]
    denoised, noisy, clean = pictures
    assert np.square(denoised - clean).mean() < 0.7 * np.square(noisy - clean).mean()


def test_the_truth_states_its_scene(captured):
    stated = captured_scene(captured)
    assert stated.render.variant == stated.versions["variant"] == "llvm_ad_rgb"
    assert stated.versions["llvm"] == CHOICE.llvm.version
    assert stated.face == render_toy.SPEC and stated.rig.train == 3


def run_relight(captured, maps, out, progress=no_progress, warn=pytest.fail, scales=None):
    stated = captured_scene(captured)
    relight.relight(stated, maps, out, scales=scales or {"none": 1.0}, progress=progress, warn=warn)
    return out


@pytest.fixture(scope="module")
def oracle(captured, tmp_path_factory):
    maps = tmp_path_factory.mktemp("oracle") / "maps"
    maps.mkdir()
    for path in (captured / "truth").glob("*_*.exr"):
        (maps / path.name).write_bytes(path.read_bytes())
    return maps


def rgb(path, layer=""):
    channels = read_exr(path)
    return np.stack([channels[f"{layer}.{c}" if layer else c] for c in "RGB"], -1).astype(float)


def z_score(ours, theirs):
    difference = rgb(ours) - rgb(theirs)
    assert (difference != 0).any(), "the noise of truth and relit picture must be independent"
    return difference.sum() / np.sqrt((rgb(ours, "variance") + rgb(theirs, "variance")).sum())


def test_true_maps_relit_differ_from_the_truth_by_noise_alone(captured, oracle, tmp_path):
    out = run_relight(captured, oracle, tmp_path / "relit", scales={"none": 1.0, "global": 0.9})
    for light in ("studio", "uniform"):
        truth = captured / f"truth/relit/{light}/003.exr"
        assert abs(z_score(out / f"none/{light}/003.exr", truth)) < 4
        # A tenth less albedo is no noise, and is seen in the diffuse layer alone.
        assert z_score(out / f"global/{light}/003.exr", truth) < -8
        diffuse, specular = (
            rgb(out / f"global/{light}/003.exr", layer).sum() / rgb(truth, layer).sum()
            for layer in ("diffuse", "specular")
        )
        assert 0.88 < diffuse < 0.94 and 0.85 < specular < 1.15
    document = json.loads((out / "relit.json").read_text())
    assert document["scales"] == {"none": 1.0, "global": 0.9} and document["samples"] == 16


def test_an_interrupted_relighting_goes_on_to_the_same_bytes(captured, oracle, tmp_path):
    scales = {"none": 1.0, "global": 0.9}
    with pytest.raises(Killed):
        run_relight(captured, oracle, tmp_path / "a", kill_at("view 003 in uniform, scale none"), scales=scales)
    resumed = run_relight(captured, oracle, tmp_path / "a", scales=scales)
    straight = run_relight(captured, oracle, tmp_path / "b", scales=scales)
    assert files(resumed) == files(straight)


def test_maps_of_any_size_may_lack_all_but_albedo(captured, tmp_path):
    maps = tmp_path / "maps"
    maps.mkdir()
    with pytest.raises(MapsError, match="diffuse_albedo.exr is missing"):
        run_relight(captured, maps, tmp_path / "relit")
    write_exr(maps / "diffuse_albedo.exr", {"": np.full((7, 7, 3), 0.4, np.float32)})
    out = run_relight(captured, maps, tmp_path / "relit")
    mask = read_gray(captured / "masks/003.png") > 0
    picture = out / "none/uniform/003.exr"
    assert rgb(picture)[mask].mean() > 0.1
    # Only the eye, whose first surface is not the chart, keeps a highlight.
    inner = mask.copy()
    inner[1:-1, 1:-1] &= mask[2:, 1:-1] & mask[:-2, 1:-1] & mask[1:-1, 2:] & mask[1:-1, :-2]
    assert np.quantile(rgb(picture, "specular")[inner], 0.9) < 1e-6


def test_maps_that_cannot_be_rendered_are_named(captured, oracle, tmp_path):
    maps = tmp_path / "maps"
    maps.mkdir()
    albedo = np.full((8, 8, 3), 0.4, np.float32)
    write_exr(maps / "diffuse_albedo.exr", {"": albedo[:, :6]})
    with pytest.raises(MapsError, match="is 6 x 8 texels; write a square map"):
        run_relight(captured, maps, tmp_path / "relit")
    write_exr(maps / "diffuse_albedo.exr", {"": albedo})
    write_exr(maps / "specular_albedo.exr", {"": albedo})
    with pytest.raises(MapsError, match="specular_albedo.exr: channel Y is missing"):
        run_relight(captured, maps, tmp_path / "relit")
    write_exr(maps / "specular_albedo.exr", {"Y": albedo[..., 0] - 0.5})
    warned = []
    run_relight(captured, maps, tmp_path / "relit", warn=warned.append)
    assert warned == [f"{maps}/specular_albedo.exr: 64 values are negative and count as 0"]
    import mitsuba as mi

    albedo[2, 3, 1] = np.nan
    mi.Bitmap(albedo).write(str(maps / "diffuse_albedo.exr"))
    with pytest.raises(PictureError, match="nan in channel G at column 3, row 2"):
        run_relight(captured, maps, tmp_path / "relit")
    (maps / "diffuse_albedo.exr").write_bytes(b"text")
    with pytest.raises(PictureError, match="cannot be read"):
        run_relight(captured, maps, tmp_path / "relit")
    assert not (tmp_path / "relit2").exists()


def test_folders_without_a_synthetic_capture_are_refused(captured, tmp_path):
    with pytest.raises(CaptureError, match="scene.toml: is missing"):
        captured_scene(tmp_path)
    (tmp_path / "truth").mkdir()
    (tmp_path / "truth/scene.toml").write_text(scene_text(scene()))
    with pytest.raises(CaptureError, match="names no variant"):
        captured_scene(tmp_path)


def test_a_place_that_cannot_be_written_is_named(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(StorageError, match="cannot be written"):
        capture.synthesise(scene(), tmp_path / "file" / "capture", CHOICE, no_progress)

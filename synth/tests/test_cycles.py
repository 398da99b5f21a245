"""Cycles as the second judge: found or refused, told the same scene, and of one mind with Mitsuba."""

import json
import subprocess
import sys
import time
from pathlib import Path

import export_toy
import numpy as np
import pytest
import render_toy

from unshade.camera.camera import Camera, look_at
from unshade.cycles import description, interpreter
from unshade.cycles import relight as judge
from unshade.errors import RendererError
from unshade.files.pictures import read_exr, read_gray
from unshade.render import lights
from unshade.render.lights import conventions
from unshade.render.scene import ChartMaps
from unshade.render.truth_scene import captured_scene
from unshade.scene_file import Light, parse_scene
from unshade.scene_file.light import PointLight
from unshade.surface import Mesh, Surface


@pytest.fixture(scope="module")
def capture(tmp_path_factory):
    return export_toy.captured(tmp_path_factory.mktemp("cycles"), samples=100)


def relit(capture, out, maps=None, **scales):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(judge, "build_head", render_toy.toy_face)
        judge.relight(
            captured_scene(capture), maps or capture / "truth", out,
            scales=scales or {"none": 1.0}, progress=export_toy.no_progress, warn=export_toy.no_warning,
        )  # fmt: skip
    return out


def layer(path, name):
    planes = read_exr(path)
    return np.stack([planes[f"{name}.{c}"] for c in "RGB"], -1)


def test_both_renderers_see_the_same_face(capture, tmp_path):
    export_toy.needs_blender()
    out = relit(capture, tmp_path / "relit")
    mask = read_gray(capture / "masks/003.png") > 0
    for light in ("studio", "uniform"):
        theirs, ours = out / "none" / light / "003.exr", capture / "truth/relit" / light / "003.exr"
        for name, tolerance in (("diffuse", 0.02), ("specular", 0.05)):
            ratio = layer(theirs, name)[mask].mean() / layer(ours, name)[mask].mean()
            assert ratio == pytest.approx(1, abs=tolerance), (light, name)
        # The noise of few samples is what is left: within four of its own deviations nearly everywhere.
        deviation = np.sqrt(layer(theirs, "variance") + layer(ours, "variance")) + 1e-4
        total = [layer(path, "diffuse") + layer(path, "specular") for path in (theirs, ours)]
        assert np.median(np.abs(total[0] - total[1])[mask] / deviation[mask]) < 1.5
        assert (layer(theirs, "variance")[mask] > 0).any()
    document = json.loads((out / "relit.json").read_text())
    assert document["renderer"] == "cycles" and document["samples"] == 100


def test_equal_factors_are_rendered_once_and_others_scale(capture, tmp_path):
    export_toy.needs_blender()
    out = relit(capture, tmp_path / "relit", none=1.0, twin=1.0, half=0.5)
    one, twin, half = (out / scale / "uniform/003.exr" for scale in ("none", "twin", "half"))
    assert one.read_bytes() == twin.read_bytes()
    mask = read_gray(capture / "masks/003.png") > 0
    # Half the albedo, and a little less than half the light between its parts.
    assert layer(half, "diffuse")[mask].mean() / layer(one, "diffuse")[mask].mean() == pytest.approx(0.49, abs=0.02)


def test_an_exported_blend_renders_as_the_maps(capture, tmp_path):
    export_toy.needs_blender()
    (row,) = export_toy.exported(capture, tmp_path / "asset", "blender")
    assert row["material"] == "cycles" and row["light"] == "studio"
    assert row["psnr_srgb"] > row["psnr_noise"] - 3
    assert row["diffuse_ratio"] == pytest.approx(1, abs=0.02)
    assert (tmp_path / "asset/face.blend").stat().st_size > 10_000


def test_without_blender_the_fix_is_named(monkeypatch, tmp_path):
    monkeypatch.setenv("UNSHADE_BLENDER", str(tmp_path / "nowhere"))
    with pytest.raises(RendererError, match="UNSHADE_BLENDER=.*nowhere: is not a program"):
        interpreter.command()
    monkeypatch.delenv("UNSHADE_BLENDER")
    monkeypatch.setattr(interpreter, "FOLDER", "no-such-folder")
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(RendererError, match="make cycles"):
        interpreter.command()


def test_a_renderer_that_dies_leaves_its_last_words(monkeypatch, tmp_path):
    program = tmp_path / "python"
    program.write_text('#!/bin/sh\necho \'{"done": "one"}\'\necho no space left\nexit 7\n')
    program.chmod(0o755)
    monkeypatch.setenv("UNSHADE_BLENDER", str(program))
    heard = []
    with pytest.raises(RendererError, match="ended with 7: no space left"):
        interpreter.run(tmp_path / "job.json", heard.append)
    assert heard == [{"done": "one"}]


def blender_direction(row, column, height, width):
    """Where a texel of an equirectangular picture lies in our world, by Cycles' own formula."""
    u, v = (column + 0.5) / width, 1 - (row + 0.5) / height
    azimuth, elevation = 2 * np.pi * (0.5 - u), np.pi * (v - 0.5)
    x, y, z = np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)
    # Their Z is our Y, their -Y our Z.
    return np.array([x, z, -y])


@pytest.mark.parametrize("direction", [(0.9, 0.1, 0.2), (-0.3, -0.8, 0.4), (0.1, 0.2, -0.9)])
def test_environments_keep_their_directions_and_energy(direction):
    picture = np.zeros((64, 128, 3))
    conventions.deposit(picture, np.array(direction), np.ones(3))
    converted = description.equirectangular(picture.astype(np.float32))
    height, width = converted.shape[:2]
    rows, columns = np.nonzero(converted[..., 0])
    solid = 2 * np.pi**2 / (height * width) * np.sin(np.pi * (rows + 0.5) / height)
    energy = converted[rows, columns, 0] * solid
    places = np.array([blender_direction(r, c, height, width) for r, c in zip(rows, columns)])
    mean = export_toy.unit(energy @ places)
    assert energy.sum() == pytest.approx(1, rel=0.03)
    np.testing.assert_allclose(mean, export_toy.unit(np.array(direction)), atol=0.02)


def area(lamp):
    data = np.load(lamp["file"])
    a, b, c = (data["vertices"][data["triangles"][:, k]] for k in range(3))
    return np.cross(b - a, c - a) / 2


@pytest.mark.parametrize("kind", ["studio", "point", "sun"])
def test_lamps_give_the_irradiance_of_the_lights(tmp_path, kind):
    settings = {"settings": PointLight()} if kind == "point" else {}
    chart = render_toy.toy_face().chart
    scene_light = Light("light", kind, **settings) if kind != "sun" else parsed_sun()
    light = lights.exposed(scene_light, chart.vertices, chart.normals)
    described = description.write_light(tmp_path, "light", light)
    normal = export_toy.unit(np.array([0.2, 0.3, 1.0]))
    expected = light.irradiance(np.zeros((1, 3)), normal[None])[0]
    found = np.zeros(3)
    for lamp in described["lamps"]:
        data = np.load(lamp["file"])
        centres = data["vertices"][data["triangles"]].mean(1)
        areas = area(lamp)
        distance2 = (centres**2).sum(1)
        towards = centres / np.sqrt(distance2)[:, None]
        facing = (-(areas * towards).sum(1)).clip(0) * (towards @ normal).clip(0)
        found += (facing / distance2).sum() * np.array(lamp["radiance"])
    if "background" in described:
        found += light.sky.irradiance(np.zeros((1, 3)), normal[None])[0]
    # Two triangles of a panel are summed at their centres.
    np.testing.assert_allclose(found, expected, rtol=0.06 if kind == "studio" else 0.01)


def parsed_sun():
    table = render_toy.toy_table() | {"light": {"name": "sun", "kind": "sun"}}
    return parse_scene(table, "toy", Path()).light


def test_a_renderer_ends_with_the_process_that_started_it(tmp_path):
    """The child ends with the process that started it, however that one ends."""
    export_toy.needs_blender()
    mesh = render_toy.toy_face().chart
    surface = Surface(
        Mesh(mesh.vertices, mesh.normals, mesh.uv, mesh.triangles.astype(np.int64)), ChartMaps(np.full((8, 8, 3), 0.5))
    )
    job = description.write_job(
        tmp_path,
        meshes=description.write_meshes(tmp_path, surface, []),
        lights=[{"name": "dome", "lamps": [], "background": {"radiance": [1.0, 1.0, 1.0]}}],
        views=[
            description.view(
                Camera("view", 512, 512, 900.0, look_at(np.array([0, 0, 0.6]), np.zeros(3)), False), {"dome": [1]}
            )
        ],
        samples=1_000_000,
        depth=6,
        out=str(tmp_path / "pictures"),
    )
    code = "import sys; from pathlib import Path; from unshade.cycles import interpreter; interpreter.run(Path(sys.argv[1]), print)"
    parent = subprocess.Popen([sys.executable, "-c", code, str(job)])
    child = waited(lambda: children(parent.pid))
    parent.kill()
    parent.wait()
    assert waited(lambda: has_ended(child[0]))


def has_ended(pid):
    """Gone, or a zombie that nobody has asked after."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] == "Z"
    except FileNotFoundError:
        return True


def children(pid):
    return [int(word) for word in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def waited(what):
    """What ``what`` says once it says something, within a minute."""
    for _ in range(600):
        if found := what():
            return found
        time.sleep(0.1)
    return None

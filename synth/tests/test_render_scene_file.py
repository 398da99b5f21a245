"""Scene files: what is wrong is named, with its place and the mend; what is right returns."""

from pathlib import Path

import pytest

from unshade.errors import SceneError, UnshadeError
from unshade.render.scene_text import scene_text
from unshade.scene_file import parse_scene, read_scene


def table():
    return {
        "format": 1,
        "name": "a \"b\" \\ ü",
        "face": {"name": "f", "seed": 3},
        "light": {"name": "sky", "kind": "envmap", "path": "sky.exr", "rotation_degrees": 30, "clamp": 50.0},
        "relight": [{"name": "uniform", "kind": "dome", "exposure": 0.5}, {"name": "flash", "kind": "flash"}],
        "rig": {"name": "phone", "kind": "phone", "train": 4},
        "render": {"width": 64, "height": 48, "samples": 32},
    }


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "sky.exr").write_bytes(b"")
    return tmp_path


def test_a_scene_survives_writing_and_reading(folder):
    scene = parse_scene(table(), "scene", folder)
    assert scene.face.fitzpatrick and scene.render.depth == 6 and scene.light.rotation_degrees == 30
    (folder / "scene.toml").write_text(scene_text(scene))
    assert read_scene(folder / "scene.toml") == scene


def broken(**changes):
    """A table with values at dotted places replaced, or dropped where the value is None."""
    result = table()
    for place, value in changes.items():
        *path, key = place.split("__")
        target = result
        for step in path:
            target = target[int(step)] if step.isdigit() else target[step]
        if value is None:
            del target[key]
        else:
            target[key] = value
    return result


FAULTS = {
    "format is 2": broken(format=2),
    "unknown key 'lights' in scene; did you mean 'light'": broken(lights=1),
    "table [face] is missing": broken(face=None),
    "[rig] is missing": broken(rig="phone"),
    "unknown key 'sample' in [render] of scene; did you mean 'samples'": broken(render__sample=3),
    "width in [render] of scene is missing": broken(render__width=None),
    "width in [render] of scene is 3": broken(render__width=3),
    "height in [render] of scene is 64.5; use a whole number": broken(render__height=64.5),
    "samples in [render] of scene is 17, which stratified passes cannot share; use 18": broken(render__samples=17),
    "variant in [render] of scene is 'cuda'; use one of auto": broken(render__variant="cuda"),
    "kind in [light] of scene is 'lamp'; use one of dome, studio": broken(light__kind="lamp"),
    "there is no picture": broken(light__path="moon.exr"),
    "unknown key 'clamp' in [[relight]] number 1 of scene": broken(relight__0__clamp=3),
    "exposure in [[relight]] number 1 of scene is -1; use a number above 0": broken(relight__0__exposure=-1),
    "two lights are named 'flash'": broken(relight__0__name="flash"),
    "name in [[relight]] number 2 of scene is 'a/b'": broken(relight__1__name="a/b"),
    "max_angle_degrees in [rig] of scene is 120": broken(rig__max_angle_degrees=120),
    "distance_metres in [rig] of scene is 0.1": broken(rig__distance_metres=0.1),
    "train in [rig] of scene is True": broken(rig__train=True),
    "rotation_degrees in [light] of scene is nan": broken(light__rotation_degrees=float("nan")),
    "unknown key 'sed' in [face] of scene; did you mean 'seed'": broken(face__sed=1),
    "name in scene is missing": broken(name=None),
}


@pytest.mark.parametrize("message", FAULTS)
def test_faults_are_named(message, folder):
    with pytest.raises(UnshadeError) as caught:
        parse_scene(FAULTS[message], "scene", folder)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_files_that_are_no_scene(tmp_path):
    with pytest.raises(SceneError, match="none.toml: cannot be read"):
        read_scene(Path("none.toml"))
    (tmp_path / "bad.toml").write_text("a = = 1")
    with pytest.raises(SceneError, match="bad.toml: is not valid TOML"):
        read_scene(tmp_path / "bad.toml")

"""Scene files: faults are named with their place and the fix; sound scenes survive writing and reading."""

import sys
from pathlib import Path

import pytest

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

from unshade.errors import SceneError, UnshadeError
from unshade.render.scene_text import scene_text
from unshade.scene_file import parse_scene, read_scene


def table():
    return {
        "format": 1,
        "name": 'a "b" \\ ü',
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


def test_old_texts_keep_their_keys():
    """Scenes of before: no key appears that their authors did not know."""
    old = table() | {"light": {"name": "studio", "kind": "studio"}, "relight": []}
    text = scene_text(parse_scene(old, "scene", Path()))
    between = lambda start, end: text.split(start)[1].split(end)[0].split("\n")
    assert between("[light]\n", "\n\n") == ['name = "studio"', 'kind = "studio"', "exposure = 1.0"]
    assert [line.split(" = ")[0] for line in between("[rig]\n", "\n\n")] == [
        "name", "kind", "train", "test", "max_angle_degrees", "seed", "distance_metres", "fov_degrees",
    ]  # fmt: skip


@pytest.mark.parametrize("kind", ["phone", "emily", "desktop", "dome"])
@pytest.mark.parametrize("keys", [{}, {"withheld": ["002"]}])
def test_every_rig_survives_writing_and_reading(kind, keys, folder):
    scene = parse_scene(table() | {"rig": {"name": "r", "kind": kind} | keys}, "scene", folder)
    (folder / "scene.toml").write_text(scene_text(scene))
    assert read_scene(folder / "scene.toml") == scene


LIGHTS = [
    {"kind": "key", "azimuth_degrees": -30, "size_metres": 1},
    {"kind": "two-colour", "left": [1, 0.5, 0]},
    {"kind": "sun", "turbidity": 5, "elevation_degrees": 10.5},
    {"kind": "point", "radius_metres": 0.01},
    {"kind": "gradient", "axis": "y-"},
    {"kind": "pattern", "pattern": "hadamard", "order": 8, "index": 7, "inverse": True},
]


def test_every_light_survives_writing_and_reading(folder):
    relight = [{"name": f"{i}"} | light for i, light in enumerate(LIGHTS)]
    scene = parse_scene(table() | {"relight": relight}, "scene", folder)
    for light, given in zip(scene.relight, relight):
        assert {key: getattr(light.settings, key) for key in given if key not in ("name", "kind")} == {
            key: tuple(value) if isinstance(value, list) else value
            for key, value in given.items()
            if key not in ("name", "kind")
        }
    (folder / "scene.toml").write_text(scene_text(scene))
    assert read_scene(folder / "scene.toml") == scene


SCENES = Path(__file__).parents[2] / "scenes"


FILES = [path for table in ("faces", "lights", "rigs") for path in sorted(SCENES.glob(f"{table}/*.toml"))]


@pytest.mark.parametrize("path", FILES, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_the_files_of_scenes_are_read(path):
    kind = path.parent.name[:-1]
    given = tomllib.loads(path.read_text())
    base = table() | {"light": {"name": "l", "kind": "dome"}, "relight": []}
    # A file that comes along, so that a fresh checkout or wheel renders every light.
    assert not Path(given.get("path", "")).is_absolute()
    scene = parse_scene(base | {kind: given}, "scene", path.parent)
    assert getattr(scene, kind).name == path.stem


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
    "turbidity in [light] of scene is 11; use a number from 1 to 10": broken(
        light={"name": "s", "kind": "sun", "turbidity": 11}
    ),
    "unknown key 'azimut' in [light] of scene; did you mean 'azimuth_degrees'": broken(
        light={"name": "k", "kind": "key", "azimut": 1}
    ),
    "left in [light] of scene is [0, 0, 0]; use three": broken(
        light={"name": "t", "kind": "two-colour", "left": [0, 0, 0]}
    ),
    "axis in [light] of scene is 'w+'; use one of full, x+": broken(
        light={"name": "g", "kind": "gradient", "axis": "w+"}
    ),
    "order in [light] of scene is 12; use one of 2, 4": broken(
        light={"name": "p", "kind": "pattern", "pattern": "hadamard", "order": 12}
    ),
    "but order 8 has rows 0 to 7": broken(
        light={"name": "p", "kind": "pattern", "pattern": "hadamard", "order": 8, "index": 8}
    ),
    "inverse in [light] of scene is 1; use true or false": broken(light={"name": "p", "kind": "pattern", "inverse": 1}),
    "withheld in [rig] of scene names '040', but the views are 000 to 005": broken(rig__withheld=["040"]),
    "withheld in [rig] of scene is '003'; use a list": broken(rig__withheld="003"),
    "names a view twice": broken(rig__withheld=["003", "003"]),
    "names all 9 views": broken(rig={"name": "e", "kind": "emily", "withheld": [f"00{i}" for i in range(9)]}),
    "unknown key 'train' in [rig] of scene": broken(rig={"name": "d", "kind": "desktop", "train": 3}),
    "max_angle_degrees in [rig] of scene is 88; use at most 85": broken(
        rig={"name": "d", "kind": "dome", "max_angle_degrees": 88}
    ),
    "both equivalent_mm and fov_degrees": broken(rig__equivalent_mm=26, rig__fov_degrees=20),
    "name in scene is missing": broken(name=None),
}


@pytest.mark.parametrize("message", FAULTS)
def test_faults_are_named(message, folder):
    with pytest.raises(UnshadeError) as caught:
        parse_scene(FAULTS[message], "scene", folder)
    text, key, table = str(caught.value), caught.value.key, caught.value.table
    assert message in text and "\n" not in text
    assert key is None or (key in text and (f"[{table}]" in text or not table))


def test_files_without_a_scene_are_refused(tmp_path):
    with pytest.raises(SceneError, match="none.toml: cannot be read"):
        read_scene(Path("none.toml"))
    (tmp_path / "bad.toml").write_text("a = = 1")
    with pytest.raises(SceneError, match="bad.toml: is not valid TOML"):
        read_scene(tmp_path / "bad.toml")

"""The error budget of a relit view: Shapley values, and planted errors given to the map they are in."""

from __future__ import annotations

import itertools
import json
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from unshade.files.pictures import read_exr, write_exr

PLAYERS = ("a", "b", "c", "d")


def test_shapley_values_are_the_mean_over_all_orders() -> None:
    from unshade.render.error_budget import shapley, subsets

    random = np.random.default_rng(1)
    worth = {frozenset(mix): float(random.random()) for mix in subsets(PLAYERS)}
    added: dict[str, list[float]] = {player: [] for player in PLAYERS}
    for order in itertools.permutations(PLAYERS):
        for place, player in enumerate(order):
            before = frozenset(order[:place])
            added[player].append(worth[before | {player}] - worth[before])
    found = shapley(worth, PLAYERS)
    assert found == pytest.approx({player: np.mean(values) for player, values in added.items()})
    assert sum(found.values()) == pytest.approx(worth[frozenset(PLAYERS)] - worth[frozenset()])


@pytest.fixture(scope="module")
def capture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    import unshade

    root = tmp_path_factory.mktemp("budget")
    scene = root / "scene.toml"
    scene.write_text(
        'format = 1\nname = "tiny"\nlight = { name = "studio", kind = "studio" }\n'
        'face = { name = "tiny", seed = 5, fitzpatrick = "II", texture_size = 64 }\n'
        'rig = { name = "few", kind = "phone", train = 2, test = 1, seed = 2 }\n'
        "[render]\nwidth = 48\nheight = 48\nsamples = 16\ndepth = 3\n"
    )
    unshade.synth(scene, root / "capture")
    return root / "capture"


def _change(path: Path, change: Callable[[str, np.ndarray], np.ndarray]) -> None:
    """Writes the planes of a picture anew, each changed."""
    changed = {name: change(name, plane) for name, plane in read_exr(path).items()}
    colour = {"": np.stack([changed[name] for name in "RGB"], -1)} if set("RGB") <= changed.keys() else changed
    write_exr(path, colour)


@pytest.mark.parametrize("planted", ["diffuse_albedo", "specular_albedo", "specular_normal", "roughness"])
def test_a_planted_error_is_given_to_the_map_it_is_in(capture: Path, tmp_path: Path, planted: str) -> None:
    import unshade

    maps, out = tmp_path / "maps", tmp_path / "budget"
    maps.mkdir()
    for name in ("diffuse_albedo", "specular_albedo", "diffuse_normal", "specular_normal", "roughness"):
        shutil.copyfile(capture / "truth" / f"{name}.exr", maps / f"{name}.exr")
    slope = np.linspace(-1, 1, 64, dtype=np.float32)[:, None]
    # Another map is off by some thousandths, so that the planted error has company.
    company = "specular_albedo" if planted == "diffuse_albedo" else "diffuse_albedo"
    _change(maps / f"{company}.exr", lambda name, plane: plane * (1 + 0.003 * slope))
    if planted == "specular_normal":
        values = read_exr(maps / f"{planted}.exr")
        tilted = np.stack([values[name] for name in "RGB"], -1) + np.float32([0.25, 0, 0])
        write_exr(maps / f"{planted}.exr", {"": tilted / np.linalg.norm(tilted, axis=-1, keepdims=True)})
    elif planted == "roughness":
        _change(maps / f"{planted}.exr", lambda name, plane: plane * (0.6 if "alpha" in name else 1))
    else:
        _change(maps / f"{planted}.exr", lambda name, plane: plane * (1 + 0.4 * slope))
    rows = {row["map"]: row for row in unshade.budget(capture, maps, out)}
    culprit = {"specular_normal": "normals"}.get(planted, planted.replace("_", " "))
    fraction = rows[culprit]["share"]
    assert fraction is not None and fraction > 0.9, rows
    document = json.loads((out / "budget.json").read_text())
    assert sum(row["squared_error"] for row in document["maps"]) == pytest.approx(document["squared_error"], rel=1e-9)
    assert len(document["mixes"]) == 16 and rows[culprit]["gain_db"] > 9
    assert (out / "budget.md").is_file() and (out / "budget.png").is_file()


def test_a_light_that_is_not_there_is_named(capture: Path, tmp_path: Path) -> None:
    import unshade
    from unshade.errors import SceneError

    with pytest.raises(SceneError, match="no light 'moon'; there are studio"):
        unshade.budget(capture, capture / "truth", tmp_path / "out", light="moon")
    assert not (tmp_path / "out").exists()

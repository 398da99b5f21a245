"""The share of each map in the error of a relit view.

The view is rendered once for every choice of maps that are the method's, the others being the true ones, all
with the same random numbers. A map's share is its Shapley value: the mean, over all orders in which the true
maps can be replaced by the method's, of what its replacement adds to the squared error. The shares sum to the
whole error. Shapley 1953; for errors of a chain of stages: Owen 2014.
"""

from __future__ import annotations

import io
import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image
from scipy.ndimage import binary_erosion

from ..errors import SceneError
from ..files.array_store import ArrayStore
from ..files.folder import ResumableFolder, content_hash
from ..files.pictures import read_gray, write_bytes, write_exr, write_json, write_text
from ..fingerprint import fingerprint
from ..heads import build_head
from ..scene_file import Scene
from ..srgb import encoded
from .layers import Layers
from .meter import Meter, Progress
from .passes import seed_of
from .relight import MAP_FILES, read_maps
from .rigs import cameras, light_of_view
from .scene import ChartMaps
from .scene_text import scene_text
from .shots import Shots

PLAYERS = {
    "diffuse albedo": ("diffuse_albedo",),
    "specular albedo": ("specular_albedo",),
    "normals": ("diffuse_normal", "specular_normal"),
    "roughness": ("roughness",),
}
"""Maps that are replaced together."""

_EROSION = 5
"""Side (pixels) of the square that erodes the mask, as in scores."""


def shapley(worth: Mapping[frozenset[str], float], players: Sequence[str]) -> dict[str, float]:
    """Shapley values of a game: ``worth`` of every set of players; they sum to ``worth`` of all less that of none."""
    count = len(players)
    weights = [math.factorial(k) * math.factorial(count - k - 1) / math.factorial(count) for k in range(count)]
    return {
        player: sum(
            weights[len(others)] * (worth[frozenset(others) | {player}] - worth[frozenset(others)])
            for others in subsets([other for other in players if other != player])
        )
        for player in players
    }


def subsets(players: Sequence[str]) -> list[tuple[str, ...]]:
    """Every set of players, small ones first."""
    return [chosen for size in range(len(players) + 1) for chosen in itertools.combinations(players, size)]


def write_budget(
    scene: Scene,
    capture: Path,
    maps: Path,
    out: Path,
    *,
    light: str | None,
    view: str | None,
    factor: float,
    progress: Progress,
    warn: Callable[[str], None],
) -> dict:
    """Writes ``out/budget.json``, ``budget.md`` and pictures; returns the content of the JSON.

    ``factor`` multiplies the diffuse albedo of ``maps``. Errors are mean squares over the eroded mask and the
    channels of linear values, estimated from independent halves of the samples, so that noise which the maps
    themselves change is in none of them. Raises `SceneError` for a light or view that there is not.
    """
    chosen_light = _named(scene.lights, light or scene.light.name, "light")
    withheld = [camera for camera in cameras(scene.rig, scene.render.width, scene.render.height) if not camera.train]
    camera = _named(withheld, view or withheld[0].name, "withheld view")
    shining = light_of_view(scene, chosen_light, camera)
    truth, found = read_maps(capture / "truth", warn), read_maps(maps, warn)
    found = replace(found, diffuse_albedo=found.diffuse_albedo * np.float32(factor))
    hashes = [content_hash(folder / f"{name}.exr") for folder in (capture / "truth", maps) for name in MAP_FILES]
    key = [scene_text(scene), fingerprint(__name__), *hashes, repr(factor), chosen_light.name, camera.name]
    folder = ResumableFolder(out, "\n".join(key))
    mixes = subsets(list(PLAYERS))
    meter = Meter(progress, len(mixes), scene.render.width * scene.render.height * scene.render.samples)
    meter.note("face")
    face = build_head(scene.face)
    seeds = [seed_of("budget", scene.render.seed, chosen_light.name, name) for name in (camera.name, "shared")]
    pictures: dict[frozenset[str], Layers] = {}
    model = None
    true = {player for player in PLAYERS if _same(truth, found, PLAYERS[player])}
    for mix in mixes:
        report = meter.begin(f"{' + '.join(mix) or 'truth'} of the method")
        differs = frozenset(mix) - true
        if differs in pictures:  # the others are the true maps whosever they are
            pictures[frozenset(mix)] = pictures[differs]
            continue
        shots = Shots(face, mixed(truth, found, mix), scene.render, ArrayStore.of_user())
        # The light's exposure is the face's, whatever its maps.
        model = model or shots.light(replace(shining, to_head=None))
        shots.set_light(shining.name, model)
        pictures[frozenset(mix)] = shots.layers(shining, camera, *seeds, report)
    mask = read_gray(capture / "masks" / f"{camera.name}.png") > 127
    inside = binary_erosion(mask, np.ones((_EROSION, _EROSION)))
    halves = {mix: _halves(layers) for mix, layers in pictures.items()}
    exact = halves[frozenset()]
    worth = {mix: _error(half, exact, inside) for mix, half in halves.items()}
    document = _document(worth, chosen_light.name, camera.name, factor)
    write_json(folder.path / "budget.json", document)
    write_text(folder.path / "budget.md", _page(document))
    for mix in (*((name,) for name in PLAYERS), tuple(PLAYERS), ()):
        name = {0: "truth", len(PLAYERS): "method"}.get(len(mix), f"wrong-{mix[0].replace(' ', '-')}" if mix else "")
        write_exr(folder.path / f"{name}.exr", {"": pictures[frozenset(mix)].total})
    write_bytes(folder.path / "budget.png", _strip(pictures, inside))
    folder.commit()
    return document


def mixed(truth: ChartMaps, found: ChartMaps, mix: Sequence[str]) -> ChartMaps:
    """The true maps, those of the players in ``mix`` replaced by the found ones (where none was found, by none)."""
    names = [name for player in mix for name in PLAYERS[player]]
    return replace(truth, **{name: getattr(found, name) for name in names})


def _same(truth: ChartMaps, found: ChartMaps, names: Sequence[str]) -> bool:
    """Whether the maps found are the true ones."""
    pairs = ((getattr(truth, name), getattr(found, name)) for name in names)
    return all(b is not None and np.array_equal(a, b) for a, b in pairs)


def _halves(layers: Layers) -> tuple[np.ndarray, np.ndarray]:
    total = layers.total.astype(np.float64)
    first = total if layers.half is None else layers.half.astype(np.float64)
    return first, 2 * total - first


def _error(halves, exact, inside: np.ndarray) -> float:
    """Mean of the product of the errors of both halves, over the mask."""
    first, second = (half - true for half, true in zip(halves, exact, strict=True))
    return float((first * second)[inside].mean())


def _named(choices, name: str, what: str):
    for choice in choices:
        if choice.name == name:
            return choice
    raise SceneError(f"no {what} {name!r}; there are {', '.join(choice.name for choice in choices)}")


def _document(worth: Mapping[frozenset[str], float], light: str, view: str, factor: float) -> dict:
    every = frozenset(PLAYERS)
    total = worth[every]
    contributions = shapley(worth, list(PLAYERS))
    rows = [
        {
            "map": player,
            "squared_error": contributions[player],
            "share": contributions[player] / total if total else None,
            "alone": worth[frozenset([player])],
            "gain_db": _decibels(worth[every - {player}]) - _decibels(total),
        }
        for player in PLAYERS
    ]
    mixes = [{"maps": [player for player in PLAYERS if player in mix], "squared_error": worth[mix]} for mix in worth]
    return {
        "format": 1, "light": light, "view": view, "factor": factor, "squared_error": total,
        "psnr_lin": _decibels(total), "maps": rows, "mixes": mixes,
    }  # fmt: skip


def _decibels(error: float) -> float:
    """At most 100, as in scores."""
    return min(-10 * math.log10(error), 100.0) if error > 0 else 100.0


def _page(document: dict) -> str:
    lines = [
        "# Error budget of a relit view",
        "",
        f"View {document['view']}, light {document['light']}, diffuse albedo after the factor {document['factor']:.4f}: "
        f"{document['psnr_lin']:.2f} dB of linear values without noise. Shares are Shapley values of the squared error, "
        "and sum to it; *alone* is the error of a view in which this map alone is the method's; *gain* is what the "
        "true map in its place would bring.",
        "",
        "| map | share | squared error | alone | gain, dB |",
        "|---|---|---|---|---|",
    ]
    for row in document["maps"]:
        percent = "none" if row["share"] is None else f"{100 * row['share']:.1f} %"
        numbers = f"{row['squared_error']:.3e} | {row['alone']:.3e} | {row['gain_db']:.2f}"
        lines.append(f"| {row['map']} | {percent} | {numbers} |")
    lines.append(f"| all | 100 % | {document['squared_error']:.3e} | {document['squared_error']:.3e} | |")
    pictures = "![The true view, the method's, and the errors of each map alone and of all, eight times](budget.png)"
    return "\n".join([*lines, "", pictures, ""])


def _strip(pictures, inside: np.ndarray) -> bytes:
    """Truth, the method's view, then errors times eight around grey: of each map alone, and of all. A PNG."""
    exact, found = (pictures[frozenset(mix)].total for mix in ((), PLAYERS))
    alone = [pictures[frozenset([player])].total for player in PLAYERS]
    errors = [
        np.where(inside[..., None], 0.5 + 8 * (_srgb(picture) - _srgb(exact)), 0.5) for picture in (*alone, found)
    ]
    row = np.concatenate([_srgb(exact), _srgb(found), *errors], axis=1)
    file = io.BytesIO()
    Image.fromarray((row.clip(0, 1) * 255 + 0.5).astype(np.uint8)).save(file, format="PNG")
    return file.getvalue()


def _srgb(picture: np.ndarray) -> np.ndarray:
    return encoded(picture.astype(np.float64).clip(0, 1))

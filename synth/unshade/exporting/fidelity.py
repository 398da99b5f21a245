"""How far an asset is from the maps that it was made of: both rendered in the same light and camera."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .. import _native
from ..camera.camera import Camera, look_at
from ..face import Part
from ..heads import build_head
from ..metrics import psnr_srgb
from ..render import lights
from ..render.layers import Layers
from ..render.passes import render_layers, seed_of
from ..render.probes import view_through_centres
from ..render.rigs import cameras, light_of_view
from ..render.scene import HeadScene
from ..render.truth_scene import captured_scene
from ..scene_file import Light
from ..surface import Surface
from .blender import render_blend
from .texture_files import srgb, write_png

PROTOCOL = {
    "id": "unshade-fidelity-1",
    "statements": [
        "The asset is read back from its files and rendered beside the maps themselves, which have the material of the "
        "relit pictures: in the lights and the first withheld view of a synthetic capture, with the other parts of its head; "
        "of photographs in the studio light; of a mesh alone from the front, in the same light from everywhere.",
        "Of Mitsuba both pictures have the same samples and seeds, so equal materials give equal pictures. Cycles draws "
        "other samples: psnr_noise is the PSNR that two pictures of the maps with other seeds have to each other.",
        "psnr_srgb: on the pixels where the face is the first surface, eroded once by 5x5; null where nothing differs.",
        "diffuse_ratio, specular_ratio: mean of the asset's layer over mean of the maps' layer, on the same pixels.",
    ],
}

_SAMPLES = 64
_CYCLES_SAMPLES = 256
_DEPTH = 6
_PIXELS = 256

Report = Callable[[int, int, str], None]


@dataclass(frozen=True)
class Setting:
    """Where an asset is shown and compared: the head's other parts, lights by name, the camera, and the depth of paths."""

    parts: list[Part]
    lights: dict[str, lights.AnyLight]
    camera: Camera
    depth: int


def setting_of(capture: Path | None, surface: Surface) -> Setting:
    """A capture's own lights and first withheld view; photographs get the studio, a mesh alone a dome."""
    vertices, normals = surface.mesh.vertices, surface.mesh.normals
    if capture is None:
        # In any units and at any place.
        low, high = vertices.min(0).astype(float), vertices.max(0).astype(float)
        middle, reach = (low + high) / 2, float(np.linalg.norm(high - low))
        camera = Camera("front", _PIXELS, _PIXELS, 2.0 * _PIXELS, look_at(middle + [0, 0, 2.2 * reach], middle), False)
        return Setting([], {"uniform": lights.exposed(Light("uniform", "dome"), vertices, normals)}, camera, _DEPTH)
    if (capture / "truth" / "scene.toml").is_file():
        scene = captured_scene(capture)
        face = build_head(scene.face)
        views = cameras(scene.rig, scene.render.width, scene.render.height)
        view = next((v for v in views if not v.train), views[0])
        shining = {light.name: light_of_view(scene, light, view) for light in scene.lights}
        exposed = {
            name: lights.exposed(light, face.chart.vertices, face.chart.normals) for name, light in shining.items()
        }
        return Setting(face.parts, exposed, view, scene.render.depth)
    stated = _native.Capture(capture)
    name = [*stated.withheld, *stated.train][0]
    view = stated.camera(name)
    camera = Camera(name, view["width"], view["height"], view["focal"][0], view["camera_to_world"].astype(float), False)
    return Setting([], {"studio": lights.exposed(Light("studio", "studio"), vertices, normals)}, camera, _DEPTH)


def reference(setting: Setting, surface: Surface) -> HeadScene:
    """The maps as they are relit, on the asset's mesh."""
    return HeadScene(surface.mesh, setting.parts, surface.maps)


def compare(
    setting: Setting, ours: HeadScene, assets: dict[str, Any], pictures: Path, report: Report
) -> list[dict[str, Any]]:
    """One row per material of the asset and light. ``assets`` are Mitsuba shapes; pictures go to a folder."""
    rows: list[dict[str, Any]] = []
    heads = {name: HeadScene.around(shape, setting.parts) for name, shape in assets.items()}
    mask = view_through_centres(ours, setting.camera).mask
    total = len(setting.lights) * (1 + len(heads))
    for light_name, light in setting.lights.items():
        report(len(rows), total, f"maps in {light_name}")
        truth = _render(ours, setting, light, light_name)
        for name, head in heads.items():
            report(len(rows), total, f"{name} in {light_name}")
            made = _render(head, setting, light, light_name)
            row = {"material": name, "light": light_name, "view": setting.camera.name, **differences(made, truth, mask)}
            rows.append({**row, "psnr_noise": None})
            _write_strip(pictures / f"{name}-{light_name}.png", truth.total, made.total)
    return rows


def compare_blend(
    setting: Setting, ours: HeadScene, blend: Path, pictures: Path, report: Report
) -> list[dict[str, Any]]:
    """The row of a .blend in its own light, rendered by Cycles."""
    name, light = next(iter(setting.lights.items()))
    mask = view_through_centres(ours, setting.camera).mask
    report(0, 3, f"maps in {name}")
    truth, again = (_render(ours, setting, light, name, _CYCLES_SAMPLES, attempt) for attempt in range(2))
    report(2, 3, f"Cycles in {name}")
    made = render_blend(blend, setting.parts, name, setting.camera, setting.depth, _CYCLES_SAMPLES)
    _write_strip(pictures / f"cycles-{name}.png", truth.total, made.total)
    noise = psnr_srgb(again.total, truth.total, mask, erode=True)
    row = {"material": "cycles", "light": name, "view": setting.camera.name, **differences(made, truth, mask)}
    return [{**row, "psnr_noise": noise}]


def differences(made: Layers, truth: Layers, mask: np.ndarray) -> dict[str, float | None]:
    """The numbers of a row; see `PROTOCOL`."""
    psnr = None if np.array_equal(made.total, truth.total) else psnr_srgb(made.total, truth.total, mask, erode=True)
    return {
        "psnr_srgb": psnr,
        "diffuse_ratio": _ratio(made.diffuse[mask], truth.diffuse[mask]),
        "specular_ratio": _ratio(made.specular[mask], truth.specular[mask]),
    }


def _render(
    head: HeadScene, setting: Setting, light: lights.AnyLight, name: str, samples: int = _SAMPLES, attempt: int = 0
) -> Layers:
    sensor, seed = setting.camera.sensor(samples), seed_of("fidelity", name, attempt)
    return render_layers(head.lit(light), sensor, samples=samples, depth=setting.depth, seed=seed)


def _ratio(made: np.ndarray, truth: np.ndarray) -> float | None:
    whole = float(truth.mean())
    return float(made.mean()) / whole if whole > 0 else None


def _write_strip(path: Path, truth: np.ndarray, made: np.ndarray) -> None:
    """Maps, asset, and four times their difference round grey."""
    pictures = [srgb(truth), srgb(made), 0.5 + 4 * (srgb(made) - srgb(truth))]
    write_png(path, np.concatenate(pictures, 1), 8)


def line(row: dict[str, Any]) -> str:
    """A row in words."""
    psnr = "no difference" if row["psnr_srgb"] is None else f"{row['psnr_srgb']:.1f} dB"
    layers = [
        f"{layer} {100 * (row[f'{layer}_ratio'] - 1):+.1f} %"
        for layer in ("diffuse", "specular")
        if row[f"{layer}_ratio"] is not None
    ]
    return f"{row['material']} in {row['light']}: {psnr} to the relit maps ({', '.join(layers)})"

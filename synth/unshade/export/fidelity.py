"""How far an asset is from the maps that it was made of: both rendered in the same light and camera."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .. import _native
from ..face import Part
from ..heads import build_head
from ..metrics import psnr_srgb
from ..render import lights
from ..render.camera import Camera
from ..render.layers import Layers
from ..render.passes import render_layers, seed_of
from ..render.probes import view_through_centres
from ..render.rigs import cameras
from ..render.scene import HeadScene
from ..render.truth_scene import captured_scene
from ..scene_file import Light
from .surface import Surface
from .texture_files import srgb, write_png

PROTOCOL = {
    "id": "unshade-fidelity-1",
    "statements": [
        "The asset is read back from its files and rendered in the light and the first withheld view of its capture, "
        "beside the maps themselves with the material of the relit pictures; both with the mesh of the capture, and "
        "with the other parts of the head where the capture is synthetic.",
        "Both pictures have the same samples and seeds, so equal materials give equal pictures.",
        "psnr_srgb: on the pixels where the face is the first surface, eroded once by 5x5; null where nothing differs.",
        "diffuse_ratio, specular_ratio: mean of the asset's layer over mean of the maps' layer, on the same pixels.",
    ],
}

_SAMPLES = 64
_DEPTH = 6

Report = Callable[[int, int, str], None]


@dataclass(frozen=True)
class Setting:
    """Where an asset is compared: the head's other parts, lights by name, the camera, and the depth of paths."""

    parts: list[Part]
    lights: dict[str, lights.AnyLight]
    camera: Camera
    depth: int


def setting_of(capture: Path, surface: Surface) -> Setting:
    """The capture's own lights and first withheld view; one that was photographed gets the studio."""
    vertices, normals = surface.mesh.vertices, surface.mesh.normals
    if (capture / "truth" / "scene.toml").is_file():
        scene = captured_scene(capture)
        face = build_head(scene.face)
        exposed = {light.name: lights.exposed(light, face.chart.vertices, face.chart.normals) for light in scene.lights}
        views = cameras(scene.rig, scene.render.width, scene.render.height)
        return Setting(face.parts, exposed, next((v for v in views if not v.train), views[0]), scene.render.depth)
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
    rows = []
    heads = {name: HeadScene.around(shape, setting.parts) for name, shape in assets.items()}
    mask = view_through_centres(ours, setting.camera).mask
    total = len(setting.lights) * (1 + len(heads))
    for light_name, light in setting.lights.items():
        report(len(rows), total, f"maps in {light_name}")
        truth = _render(ours, setting, light, light_name)
        for name, head in heads.items():
            report(len(rows), total, f"{name} in {light_name}")
            made = _render(head, setting, light, light_name)
            rows.append({"material": name, "light": light_name, "view": setting.camera.name, **differences(made, truth, mask)})
            _write_strip(pictures / f"{name}-{light_name}.png", truth.total, made.total)
    return rows


def differences(made: Layers, truth: Layers, mask: np.ndarray) -> dict[str, float | None]:
    """The numbers of a row; see `PROTOCOL`."""
    psnr = None if np.array_equal(made.total, truth.total) else psnr_srgb(made.total, truth.total, mask, erode=True)
    return {
        "psnr_srgb": psnr,
        "diffuse_ratio": _ratio(made.diffuse[mask], truth.diffuse[mask]),
        "specular_ratio": _ratio(made.specular[mask], truth.specular[mask]),
    }


def _render(head: HeadScene, setting: Setting, light: lights.AnyLight, name: str) -> Layers:
    sensor = setting.camera.sensor(_SAMPLES)
    return render_layers(head.lit(light), sensor, samples=_SAMPLES, depth=setting.depth, seed=seed_of("fidelity", name))


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

"""The experiment of docs/subsurface.md: the diffusion tier against the volume it stands for.

    python synth/bench/subsurface.py -o DIR [--size 128] [--samples 128] [--face scenes/faces/demo.toml]

Renders one face in every tier and several lights, compares the diffuse layers, and writes
its figures to DIR/subsurface.json, the picture to DIR/subsurface.jpg, and, unless told
otherwise, both into docs/.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import math
import os
import shutil
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
import half_space

from unshade.render import llvm

llvm.activate(llvm.choose("llvm_ad_rgb"))
from PIL import Image  # noqa: E402
from scipy.interpolate import RegularGridInterpolator  # noqa: E402
from scipy.ndimage import binary_erosion  # noqa: E402
from shadow_edge import ALBEDO, shadow_edges  # noqa: E402

from unshade.camera.camera import Camera, look_at  # noqa: E402
from unshade.face import FaceSpec, build_face  # noqa: E402
from unshade.face.labels import Label  # noqa: E402
from unshade.render import lights  # noqa: E402
from unshade.render.probes import nearest_texels, view_through_centres  # noqa: E402
from unshade.render.scene import ChartMaps, HeadScene  # noqa: E402
from unshade.render.tiers import profile, render_tier  # noqa: E402
from unshade.scene_file import Light, Render  # noqa: E402
from unshade.srgb import encoded  # noqa: E402

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).resolve().parents[2]
DOCUMENT, PICTURE = ROOT / "docs/subsurface.md", ROOT / "docs/subsurface.jpg"
START, END = "<!-- figures: written by synth/bench/subsurface.py -->", "<!-- end of figures -->"
LIGHTS = ("dome", "studio", "flash")
TIERS = ("opaque", "diffusion", "volume", "volume again", "short", "short again")
"""Pictures of a light. ``short``: the volume with a tenth of the path, which scatters as the
half space does but blurs next to nothing."""
CHANNELS = ("red", "green", "blue")


def main() -> None:
    options = _options()
    options.out.mkdir(parents=True, exist_ok=True)
    with options.face.open("rb") as file:
        table = tomllib.load(file) | {"texture_size": 1024}
    face = build_face(FaceSpec.from_table(table, place=str(options.face)))
    # Relief lives in a normal map, which the volume does not see: compare without it.
    maps = dataclasses.replace(ChartMaps.truth(face), diffuse_normal=None, specular_normal=None)
    camera = _camera(options.size)
    pictures, seconds = {}, {}
    for light in LIGHTS:
        head = HeadScene(face.chart, face.parts, maps)
        lit = head.lit(lights.exposed(Light(name=light, kind=light), face.chart.vertices, face.chart.normals))
        for tier in TIERS:
            path = tuple(v / 10 if "short" in tier else v for v in Render.subsurface_mm)
            kind = tier.split()[0].replace("short", "volume")
            render = Render(options.size, options.size, samples=options.samples, tier=kind, depth=8, subsurface_mm=path)
            clock = time.perf_counter(), time.process_time()
            progress = _Bar(f"{tier}, {light}")
            layers = render_tier(head, lit, camera.sensor(options.samples), render, TIERS.index(tier), progress)
            seconds[light, tier] = time.perf_counter() - clock[0], time.process_time() - clock[1]
            pictures[light, tier] = layers
    clock = time.perf_counter(), time.process_time()
    again = dataclasses.replace(render, tier="diffusion", subsurface_mm=Render.subsurface_mm)
    render_tier(head, lit, camera.sensor(options.samples), again, 9)
    seconds["again"] = time.perf_counter() - clock[0], time.process_time() - clock[1]
    regions = _regions(face, head, camera)
    figures = _figures(pictures, regions, _half_space_level(face, head, camera))
    text = _document(options, face, figures, seconds, pictures, regions)
    (options.out / "subsurface.json").write_text(json.dumps(figures, indent=1) + "\n")
    (options.out / "figures.md").write_text(text)
    _picture(pictures, regions, options.out / "subsurface.jpg")
    if options.docs:
        before, rest = DOCUMENT.read_text(encoding="utf-8").split(START)
        DOCUMENT.write_text(before + START + "\n" + text + END + rest.split(END)[1], encoding="utf-8")
        shutil.copyfile(options.out / "subsurface.jpg", PICTURE)
    print(text)


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--out", type=Path, required=True)
    parser.add_argument("--size", type=int, default=128, help="pixels along the picture's edge")
    parser.add_argument(
        "--samples", type=int, default=128, help="samples per pixel, of each of the volume's two pictures"
    )
    parser.add_argument("--face", type=Path, default=ROOT / "scenes/faces/demo.toml")
    parser.add_argument("--no-docs", dest="docs", action="store_false", help="leave docs/ as it is")
    return parser.parse_args()


class _Bar:
    """Progress on standard error: one line that is written over."""

    def __init__(self, what: str) -> None:
        self._what = what

    def __call__(self, done: int, total: int) -> None:
        end = "\n" if done == total else ""
        print(f"\r{self._what}: {100 * done // total:3d} %", end=end, file=sys.stderr, flush=True)


def _camera(size: int) -> Camera:
    """Three quarters from the front: one ear, both cheeks."""
    focal = size / (2 * math.tan(math.radians(10.5)))
    return Camera("000", size, size, focal, look_at(np.array([0.30, 0.04, 0.58]), np.array([0.0, -0.005, 0.03])), True)


def _regions(face, head, camera) -> dict[str, np.ndarray]:
    """Pixels [H, W] bool whose centre and neighbours see the region."""
    view = view_through_centres(head, camera)
    shape = view.mask.shape
    label = np.where(view.mask, nearest_texels(face.maps.labels, view.uv), 0)
    x, y, _ = (1000 * view.position[..., k] for k in range(3))
    skin = label == Label.SKIN
    regions = {
        "forehead": skin & (y > 28) & (np.abs(x) < 45),
        "cheek": skin & (y > -60) & (y < -8) & (np.abs(x) > 24) & (np.abs(x) < 62),
        "nose": label == Label.NOSE,
        "lips": label == Label.LIPS,
        "eyelids": label == Label.EYELID,
        "ear": label == Label.EAR,
        "whole face": label > 0,
    }
    assert all(region.shape == shape for region in regions.values())
    return {name: binary_erosion(region) for name, region in regions.items()}


def _half_space_level(face, head, camera) -> np.ndarray:
    """[H, W, 3] albedo over the radiance that a half space of the medium shows in even light
    towards the camera: the level to expect of a Lambert surface, were there nothing to blur."""
    view = view_through_centres(head, camera)
    albedo = nearest_texels(face.maps.diffuse_albedo, view.uv).clip(0.01, profile.HIGHEST_ALBEDO)
    normal = nearest_texels(face.maps.diffuse_normal, view.uv)
    towards = camera.position - view.position
    mu = ((normal * towards).sum(-1) / np.linalg.norm(towards, axis=-1)).clip(0.02, 1)
    # A table over albedo and cosine: the H function is slow.
    albedos = np.linspace(0.005, profile.HIGHEST_ALBEDO, 40)
    cosines = np.linspace(0.02, 1, 40)
    table = np.stack(
        [half_space.radiance_under_even_light(float(profile.single_scattering(a)), cosines) for a in albedos]
    )
    radiance = RegularGridInterpolator((albedos, cosines), table)
    levels = [albedo[..., c] / radiance(np.stack([albedo[..., c], mu], -1)) for c in range(3)]
    return np.where(view.mask[..., None], np.stack(levels, -1), 0)


def _figures(pictures, regions, expected_level) -> dict:
    """Level (mean radiance over the volume's) and pattern error of the cheap tiers, per light,
    region and channel.

    Pattern error: rms of (tier / volume) - 1 after the level of the whole face is taken out.
    Blur: rms of volume - short over the mean of the volume, and what is left of it once
    diffusion - opaque is taken off. The noise of the volumes drops out: two pictures of each
    are independent, and the product of their errors is averaged.
    """
    figures = {}
    for light in LIGHTS:
        first, second, short, short_again = (pictures[light, tier].diffuse.astype(float) for tier in TIERS[2:])
        volume = (first + second) / 2
        opaque, diffusion = (pictures[light, tier].diffuse.astype(float) for tier in TIERS[:2])
        whole = regions["whole face"]
        edges = np.abs(diffusion.mean(-1) / np.maximum(opaque.mean(-1), 1e-3) - 1) > 0.1
        for name, region in {**regions, "shadow edges": whole & edges}.items():
            if region.sum() < 20:
                continue
            row = {"pixels": int(region.sum())}
            if light == "dome":
                row["half space"] = expected_level[region].mean(0).round(4).tolist()
            for tier, picture in (("opaque", opaque), ("diffusion", diffusion)):
                gain = volume[whole].mean(0) / picture[whole].mean(0)
                expected = np.maximum(picture[region] * gain, 2e-3)
                product = (first[region] / expected - 1) * (second[region] / expected - 1)
                row[tier] = {
                    "level": (picture[region].mean(0) / volume[region].mean(0)).round(4).tolist(),
                    "pattern": np.sqrt(product.mean(0).clip(0)).round(4).tolist(),
                }
            for name_of, change in (("blur", 0), ("blur left", diffusion - opaque)):
                product = ((first - short - change) * (second - short_again - change))[region]
                row[name_of] = (np.sqrt(product.mean(0).clip(0)) / volume[region].mean(0)).round(4).tolist()
            figures.setdefault(light, {})[name] = row
    return figures


def _document(options, face, figures, seconds, pictures, regions) -> str:
    lines = [
        (
            f"Face `{options.face.stem}`, {options.size} x {options.size} pixels, {options.samples} samples (the volume "
            f"twice), mean free path {', '.join(f'{v:g}' for v in Render.subsurface_mm)} mm, {os.cpu_count()} cores."
        ),
        "",
        "Half space, without the face (`half_space.py`):",
        "",
        "| requested albedo | exact albedo of the medium | pi x BRDF at cosines 0.9, 0.9 | mean distance, walked | of the profile |",
        "|---|---|---|---|---|",
    ]
    for albedo in (0.05, 0.15, 0.3, 0.45, 0.6, 0.8):
        alpha = float(profile.single_scattering(albedo))
        distance, weight = half_space.searchlight(alpha, 200_000, 1)
        lines.append(
            f"| {albedo:g} | {half_space.diffuse_albedo(alpha):.4f} | {half_space.reflectance(alpha, 0.9, 0.9):.3f} "
            f"| {(distance * weight).sum() / weight.sum():.3f} | {2.5 * float(profile.scale_radius(1.0, albedo)):.3f} |"
        )
    lines += _edge_lines()
    for light, rows in figures.items():
        theory = " level, half space |" if light == "dome" else ""
        lines += [
            "", f"Light `{light}`; red / green / blue:", "",
            "| region | pixels | level, opaque | level, diffusion "
            "| pattern error, opaque | pattern error, diffusion | blur | blur left |" + theory,
            "|---|---|---|---|---|---|---|---|" + "---|" * bool(theory),
        ]  # fmt: skip
        for name, row in rows.items():
            level, pattern = (
                [" / ".join(form.format(value) for value in row[tier][kind]) for tier in TIERS[:2]]
                for kind, form in (("level", "{:.3f}"), ("pattern", "{:.1%}"))
            )
            pattern += [" / ".join(f"{value:.1%}" for value in row[kind]) for kind in ("blur", "blur left")]
            if theory:
                pattern.append(" / ".join(f"{value:.3f}" for value in row["half space"]))
            lines.append(f"| {name} | {row['pixels']} | {' | '.join(level + pattern)} |")
    lines += [
        "", "Cost of a picture, seconds of wall clock (of processor time), and noise of the whole face:", "",
        "| light | " + " | ".join(TIERS[:3]) + " |", "|---|---|---|---|",
    ]  # fmt: skip
    whole = regions["whole face"]
    for light in LIGHTS:
        cells = []
        for tier in TIERS[:3]:
            layers = pictures[light, tier]
            noise = math.sqrt(layers.variance[whole].mean()) / layers.total[whole].mean()
            cells.append("{:.1f} ({:.1f}) s, {:.1%}".format(*seconds[light, tier], noise))
        lines.append(f"| {light} | {' | '.join(cells)} |")
    lines += [
        "",
        "Each picture is the first of its light and includes the shared cost; another view of the last light "
        "in `diffusion` took {:.1f} ({:.1f}) s.".format(*seconds["again"]),
        "",
    ]
    return "\n".join(lines)


def _edge_lines() -> list[str]:
    """Across a straight shadow: tier over the same tier far in the light."""
    lines = [
        "",
        (
            f"A straight shadow on flat skin of albedo {ALBEDO:g}, red channel: radiance relative to that 7 mm inside the light, "
            "at millimetres from the edge into the light:"
        ),
        "",
    ]
    wanted = (-5, -3, -2, -1, 1, 2, 3, 5)
    heads = " | ".join(f"{x:+d}" for x in wanted)
    lines += [f"| light from | tier | {heads} | level over volume |", "|---|---|" + "---|" * (len(wanted) + 1)]
    for name, (distance, rows) in shadow_edges().items():
        for tier in TIERS[1:3]:
            row = rows[tier][:, 0]
            far, reference = row[-4:].mean(), rows["volume"][-4:, 0].mean()
            values = " | ".join(f"{value:.3f}" for value in np.interp(wanted, distance, row / far))
            lines.append(f"| {name} | {tier} | {values} | {far / reference:.3f} |")
    return lines


def _picture(pictures, regions, path: Path) -> None:
    """Studio and flash in the three tiers, and diffusion / volume from -50 % (blue) to +50 % (red)."""
    rows = []
    for light in LIGHTS[1:]:
        shown = [pictures[light, tier].total for tier in TIERS[:2]]
        volumes = [pictures[light, tier] for tier in TIERS[2:4]]
        shown.append((volumes[0].total + volumes[1].total) / 2)
        volume = (volumes[0].diffuse + volumes[1].diffuse).mean(-1) / 2
        ratio = pictures[light, "diffusion"].diffuse.mean(-1) / np.maximum(volume, 1e-3) - 1
        off = np.where(regions["whole face"], ratio, 0).clip(-0.5, 0.5) / 0.5
        signed = np.stack([1 + off.clip(None, 0), 1 - np.abs(off), 1 - off.clip(0)], -1)
        rows.append(
            np.concatenate([*(_display(picture) for picture in shown), signed * regions["whole face"][..., None]], 1)
        )
    picture = (255 * np.concatenate(rows)).round().astype(np.uint8)
    Image.fromarray(picture).resize((1280, 640), Image.Resampling.LANCZOS).save(path, quality=90)


def _display(radiance: np.ndarray) -> np.ndarray:
    """sRGB curve."""
    return encoded(radiance.clip(0, 1))


if __name__ == "__main__":
    main()

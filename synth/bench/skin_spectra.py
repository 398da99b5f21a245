"""How uneven generated faces are beside a scanned one: the figures of docs/ground-truth.md.

    python synth/bench/skin_spectra.py --head HEAD.toml [--size 1024] [--document docs/ground-truth.md]

HEAD.toml is the `[face]` table of your own head with a photographed texture and labels.
Prints the tables; with `--document` writes them there, and the pictures beside it: the curves,
and a contact sheet of sampled faces with natural skin. Of the head
only curves and single numbers are kept.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from unshade.render import llvm

llvm.activate(llvm.choose())
from unshade.face import Face, FaceSpec, Label, build_face, statistics  # noqa: E402
from unshade.heads import build_head  # noqa: E402
from unshade.render.contact_sheet import contact_sheet  # noqa: E402
from unshade.scene_file.face import parse_face  # noqa: E402

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).resolve().parents[2]
FACES = ("ada", "kofi", "mei", "noor")
START, END = "<!-- figures: written by synth/bench/skin_spectra.py -->", "<!-- end of figures -->"
PICTURE, SHEET, SITTERS = "skin-spectra.png", "natural-sheet.jpg", 8
CURVES = ("luminance", "melanin", "haemoglobin", "relief")
REGIONS = (Label.LIPS, Label.BROW, Label.EYELID, Label.SCALP)
GROUPS = ("scan", "natural", "smooth")


@dataclass(frozen=True)
class Measured:
    """One face: spectra (B,) by name, the spread within regions, and the PSNR of its labels' mean colours."""

    curves: dict[str, np.ndarray]
    spreads: dict[str, statistics.Spread]
    psnr: float


def main() -> None:
    options = _options()
    with options.head.open("rb") as file:
        head = parse_face(tomllib.load(file) | {"texture_size": options.size}, str(options.head), options.head.parent)
    measured = {"scan": [measure(build_head(head))]}
    for detail in ("natural", "smooth"):
        measured[detail] = []
        for name in FACES:
            with (ROOT / f"scenes/faces/{name}.toml").open("rb") as file:
                table = tomllib.load(file) | {"texture_size": options.size, "detail": detail}
            spec = FaceSpec.from_table(table)
            measured[detail].append(measure(build_face(spec)))
            print(f"{name}, {detail}", file=sys.stderr)
    text = tables(measured)
    print(text)
    if options.document:
        before, rest = options.document.read_text().split(START)
        after = rest.split(END)[1]
        options.document.write_text(f"{before}{START}\n{text}\n{END}{after}")
        draw(measured).save(options.document.with_name(PICTURE), optimize=True)
        _sheet(options.document.with_name(SHEET))


def _sheet(out: Path) -> None:
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder) / "sheet.png"
        contact_sheet(SITTERS, page, detail="natural")
        Image.open(page).save(out, quality=88, optimize=True)


def measure(face: Face) -> Measured:
    """The figures of one face."""
    maps = face.maps
    surface = statistics.Surface.of(face.chart, len(maps.labels))
    albedo = maps.diffuse_albedo
    skin = statistics.bare_skin(albedo, np.isin(maps.labels, [Label.SKIN, Label.NOSE]), surface)
    melanin, blood = statistics.pigment_amounts(albedo)
    layers = {"luminance": statistics.luminance(albedo), "melanin": melanin, "haemoglobin": blood}
    curves = {name: statistics.spectrum(layer, skin, surface) for name, layer in layers.items()}
    curves["relief"] = statistics.slope_spectrum(maps.specular_normal, skin, surface)
    scalp = surface.inside & (maps.labels == Label.SCALP)
    curves["hair"] = statistics.spectrum(layers["luminance"], scalp, surface)
    spreads = {"skin": statistics.spread(albedo, skin, skin)}
    for label in REGIONS:
        where = surface.inside & (maps.labels == label)
        spreads[label.name.lower()] = statistics.spread(albedo, where, skin)
    return Measured(curves, spreads, statistics.label_mean_psnr(albedo, maps.labels, surface.inside))


def tables(measured: dict[str, list[Measured]]) -> str:
    """Markdown: spectra, then regions."""
    bands = [b for b in range(len(statistics.BANDS)) if np.isfinite(measured["scan"][0].curves["luminance"][b])]
    waves = [f"{1 / statistics.BANDS[b]:g} to {0.5 / statistics.BANDS[b]:g} mm" for b in bands]
    lines = ["| | " + " | ".join(waves) + " |", "|---|" + "---|" * len(bands)]
    for curve in (*CURVES, "hair"):
        for group in GROUPS:
            values = np.stack([m.curves[curve] for m in measured[group]])[:, bands]
            if values.max() < 1e-3:  # float normals turn by as much
                continue
            scale, digits = (1, 1) if curve == "relief" else (100, 1)
            unit = "°" if curve == "relief" else " %"
            lines.append(
                f"| {curve}, {group} | " + " | ".join(_range(scale * v, digits) + unit for v in values.T) + " |"
            )
    lines += ["", "| | " + " | ".join(GROUPS) + " |", "|---|" + "---|" * len(GROUPS)]
    for region in ("skin", *(label.name.lower() for label in REGIONS)):
        for what, title in (("contrast", "against the skin"), ("deviation", "within")):
            if region == "skin" and what == "contrast":
                continue
            cells = [_range(np.array([getattr(m.spreads[region], what) for m in measured[g]]), 2) for g in GROUPS]
            lines.append(f"| {region}, {title} | " + " | ".join(cells) + " |")
    cells = [_range(np.array([m.psnr for m in measured[g]]), 1) + " dB" for g in GROUPS]
    lines.append("| PSNR of the labels' true mean colours | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def _range(values: np.ndarray, digits: int) -> str:
    low, high = (f"{v:.{digits}f}".replace("-", "\N{MINUS SIGN}") for v in (values.min(), values.max()))
    return low if low == high else f"{low} to {high}"


_SIDE, _MARGIN, _GAP = 300, 62, 30
_COLOURS = {"scan": (190, 40, 30), "natural": (20, 90, 170), "smooth": (150, 150, 150)}


@dataclass(frozen=True)
class Frame:
    """One diagram: its upper left corner in pixels, and the values (`low`, `high`) at its lower and upper edge."""

    left: float
    top: float
    low: float
    high: float

    def at(self, wave: float, value: float) -> tuple[float, float]:
        """Where a value at a wavelength (mm) lies; values beyond the edges lie on them."""
        x = (np.log(32) - np.log(wave)) / np.log(64)
        fraction = np.log(np.clip(value, self.low, self.high) / self.low) / np.log(self.high / self.low)
        return self.left + _SIDE * x, self.top + _SIDE * (1 - fraction)


def draw(measured: dict[str, list[Measured]]) -> Image.Image:
    """The curves, both axes logarithmic: root mean square in an octave over wavelength."""
    titles = (*CURVES, "hair")
    page = Image.new("RGB", (len(titles) * (_SIDE + _MARGIN) + _GAP, _SIDE + 2 * _MARGIN), "white")
    pen, font = ImageDraw.Draw(page), ImageFont.load_default(15)
    for k, title in enumerate(titles):
        degrees = title == "relief"
        frame = Frame(_MARGIN + k * (_SIDE + _MARGIN), _MARGIN, *((0.3, 10.0) if degrees else (0.003, 0.5)))
        pen.rectangle((frame.left, frame.top, frame.left + _SIDE, frame.top + _SIDE), outline=(90, 90, 90))
        pen.text((frame.left + _SIDE / 2, frame.top - 14), title, fill="black", font=font, anchor="mm")
        for wave in (16, 8, 4, 2, 1):
            x, y = frame.at(wave, frame.low)
            pen.line((x, frame.top, x, y), fill=(228, 228, 228))
            pen.text((x, y + 12), f"{wave} mm", fill="black", font=font, anchor="mm")
        for value in (1.0, 3.0) if degrees else (0.01, 0.03, 0.1):
            x, y = frame.at(32, value)
            pen.line((x, y, x + _SIDE, y), fill=(228, 228, 228))
            text = f"{value:g}°" if degrees else f"{100 * value:g} %"
            pen.text((x - 5, y), text, fill="black", font=font, anchor="rm")
        for group in reversed(GROUPS):
            for face in measured[group]:
                _curve(pen, frame, face.curves[title], group)
    for k, group in enumerate(GROUPS):
        pen.text((_MARGIN + 130 * k, _SIDE + 2 * _MARGIN - 16), group, fill=_COLOURS[group], font=font, anchor="lm")
    return page


def _curve(pen: ImageDraw.ImageDraw, frame: Frame, curve: np.ndarray, group: str) -> None:
    """Through the middles of the octaves; nothing where a face has none of it."""
    middles = 1 / (statistics.BANDS * 2**0.5)
    points = [frame.at(wave, value) for wave, value in zip(middles, curve) if np.isfinite(value) and value > 1e-3]
    if len(points) > 1:
        pen.line(points, fill=_COLOURS[group], width=4 if group == "scan" else 2)


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="How uneven generated faces are beside a scanned one.")
    parser.add_argument("--head", type=Path, required=True, help="[face] table of a head with a photographed texture")
    parser.add_argument("--size", type=int, default=1024, help="texels along each edge")
    parser.add_argument("--document", type=Path, help="write tables and picture into this page")
    return parser.parse_args()


if __name__ == "__main__":
    main()

"""Solves two halves of the views separately: agreement between their maps is evidence for both."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from pathlib import Path
from typing import Any, Literal, TypedDict

from .. import _native, metrics
from ..documents import Document
from ..errors import CaptureError
from ..maps import Maps
from ..stages import solve

AnyPath = str | os.PathLike[str]


class Consistency(TypedDict):
    """Maps of one half of the training views against those of the other, on texels that both have.

    ``diffuse_albedo_psnr`` is in dB of sRGB values after one factor, ``specular_albedo_pearson`` a correlation,
    ``normal_mean_deg`` the mean angle between specular normals; None where a method leaves no such map.
    ``common`` is the share of the texels of either half that both have.
    """

    diffuse_albedo_psnr: float | None
    specular_albedo_pearson: float | None
    normal_mean_deg: float | None
    common: float
    views: tuple[int, int]


def consistency(
    capture: _native.Capture | AnyPath,
    *,
    config: Document = "unshade",
    out: AnyPath | None = None,
    backend: Literal["auto", "cpu", "gpu"] = "auto",
) -> Consistency:
    """Solve every second training view, and the others, and compare the maps; no truth is needed.

    Views are taken alternately in the order of their names. With ``out`` the maps are kept in ``out/first`` and
    ``out/second``. Raises `CaptureError` for a capture of fewer than four training views, and what `solve` raises.
    """
    folder = Path(capture.path if isinstance(capture, _native.Capture) else capture)
    document: dict[str, Any] = {}
    if (folder / "transforms.json").is_file():
        document = json.loads((folder / "transforms.json").read_bytes())
    train = sorted(document.get("train_filenames", []))
    if len(train) < 4:
        raise CaptureError(f"{folder}: has {len(train)} named training views; halves need four")
    with tempfile.TemporaryDirectory(prefix="unshade-") as scratch:
        found = []
        for name, half in (("first", train[0::2]), ("second", train[1::2])):
            place = Path(scratch) / name
            _half(folder, place, document | {"train_filenames": half, "test_filenames": []})
            kept = None if out is None else Path(out) / name
            found.append(solve(place, config=config, out=kept, backend=backend))
    return compare_halves(*found, views=(len(train[0::2]), len(train[1::2])))


def compare_halves(first: Maps, second: Maps, *, views: tuple[int, int]) -> Consistency:
    """How far the maps of two halves agree."""
    coverage = [maps.coverage for maps in (first, second)]
    if coverage[0] is None or coverage[1] is None or coverage[0].shape != coverage[1].shape:
        raise CaptureError("the halves' maps have no coverage of one size; solve both with one configuration")
    seen = [c > 0 for c in coverage if c is not None]
    both, either = seen[0] & seen[1], seen[0] | seen[1]
    albedo = normals = specular = None
    if first.diffuse_albedo is not None and second.diffuse_albedo is not None:
        albedo = metrics.psnr_srgb(first.diffuse_albedo, second.diffuse_albedo, both, scale="global")
    if first.specular_albedo is not None and second.specular_albedo is not None:
        specular = metrics.pearson(first.specular_albedo, second.specular_albedo, both)
    if first.specular_normal is not None and second.specular_normal is not None:
        normals = metrics.normal_mean_deg(first.specular_normal, second.specular_normal, both)
    fraction = float(both.sum() / max(int(either.sum()), 1))
    return {
        "diffuse_albedo_psnr": albedo,
        "specular_albedo_pearson": specular,
        "normal_mean_deg": normals,
        "common": fraction,
        "views": views,
    }


def _half(folder: Path, place: Path, document: dict[str, Any]) -> None:
    """A capture of some of the views, whose files are linked where the system allows."""
    place.mkdir()
    for name in ("images", "masks", "labels", "mesh.obj"):
        source = folder / name
        if source.exists():
            try:
                (place / name).symlink_to(source.resolve(), target_is_directory=source.is_dir())
            except OSError:
                (shutil.copytree if source.is_dir() else shutil.copyfile)(source, place / name)
    (place / "transforms.json").write_text(json.dumps(document))

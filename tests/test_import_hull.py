"""`unshade import --mesh hull`: a mesh from masks alone, against an ellipsoid whose surface is known."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import painted_capture
import pytest
from PIL import Image

import unshade
from unshade.errors import CaptureError
from unshade.importing.chart_mesh import read_mesh
from unshade.importing.importer import CaptureWarning

AZIMUTHS = np.arange(0, 360, 30)


@pytest.fixture
def large(monkeypatch: pytest.MonkeyPatch) -> list[painted_capture.View]:
    """Views all round, from two heights, of pictures in which an outline is known to a millimetre."""
    for name, value in (("WIDTH", 120), ("HEIGHT", 160), ("FOCAL", 260.0)):
        monkeypatch.setattr(painted_capture, name, value)
    ring = painted_capture.views(AZIMUTHS, elevation=10) + painted_capture.views(AZIMUTHS + 15, elevation=-25)
    return [painted_capture.replace(view, name=f"{number:03}") for number, view in enumerate(ring)]


def _carved(folder: Path, **choices: object) -> tuple[Path, list[str]]:
    with pytest.warns(CaptureWarning) as warned:
        capture = unshade.import_capture(
            "transforms", folder / "transforms.json", folder / "capture", mesh="hull", front="000", **choices
        )  # fmt: skip
    return capture, [str(warning.message) for warning in warned]


def test_the_hull_of_all_round_masks_is_the_head(large: list[painted_capture.View], tmp_path: Path) -> None:
    folder = painted_capture.write(tmp_path / "head", large)
    capture, warned = _carved(folder, masks=folder / "masks", unit="m")
    assert any("visual hull of 24 masks" in text for text in warned)
    record = json.loads((capture / "import.json").read_text())
    assert record["source"]["mesh"] == "hull" and record["masks"] == "files"
    assert record["fit"]["union"] > 0.95
    mesh = read_mesh(capture / "mesh.obj")
    back = np.linalg.inv(np.array(record["source_to_capture"]))
    points = mesh.vertices @ back[:3, :3].T + back[:3, 3]
    # The level of a point on the ellipsoid is 1; distances to first order.
    level = np.linalg.norm(points / painted_capture.RADII, axis=1)
    distance = 1e3 * (level - 1) / np.linalg.norm(points / painted_capture.RADII**2, axis=1) * level
    # A hull holds the head, up to pixels and smoothing, and little more where views see its outline.
    assert distance.min() > -1.5
    assert np.percentile(distance, 90) < 4
    assert mesh.normals is not None
    outward = np.einsum("ij,ij->i", mesh.normals, mesh.vertices - mesh.vertices.mean(0))
    assert (outward > 0).mean() > 0.99


def test_masks_are_cut_from_the_photographs_where_there_are_none(
    large: list[painted_capture.View], tmp_path: Path
) -> None:
    rng = np.random.default_rng(0)
    wall = lambda view: np.where(view.mask[..., None], view.radiance, 0.05 + 0.02 * rng.random(view.radiance.shape))
    folder = painted_capture.write(tmp_path / "head", [painted_capture.replace(v, radiance=wall(v)) for v in large])
    document = json.loads((folder / "transforms.json").read_text())
    for frame in document["frames"]:
        del frame["mask_path"]
    (folder / "transforms.json").write_text(json.dumps(document))
    capture, warned = _carved(folder)
    assert any("GrabCut" in text for text in warned)
    assert json.loads((capture / "import.json").read_text())["masks"] == "grabcut"
    for view in large[::5]:
        found = np.array(Image.open(capture / "masks" / f"{view.name}.png")) > 0
        assert (found & view.mask).sum() / (found | view.mask).sum() > 0.95, view.name


def test_masks_without_a_common_point_are_refused(large: list[painted_capture.View], tmp_path: Path) -> None:
    folder = painted_capture.write(tmp_path / "head", large)
    for number, path in enumerate(sorted((folder / "masks").glob("*.png"))):
        mask = np.zeros((160, 120), np.uint8)
        mask[20 + 40 * (number % 3) :, :][:20, 40:60] = 255
        Image.fromarray(mask).save(path)
    choices = {"mesh": "hull", "masks": folder / "masks"}
    with pytest.raises(CaptureError, match="no point lies within the masks of all views"):
        unshade.import_capture("transforms", folder / "transforms.json", tmp_path / "capture", **choices)
    assert not (tmp_path / "capture").exists()
    with pytest.raises(CaptureError, match="cannot be its silhouette"):
        unshade.import_capture(
            "transforms", folder / "transforms.json", tmp_path / "capture", mesh="hull", masks="silhouette"
        )


def test_a_mesh_without_texture_coordinates_is_unwrapped(tmp_path: Path) -> None:
    folder = painted_capture.write(tmp_path / "head", painted_capture.views((-40, -20, 0, 20, 40)))
    lines = (folder / "head.obj").read_text().splitlines()
    bare = [" ".join(word.split("/")[0] for word in line.split()) for line in lines if not line.startswith("vt")]
    (folder / "head.obj").write_text("\n".join(bare) + "\n")
    with pytest.warns(CaptureWarning, match="no texture coordinates: it is unwrapped"):
        unshade.import_capture(
            "transforms", folder / "transforms.json", tmp_path / "capture", mesh=folder / "head.obj", unit="m"
        )
    mesh = read_mesh(tmp_path / "capture" / "mesh.obj")
    assert mesh.layout_faults()[0] is None
    # Triangles of no area at the poles aside, the surface is the same.
    corners = mesh.vertices[mesh.triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 2
    ((a, b, c), p) = painted_capture.RADII, 1.6075
    # Thomsen's formula, right to 1 %; a polyhedron inside is smaller.
    thomsen = 4 * np.pi * (((a * b) ** p + (a * c) ** p + (b * c) ** p) / 3) ** (1 / p)
    assert 0.97 * thomsen < area < 1.01 * thomsen

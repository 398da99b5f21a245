"""`unshade import` of meshes in many UV islands, and maps brought back to their own UV by `unshade export`."""

from __future__ import annotations

import json
import shutil
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import painted_capture
import pytest

import unshade
from conftest import unshade as command
from unshade.errors import CaptureError, MapsError
from unshade.exporting.onto_mesh import onto_mesh
from unshade.face.texels import rasterise
from unshade.files.pictures import read_rgb
from unshade.importing.chart_mesh import ChartMesh, read_mesh
from unshade.surface import read_surface
from unshade.vectors import unit

AZIMUTHS = (-60, -30, 0, 30, 60)


@pytest.fixture
def scan(tmp_path: Path) -> Path:
    """A capture of the ellipsoid in centimetres, whose every quad is an island."""
    world = np.diag([100.0, 100.0, 100.0, 1.0])
    folder = painted_capture.write(tmp_path / "scan", painted_capture.views(AZIMUTHS), world)
    document = json.loads((folder / "transforms.json").read_text())
    for frame in document["frames"]:
        matrix = np.array(frame["transform_matrix"])
        matrix[:3, 3] *= 100
        frame["transform_matrix"] = matrix.tolist()
    (folder / "transforms.json").write_text(json.dumps(document))
    lines = [line for line in (folder / "head.obj").read_text().splitlines() if line[:2] != "vt"]
    faces = [line.split()[1:] for line in lines if line[0] == "f"]
    vertices = [line for line in lines if line[0] == "v"]
    for number, face in enumerate(faces):
        # A grid of 48 cells a side; corners with a margin.
        column, row = number % 48, number // 48
        for x, y in ((0.1, 0.9), (0.1, 0.1), (0.9, 0.1), (0.9, 0.9)):
            vertices.append(f"vt {(column + x) / 48:.7f} {(row + y) / 48:.7f}")
        faces[number] = [f"{c.split('/')[0]}/{4 * number + k + 1}" for k, c in enumerate(face)]
    (folder / "head.obj").write_text("\n".join([*vertices, *("f " + " ".join(face) for face in faces)]) + "\n")
    return folder


def imported(scan: Path, out: Path, **options: Any) -> tuple[dict[str, Any], list[str], ChartMesh]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        unshade.import_capture("transforms", scan, out, mesh=scan / "head.obj", unit="cm", **options)
    said = [str(warning.message) for warning in caught if "UV" in str(warning.message)]
    return json.loads((out / "import.json").read_text()), said, read_mesh(out / "mesh.obj")


def test_many_islands_are_unwrapped_anew(scan: Path, tmp_path: Path) -> None:
    record, said, mesh = imported(scan, tmp_path / "capture")
    assert record["uv"]["new"] and record["uv"]["own_islands"] > 900 and record["uv"]["islands"] < 20
    assert len(said) == 1 and f"into {record['uv']['islands']} (--uv keep keeps its own)" in said[0]
    assert mesh.layout_faults()[3] == record["uv"]["islands"]
    # The same triangles, in their order and place.
    own = read_mesh(scan / "head.obj")
    np.testing.assert_allclose(mesh.vertices[mesh.triangles], own.vertices[own.triangles] / 100, atol=1e-6)


def test_the_meshs_own_uv_can_be_kept_and_good_ones_replaced(scan: Path, tmp_path: Path) -> None:
    record, said, mesh = imported(scan, tmp_path / "kept", uv="keep")
    assert record["uv"] == {"new": False, "islands": mesh.layout_faults()[3]} and mesh.layout_faults()[3] > 900
    assert len(said) == 1 and "every seam costs a solve accuracy" in said[0]
    painted_capture.write_mesh(scan / "head.obj", np.diag([100.0, 100.0, 100.0, 1.0]))
    record, said, _ = imported(scan, tmp_path / "one")
    assert record["uv"] == {"new": False, "islands": 1} and not said
    record, said, _ = imported(scan, tmp_path / "new", uv="new")
    assert record["uv"]["new"] and not said
    with pytest.raises(CaptureError, match="uv 'old' is unknown; there are auto, keep, new"):
        imported(scan, tmp_path / "x", uv="old")


def test_maps_return_to_the_own_uv(scan: Path, tmp_path: Path) -> None:
    """A colour that is a function of the place, written on the new UV, arrives on the old one; so do normals."""
    imported(scan, tmp_path / "capture")
    capture = unshade.Capture(tmp_path / "capture")
    mesh, size = capture.mesh, 512
    texels = rasterise(mesh["uvs"].astype(float), mesh["triangles"].astype(np.int64), size)
    colour = lambda places: 0.2 + 0.5 * (places / painted_capture.RADII + 1) / 2
    albedo = texels.image(colour(texels.sample(mesh["vertices"])).astype(np.float32))
    normals = texels.image(unit(texels.sample(mesh["normals"])))
    unshade.Maps(diffuse_albedo=albedo, specular_normal=normals).write(tmp_path / "maps")
    command("export", tmp_path / "maps", "--capture", capture.path, "--mesh", scan / "head.obj", "--format", "png", "-o", tmp_path / "own")  # fmt: skip
    exported, own = read_mesh(tmp_path / "own" / "face.obj"), read_mesh(scan / "head.obj")
    np.testing.assert_allclose(exported.uv[exported.triangles], own.uv[own.triangles], atol=1e-6)
    np.testing.assert_allclose(exported.vertices[exported.triangles], own.vertices[own.triangles] / 100, atol=1e-6)
    theirs = rasterise(own.uv, own.triangles, size)
    expected = colour(theirs.sample(own.vertices / 100))
    error = np.abs(read_rgb(tmp_path / "own" / "diffuse_albedo.exr")[theirs.inside] - expected)
    # A texel of the new UV spans 0.006 of the colour; without resampling the median error is 0.1.
    assert np.percentile(error, 99) < 0.01
    # And back: an albedo alone, on the mesh in its own unit.
    (tmp_path / "theirs").mkdir()
    shutil.copy(tmp_path / "own" / "diffuse_albedo.exr", tmp_path / "theirs")
    unshade.import_maps(tmp_path / "theirs", tmp_path / "back", capture=capture, mesh=scan / "head.obj", adapter="unshade")  # fmt: skip
    back = unshade.Maps.read(tmp_path / "back").diffuse_albedo
    assert back is not None and np.percentile(np.abs(back - albedo)[texels.inside], 99) < 0.02
    surface = onto_mesh(
        read_surface(tmp_path / "maps", tmp_path / "capture", None, print), tmp_path / "capture", scan / "head.obj"
    )
    assert surface.maps.specular_normal is not None
    cosine = (surface.maps.specular_normal[theirs.inside] * unit(theirs.sample(own.vertices / painted_capture.RADII**2))).sum(-1)  # fmt: skip
    assert np.degrees(np.arccos(np.percentile(cosine, 5).clip(-1, 1))) < 3


def test_another_face_is_refused(scan: Path, tmp_path: Path) -> None:
    imported(scan, tmp_path / "capture")
    other = tmp_path / "other.obj"
    painted_capture.write_mesh(other, np.diag([0.3, 3.0, 1.0, 1.0]))
    unshade.Maps(diffuse_albedo=np.full((64, 64, 3), 0.5, np.float32)).write(tmp_path / "maps")
    with pytest.raises(MapsError, match="from the capture's mesh"):
        unshade.export(tmp_path / "maps", tmp_path / "out", format="png", capture=tmp_path / "capture", mesh=other)
    assert not (tmp_path / "out").exists()

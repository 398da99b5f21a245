"""`unshade import`: a capture of ours, as other programs would have written it, comes back the same."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable
from pathlib import Path

import colmap_child
import cv2
import foreign_captures
import numpy as np
import pytest
from foreign_captures import OPENCV_AXES

import unshade
from conftest import QUICK
from conftest import unshade as command
from unshade import _native
from unshade.errors import CaptureError, StorageError
from unshade.importing.importer import CaptureWarning

Writer = Callable[[Path, Path], Path]

WRITERS: dict[str, tuple[str, Writer]] = {
    "nerfstudio": ("transforms", foreign_captures.nerfstudio),
    "instant-ngp": ("transforms", foreign_captures.instant_ngp),
    "colmap-text": ("colmap", lambda c, f: foreign_captures.colmap(c, f, binary=False)),
    "colmap-binary": ("colmap", lambda c, f: foreign_captures.colmap(c, f, binary=True)),
    "colmap-rig": ("colmap", lambda c, f: foreign_captures.colmap(c, f, binary=True, rig=True)),
    "metashape": ("metashape", foreign_captures.metashape),
    "emily": ("emily", foreign_captures.emily),
}


@pytest.fixture(scope="module")
def capture(tiny_run: Path) -> Path:
    return tiny_run / "captures" / "tiny-studio"


@pytest.fixture(scope="module")
def imported(capture: Path, tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """A capture through one of the writers and back, each once."""
    made: dict[str, Path] = {}

    def once(writer: str) -> Path:
        if writer not in made:
            folder = tmp_path_factory.mktemp(writer)
            format, write = WRITERS[writer]
            path = write(capture, folder / "source")
            beside = (
                {}
                if format == "emily"
                else {"mesh": folder / "source" / "mesh.obj", "masks": folder / "source" / "masks"}
            )
            made[writer] = unshade.import_capture(format, path, folder / "capture", **beside, holdout=5)
        return made[writer]

    return once


def _by_name(capture: Path) -> dict[str, dict]:
    names = {f"cam{number}": f"{number:03}" for number in range(100)}
    return {names.get(frame["name"], frame["name"]): frame for frame in foreign_captures.frames_of(capture)}


@pytest.mark.parametrize("writer", WRITERS)
def test_cameras_pictures_and_masks_come_back(writer: str, capture: Path, imported: Callable[[str], Path]) -> None:
    back = imported(writer)
    before, after = _by_name(capture), _by_name(back)
    assert before.keys() == after.keys()
    for name, frame in before.items():
        np.testing.assert_allclose(after[name]["transform_matrix"], frame["transform_matrix"], atol=1e-6)
        for key in ("w", "h", "fl_x", "fl_y", "cx", "cy"):
            assert after[name][key] == pytest.approx(frame[key], abs=1e-6)
    ours, theirs = unshade.Capture(capture), unshade.Capture(back)
    for name in set(ours.train) & set(theirs.train):
        np.testing.assert_array_equal(theirs.image(name), ours.image(name))
        np.testing.assert_array_equal(theirs.mask(name), ours.mask(name))
    if writer != "emily":
        assert (back / "mesh.obj").read_bytes() == (capture / "mesh.obj").read_bytes()
    assert len(theirs.withheld) == 1


def test_the_silhouette_is_the_mask_where_there_is_none(capture: Path, imported: Callable[[str], Path]) -> None:
    """The path tracer's masks lack what hair and eyes hide, and nothing else."""
    back = imported("emily")
    said = json.loads((back / "import.json").read_text())
    assert said["masks"] == "silhouette" and said["fit"] is None
    ours, theirs = unshade.Capture(capture), unshade.Capture(back)
    for ours_name, theirs_name in zip(ours.train, theirs.train):
        seen, rendered = theirs.mask(theirs_name) > 0, ours.mask(ours_name) > 0
        assert (rendered & ~seen).sum() <= 0.002 * rendered.sum()
        assert (rendered & seen).sum() > 0.9 * seen.sum()


def test_the_same_solve(capture: Path, imported: Callable[[str], Path], tmp_path: Path) -> None:
    writer = "metashape"  # whose matrices go the longest way
    document = json.loads((imported(writer) / "transforms.json").read_text())
    original = json.loads((capture / "transforms.json").read_text())
    same = tmp_path / "same"
    shutil.copytree(capture, same)
    # The same views are trained on, without labels, of which the import was told none.
    original |= {key: document[key] for key in ("train_filenames", "test_filenames")}
    for frame in original["frames"]:
        frame.pop("label_path")
    (same / "transforms.json").write_text(json.dumps(original))
    first, second = (unshade.solve(folder, config=QUICK) for folder in (same, imported(writer)))
    coverage = first.coverage
    assert first.diffuse_albedo is not None and second.diffuse_albedo is not None and coverage is not None
    assert (unshade.metrics.psnr_lin(second.diffuse_albedo, first.diffuse_albedo, coverage) or 0) > 40


def test_colmap_itself_sees_every_vertex_where_we_do(capture: Path, imported: Callable[[str], Path]) -> None:
    back = imported("colmap-rig")
    points = unshade.Capture(back).mesh["vertices"][::499].astype(float)
    theirs = colmap_child.ask(do="project", folder=str(back.parent / "source" / "sparse" / "0"), points=points.tolist())
    for frame in foreign_captures.frames_of(back):
        np.testing.assert_allclose(_projected(frame, points), theirs[f"{frame['name']}.exr"], atol=1e-4)


def test_opencv_sees_every_vertex_where_we_do_half_a_pixel_aside(imported: Callable[[str], Path]) -> None:
    back = imported("metashape")
    points = unshade.Capture(back).mesh["vertices"][::499].astype(float)
    for frame in foreign_captures.frames_of(back):
        world_to_camera = np.linalg.inv(np.array(frame["transform_matrix"]) @ OPENCV_AXES)
        turn, _ = cv2.Rodrigues(world_to_camera[:3, :3])
        camera = np.array([[frame["fl_x"], 0, frame["cx"] - 0.5], [0, frame["fl_y"], frame["cy"] - 0.5], [0, 0, 1]])
        theirs, _ = cv2.projectPoints(points, turn, world_to_camera[:3, 3], camera, None)
        np.testing.assert_allclose(_projected(frame, points), theirs[:, 0] + 0.5, atol=1e-4)


def _projected(frame: dict, points: np.ndarray) -> np.ndarray:
    local = np.linalg.inv(frame["transform_matrix"]) @ np.c_[points, np.ones(len(points))].T
    x, y = local[0] / -local[2], local[1] / local[2]
    return np.stack([frame["cx"] + frame["fl_x"] * x, frame["cy"] + frame["fl_y"] * y], 1)


def test_a_head_of_another_size_and_place_is_stood_upright_in_metres(capture: Path, tmp_path: Path) -> None:
    """A world as structure from motion leaves it: any scale, any axes, any origin."""
    turn, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    scale, shift = 7.0, np.array([3.0, -20.0, 5.0])
    foreign_captures.copy_pictures(capture, tmp_path / "source")
    frames = foreign_captures.frames_of(capture)
    for frame in frames:
        matrix = np.array(frame["transform_matrix"])
        matrix[:3, 3] = scale * turn @ matrix[:3, 3] + shift
        matrix[:3, :3] = turn @ matrix[:3, :3]
        frame["transform_matrix"] = matrix.tolist()
    (tmp_path / "source" / "transforms.json").write_text(json.dumps({"frames": frames}))
    lines = []
    for line in (capture / "mesh.obj").read_text().splitlines():
        key, *words = line.split()
        if key in ("v", "vn"):
            vector = turn @ np.array(words, float)
            words = [repr(float(v)) for v in (vector * scale + shift if key == "v" else vector)]
        lines.append(" ".join([key, *words]))
    (tmp_path / "source" / "mesh.obj").write_text("\n".join(lines))
    unshade.import_capture(
        "transforms", tmp_path / "source", tmp_path / "capture", mesh=tmp_path / "source" / "mesh.obj"
    )
    back = unshade.Capture(tmp_path / "capture")
    mesh = back.mesh["vertices"]
    assert 0.2 < np.ptp(mesh, 0).max() < 0.3 and np.abs(mesh.mean(0)).max() < 0.05
    away = np.mean([back.camera(name)["camera_to_world"][:3, 3] for name in back.train], 0)
    assert away[2] > 0.9 * np.linalg.norm(away)
    ups = np.mean([back.camera(name)["camera_to_world"][:3, 1] for name in back.train], 0)
    assert ups[1] > 0.9
    kept = unshade.import_capture(
        "transforms",
        tmp_path / "source",
        tmp_path / "kept",
        mesh=tmp_path / "source" / "mesh.obj",
        unit="m",
        place="keep",
    )
    np.testing.assert_allclose(
        foreign_captures.frames_of(kept)[0]["transform_matrix"], frames[0]["transform_matrix"], atol=1e-9
    )


def test_the_command_line_does_the_same(capture: Path, tmp_path: Path, imported: Callable[[str], Path]) -> None:
    path = foreign_captures.colmap(capture, tmp_path / "source", binary=True)
    arguments = [
        "import",
        "colmap",
        path,
        "-o",
        tmp_path / "capture",
        "--mesh",
        path / "mesh.obj",
        "--masks",
        path / "masks",
        "--holdout",
        "5",
    ]
    done = command(*arguments)
    assert "import.json" in done.stderr
    theirs, ours = (
        json.loads((folder / "transforms.json").read_text())
        for folder in (tmp_path / "capture", imported("colmap-binary"))
    )
    assert theirs == ours
    # Again: the folder is ours and is replaced; names take the place of a step.
    command(*arguments[:-1], "000,001.exr")
    assert json.loads((tmp_path / "capture" / "transforms.json").read_text())["test_filenames"] == [
        "images/000.exr",
        "images/001.exr",
    ]
    bad = command("import", "colmap", tmp_path / "nothing", "-o", tmp_path / "x", check=False)
    assert bad.returncode == 2 and bad.stderr.startswith("unshade: ") and bad.stderr.count("\n") == 1


def test_shrinking_keeps_what_is_seen_where(capture: Path, tmp_path: Path) -> None:
    path = foreign_captures.colmap(capture, tmp_path / "source", binary=True)
    beside = {"mesh": path / "mesh.obj", "masks": path / "masks"}
    half = unshade.Capture(unshade.import_capture("colmap", path, tmp_path / "half", **beside, shrink=2))
    whole = unshade.Capture(capture)
    name = whole.train[0]
    small, large = half.image(name), whole.image(name)
    np.testing.assert_allclose(small, large.reshape(small.shape[0], 2, small.shape[1], 2, 3).mean((1, 3)), atol=1e-5)
    np.testing.assert_allclose(np.array(half.camera(name)["focal"]) * 2, whole.camera(name)["focal"], rtol=1e-6)


def laid_out(mesh: Path, out: Path, place: Callable[[np.ndarray, np.ndarray], np.ndarray], material: str = "") -> Path:
    """The mesh with a UV at every corner: ``place`` of the corner's UV (F,3,2) and whether its triangle is on the
    right half of the chart (F,1,1); the right half has the ``material``."""
    obj = _native.read_obj(mesh.read_bytes())[0]
    corners = obj["uv"][obj["triangles"]]
    right = corners.mean(1, keepdims=True)[..., :1] > 0.5
    uv = place(corners, right).reshape(-1, 2)
    lines = ["v %.9g %.9g %.9g" % tuple(v) for v in obj["vertices"]] + ["vt %.9g %.9g" % tuple(t) for t in uv]
    faces = [f"f {a}/{3 * k + 1} {b}/{3 * k + 2} {c}/{3 * k + 3}" for k, (a, b, c) in enumerate(obj["triangles"] + 1)]
    halves = [[face for face, r in zip(faces, right.ravel()) if r == side] for side in (False, True)]
    out.write_text("\n".join([*lines, "usemtl left", *halves[0], f"usemtl {material or 'left'}", *halves[1]]))
    return out


LAYOUTS: dict[str, tuple[Callable[[np.ndarray, np.ndarray], np.ndarray], str, str]] = {
    "pages": (lambda uv, right: uv * [1.8, 1] - right * [0.8, 0], "right", r'"left" and material "right" lie over each other in UV: two triangles claim \d+'),
    "mirrored": (lambda uv, right: np.where(right, uv, [1, 0] - uv * [1, -1]), "", r'"left" overlaps in UV \(mirrored halves\)'),
    "udim": (lambda uv, right: uv + right * [1, 0], "", "UVs lie on 2 tiles .UDIM 1001, 1002."),
}  # fmt: skip


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_layout_whose_texels_have_several_places_is_refused(layout: str, capture: Path, tmp_path: Path) -> None:
    place, material, words = LAYOUTS[layout]
    mesh = laid_out(capture / "mesh.obj", tmp_path / "mesh.obj", place, material)
    with pytest.raises(CaptureError, match=words) as refusal:
        unshade.import_capture("transforms", capture, tmp_path / "out", mesh=mesh)
    assert "\n" not in str(refusal.value)
    if layout == "pages":  # as an import of another program would have left it
        shutil.copytree(capture, tmp_path / "capture", ignore=shutil.ignore_patterns("truth"))
        shutil.copy(mesh, tmp_path / "capture" / "mesh.obj")
        done = command("check", tmp_path, "--capture", tmp_path / "capture", check=False)
        assert done.returncode == 2 and "lie over each other in UV" in done.stderr


def test_many_islands_that_are_kept_are_a_warning(capture: Path, tmp_path: Path) -> None:
    apart = lambda uv, _: uv.mean(1, keepdims=True) + 0.9 * (uv - uv.mean(1, keepdims=True))
    mesh = laid_out(capture / "mesh.obj", tmp_path / "mesh.obj", apart)
    with pytest.warns(CaptureWarning, match=r"has \d{3,} UV islands"), pytest.raises(CaptureError, match="no view 'x'"):
        unshade.import_capture("transforms", capture, tmp_path / "out", mesh=mesh, uv="keep", holdout=["x"])
    shutil.copytree(capture, tmp_path / "capture", ignore=shutil.ignore_patterns("truth"))
    shutil.copy(mesh, tmp_path / "capture" / "mesh.obj")
    said = command("solve", tmp_path / "capture", "--solver", "mean-texture", "-o", tmp_path / "maps").stderr
    assert re.search(r"has \d{3,} UV islands; every seam costs a solve accuracy", said)


def test_invalid_imports_are_one_line_errors(capture: Path, tmp_path: Path) -> None:
    path = foreign_captures.colmap(capture, tmp_path / "source", binary=True)
    mesh = path / "mesh.obj"

    def refused(words: str, error: type[Exception] = CaptureError, **choices: object) -> None:
        with pytest.raises(error, match=words) as refusal:
            format, out = str(choices.pop("format", "colmap")), choices.pop("out", tmp_path / "out")
            unshade.import_capture(format, path, out, **choices)  # type: ignore[arg-type]
        assert "\n" not in str(refusal.value)

    refused("names no mesh")
    refused("is not an OBJ file", mesh=path / "images")
    refused("has no object 'Face'", mesh=mesh, objects=["Face"])
    refused("there is no view 'x'", mesh=mesh, holdout=["x"])
    refused("every second view is the most", mesh=mesh, holdout=1)
    refused("need the parser", mesh=mesh, labels=path / "labels")
    refused("is not a folder", mesh=mesh, masks=path / "nothing")
    refused("has no mask 000.png", mesh=mesh, masks=path / "sparse")
    refused("has no alpha", mesh=mesh, masks="alpha")
    refused("unit 'ell' is unknown", mesh=mesh, unit="ell")
    refused("place 'there' is unknown", mesh=mesh, place="there")
    refused("shrink is 0", mesh=mesh, shrink=0)
    refused("format 'nerf' is unknown", mesh=mesh, format="nerf")
    refused("has no exposure time", mesh=mesh, even_exposure=True)
    refused("which is read; choose another folder", StorageError, mesh=mesh, out=path)
    refused("which is read; choose another folder", StorageError, mesh=mesh, out=tmp_path)
    assert mesh.is_file() and not (tmp_path / "out").exists()

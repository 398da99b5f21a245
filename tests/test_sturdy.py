"""Captures with everything that goes wrong with captures: each gives valid maps, or one line that says what to fix."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from editable_capture import CONFIG, Editable
from PIL import Image

import unshade

PAPER = """
base = "paper"
warm_up.iterations = 20
fine_tuning = { iterations = 5, texture_size = 64 }
"""


@pytest.fixture
def capture(photographs: Path, tmp_path: Path) -> Editable:
    return Editable(shutil.copytree(photographs, tmp_path / "capture"))


@pytest.fixture(scope="module")
def untouched(photographs: Path, tmp_path_factory: pytest.TempPathFactory) -> unshade.Maps:
    """The maps of the capture as it is."""
    return Editable(shutil.copytree(photographs, tmp_path_factory.mktemp("untouched") / "capture")).solve()


def angle(a: np.ndarray, b: np.ndarray, where: np.ndarray) -> float:
    """Mean degrees between two normal maps."""
    return float(np.degrees(np.arccos((a * b).sum(-1).clip(-1, 1)))[where > 0].mean())


def looks_like(maps: unshade.Maps, other: unshade.Maps) -> None:
    """The same face, if not the same bytes."""
    where = (maps.coverage > 0) & (other.coverage > 0)
    assert where.sum() > 0.9 * (other.coverage > 0).sum()
    difference = np.abs(maps.diffuse_albedo - other.diffuse_albedo)[where].mean()
    assert difference < 0.25 * other.diffuse_albedo[where].mean()
    assert angle(maps.specular_normal, other.specular_normal, where) < 10


@pytest.mark.parametrize("config", [CONFIG, PAPER], ids=["unshade", "paper"])
def test_one_view(capture: Editable, config: str) -> None:
    capture.keep_training(1)
    maps = capture.solve(config)
    assert 0.1 < (maps.coverage > 0).mean() < 0.9


def test_a_view_whose_mask_is_empty_adds_nothing(capture: Editable) -> None:
    last = capture.training[-1]
    capture.change_png("masks", last, np.zeros_like)
    maps = capture.solve()
    capture.keep_training(len(capture.training) - 1)
    np.testing.assert_array_equal(maps.coverage, capture.solve().coverage)


@pytest.mark.parametrize("config", [CONFIG, PAPER], ids=["unshade", "paper"])
def test_a_camera_that_looks_away_adds_nothing(capture: Editable, config: str) -> None:
    capture.change_frame(capture.training[1], look_away)
    capture.solve(config)


def look_away(frame: dict[str, Any]) -> None:
    matrix = np.array(frame["transform_matrix"])
    matrix[:3, [0, 2]] *= -1
    frame["transform_matrix"] = matrix.tolist()


def test_nothing_visible_in_any_view_is_refused(capture: Editable) -> None:
    for name in capture.training:
        capture.change_frame(name, look_away)
    message = capture.refusal()
    assert "the mesh covers 0.00 of the masks" in message and "PyTorch3D's camera axes" in message


def test_empty_masks_everywhere_are_refused(capture: Editable) -> None:
    for name in capture.training:
        capture.change_png("masks", name, np.zeros_like)
    assert "check the camera matrices" in capture.refusal()


def test_unseen_texels_take_their_neighbours_values(capture: Editable) -> None:
    """A small window in a single view: most of the chart is never seen."""
    capture.keep_training(1)

    def window(mask: np.ndarray) -> np.ndarray:
        kept = np.zeros_like(mask)
        kept[44:56, 44:56] = mask[44:56, 44:56]
        return kept

    capture.change_png("masks", capture.training[0], window)
    maps = capture.solve()
    assert 0 < (maps.coverage > 0).mean() < 0.05
    seen = maps.diffuse_albedo[maps.coverage > 0]
    assert maps.diffuse_albedo.max() <= seen.max() * 1.05 and maps.diffuse_albedo.min() >= seen.min() * 0.95


def test_a_view_of_a_single_pixel(capture: Editable) -> None:
    def single(mask: np.ndarray) -> np.ndarray:
        kept = np.zeros_like(mask)
        kept[50, 50] = 255
        return kept

    for name in capture.training[1:]:
        capture.change_png("masks", name, single)
    capture.solve()


def test_cameras_and_picture_sizes_that_differ(capture: Editable, untouched: unshade.Maps) -> None:
    """One view cropped off centre to an odd size, one at half its size, one with pixels that are not square."""
    crop, half, wide, *_ = capture.training

    def cropped(frame: dict[str, Any]) -> None:
        frame.update(w=71, h=83, cx=frame["cx"] - 11, cy=frame["cy"] - 9)

    def halved(frame: dict[str, Any]) -> None:
        frame.update(
            {key: frame[key] // 2 for key in "wh"} | {key: frame[key] / 2 for key in ("cx", "cy", "fl_x", "fl_y")}
        )

    def stretched(frame: dict[str, Any]) -> None:
        frame.update(w=2 * frame["w"], cx=2 * frame["cx"], fl_x=2 * frame["fl_x"])

    for name, frame, pixels in (
        (crop, cropped, lambda a: a[9:92, 11:82]),
        (half, halved, lambda a: a[::2, ::2]),
        (wide, stretched, lambda a: a.repeat(2, axis=1)),
    ):
        capture.change_frame(name, frame)
        capture.change_image(name, pixels)
        for kind in ("masks", "labels"):
            capture.change_png(kind, name, pixels)
    looks_like(capture.solve(), untouched)


def test_a_black_picture_among_others(capture: Editable) -> None:
    capture.change_image(capture.training[0], np.zeros_like)
    assert capture.solve().diffuse_albedo.max() > 0.05


def test_black_pictures_alone_are_refused(capture: Editable) -> None:
    for name in capture.training:
        capture.change_image(name, np.zeros_like)
    assert "every training picture is black" in capture.refusal()


@pytest.mark.parametrize("config", [CONFIG, PAPER], ids=["unshade", "paper"])
def test_saturated_pictures(capture: Editable, config: str) -> None:
    for name in capture.training:
        capture.change_image(name, np.ones_like)
    capture.solve(config)


@pytest.mark.parametrize("exposure", [1e-4, 1e4])
def test_pictures_of_another_exposure(capture: Editable, exposure: float) -> None:
    for name in capture.training:
        capture.change_image(name, lambda image: image * np.float32(exposure))
    maps = unshade.solve(unshade.Capture(capture.folder), config=CONFIG)
    assert all(np.isfinite(array).all() for array in (maps.diffuse_albedo, maps.specular_albedo, maps.specular_normal))


def test_clipped_highlights(capture: Editable, untouched: unshade.Maps) -> None:
    for name in capture.training:
        capture.change_image(name, lambda image: image.clip(0, np.quantile(image[image > 0], 0.9)))
    looks_like(capture.solve(), untouched)


@pytest.mark.parametrize("config", [CONFIG, PAPER], ids=["unshade", "paper"])
def test_no_labels(capture: Editable, config: str) -> None:
    for name in capture.training:
        capture.change_frame(name, lambda frame: frame.pop("label_path"))
    shutil.rmtree(capture.folder / "labels")
    capture.solve(config)


def test_labels_of_a_single_view(capture: Editable) -> None:
    for name in capture.training[1:]:
        capture.change_frame(name, lambda frame: frame.pop("label_path"))
    capture.solve()


def test_empty_labels(capture: Editable) -> None:
    for name in capture.training:
        capture.change_png("labels", name, np.zeros_like)
    capture.solve()


@pytest.mark.parametrize("config", [CONFIG, PAPER], ids=["unshade", "paper"])
@pytest.mark.parametrize("side", [16, 64, 256])
def test_sizes_of_textures(capture: Editable, config: str, side: int) -> None:
    config = config.replace("iterations = 5", "iterations = 1").replace("texture_size = 64", f"texture_size = {side}")
    assert capture.solve(config).diffuse_albedo.shape == (side, side, 3)


@pytest.mark.heavy
def test_textures_of_4096(capture: Editable) -> None:
    """The largest that is promised, once through every stage of the paper."""
    capture.keep_training(1)
    config = PAPER.replace(
        "iterations = 5, texture_size = 64", "rounds = 1, iterations = 1, texture_size = 4096, deviation_blur = 0.0"
    )
    maps = unshade.solve(unshade.Capture(capture.folder), config=config)
    assert maps.diffuse_albedo.shape == (4096, 4096, 3)
    some = (slice(None, None, 16), slice(None, None, 16))
    assert np.isfinite(maps.diffuse_albedo[some]).all() and np.isfinite(maps.specular_albedo[some]).all()
    np.testing.assert_allclose(np.linalg.norm(maps.specular_normal[some], axis=-1), 1, atol=1e-4)


def test_degenerate_triangles(capture: Editable, untouched: unshade.Maps) -> None:
    """Points, needles and triangles without a place in the texture."""

    def add(mesh: dict[str, np.ndarray]) -> None:
        f, count = mesh["f"], len(mesh["v"])
        points, needles = f[::7][:, [0, 0, 0]], f[::5][:, [0, 1, 1]]
        # Three vertices on a line, and a triangle whose corners have the same UV.
        edge = mesh["v"][f[10]]
        mesh["v"] = np.concatenate([mesh["v"], [edge[0], edge[1], (edge[0] + edge[1]) / 2], edge + [0, 0, -0.001]])
        mesh["vt"] = np.concatenate([mesh["vt"], mesh["vt"][f[10][[0, 1, 0]]], mesh["vt"][f[10][[0, 0, 0]]]])
        mesh["vn"] = np.concatenate([mesh["vn"], mesh["vn"][f[10]], mesh["vn"][f[10]]])
        mesh["f"] = np.concatenate([f, points, needles, np.arange(count, count + 6).reshape(2, 3)])

    capture.change_mesh(add)
    looks_like(capture.solve(), untouched)


def test_a_mesh_without_normals_that_has_degenerate_triangles(capture: Editable, untouched: unshade.Maps) -> None:
    def change(mesh: dict[str, np.ndarray]) -> None:
        # A vertex that only a point belongs to has no normal at all.
        mesh["v"] = np.concatenate([mesh["v"], mesh["v"][:1] * 1.5])
        mesh["vt"] = np.concatenate([mesh["vt"], mesh["vt"][:1]])
        mesh["vn"] = np.empty((0, 3))
        mesh["f"] = np.concatenate([mesh["f"], [[len(mesh["v"]) - 1] * 3]])

    capture.change_mesh(change)
    looks_like(capture.solve(), untouched)


@pytest.mark.parametrize("normals", [True, False])
def test_duplicated_vertices(capture: Editable, untouched: unshade.Maps, normals: bool) -> None:
    """Every triangle has corners of its own; without normals they are still smooth."""

    def unweld(mesh: dict[str, np.ndarray]) -> None:
        corners = mesh["f"].ravel()
        for key in ("v", "vt", "vn"):
            mesh[key] = mesh[key][corners]
        mesh["f"] = np.arange(len(corners)).reshape(-1, 3)
        if not normals:
            mesh["vn"] = np.empty((0, 3))

    capture.change_mesh(unweld)
    maps = capture.solve()
    looks_like(maps, untouched)
    assert angle(maps.specular_normal, untouched.specular_normal, untouched.coverage) < 1.5


def negate_all(mesh: dict[str, np.ndarray]) -> None:
    mesh["vn"] *= -1


def negate_some(mesh: dict[str, np.ndarray]) -> None:
    mesh["vn"][::9] *= -1


def reverse_all(mesh: dict[str, np.ndarray]) -> None:
    mesh["f"] = mesh["f"][:, ::-1]


def reverse_some(mesh: dict[str, np.ndarray]) -> None:
    mesh["f"][::3] = mesh["f"][::3, ::-1]


def inside_out(mesh: dict[str, np.ndarray]) -> None:
    negate_all(mesh)
    reverse_all(mesh)


def reversed_without_normals(mesh: dict[str, np.ndarray]) -> None:
    reverse_all(mesh)
    mesh["vn"] = np.empty((0, 3))


@pytest.mark.parametrize(
    "fault", [negate_all, negate_some, reverse_all, reverse_some, inside_out, reversed_without_normals]
)
def test_inverted_normals_and_triangles_are_turned_back(
    capture: Editable, photographs: Path, untouched: unshade.Maps, fault: Callable
) -> None:
    capture.change_mesh(fault)
    sound, read = (unshade.Capture(folder).mesh for folder in (photographs, capture.folder))
    assert (sound["normals"] * read["normals"]).sum(-1).mean() > 0.99
    facing = [np.cross(*np.diff(mesh["vertices"][mesh["triangles"]], axis=1).swapaxes(0, 1)) for mesh in (sound, read)]
    assert (np.multiply(*facing).sum(-1) > 0).mean() > 0.9999
    if fault is reversed_without_normals:
        maps = capture.solve()
        looks_like(maps, untouched)
        assert angle(maps.specular_normal, untouched.specular_normal, untouched.coverage) < 1.5


def test_a_noisy_mesh_from_photogrammetry(capture: Editable) -> None:
    """Half a millimetre of noise, rough normals, a hole and a loose scrap."""
    rng = np.random.default_rng(7)

    def roughen(mesh: dict[str, np.ndarray]) -> None:
        mesh["v"] += 0.0005 * rng.standard_normal(mesh["v"].shape)
        mesh["vn"] += 0.3 * rng.standard_normal(mesh["vn"].shape)
        middle = mesh["v"][mesh["f"]].mean(1)
        mesh["f"] = mesh["f"][np.linalg.norm(middle - middle[len(middle) // 2], axis=1) > 0.012]
        count = len(mesh["v"])
        mesh["v"] = np.concatenate([mesh["v"], mesh["v"][mesh["f"][0]] + [0.1, 0.1, 0.05]])
        for key in ("vt", "vn"):
            mesh[key] = np.concatenate([mesh[key], mesh[key][mesh["f"][0]]])
        mesh["f"] = np.concatenate([mesh["f"], [[count, count + 1, count + 2]]])

    capture.change_mesh(roughen)
    capture.solve()
    capture.solve(PAPER)


def test_soft_mask_edges_and_negative_colours(capture: Editable) -> None:
    name = capture.training[0]
    capture.change_png("masks", name, lambda mask: np.array(Image.fromarray(mask).resize((48, 48)).resize((96, 96))))
    capture.change_image(name, lambda image: image - 0.02)
    capture.solve()

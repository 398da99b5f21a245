"""Lens, aperture, motion and stated poses, against formulas that know nothing of our code."""

import dataclasses
import math
from pathlib import Path

import mitsuba as mi
import numpy as np
import pytest
import render_toy
from scipy.spatial.transform import Rotation

from unshade.camera.camera import Camera, look_at
from unshade.camera.distortion import Distortion
from unshade.errors import SceneError
from unshade.face import Chart
from unshade.formation import Lens, camera_lens, camera_model, capture_camera, stated_frame
from unshade.render import lights
from unshade.render.passes import render_layers
from unshade.render.probes import view_through_centres
from unshade.render.rigs import cameras
from unshade.render.scene import ChartMaps, HeadScene
from unshade.scene_file import parse_scene

LENS = Distortion(-0.25, 0.08, 0.004, -0.003)
BENT = Camera("000", 60, 44, 55.0, look_at(np.array([0.2, 0.1, 0.45]), np.zeros(3)), True, LENS)


def opencv_pixels(camera, points):
    """cv2.projectPoints, spelt out: axes x right, y down, z forward."""
    to_camera = np.linalg.inv(camera.matrix @ np.diag([1.0, -1.0, -1.0, 1.0]))
    x, y, z = (to_camera[:3, :3] @ points.T + to_camera[:3, 3:]).astype(float)
    a, b = x / z, y / z
    r2 = a**2 + b**2
    radial = 1 + LENS.k1 * r2 + LENS.k2 * r2**2
    u = a * radial + 2 * LENS.p1 * a * b + LENS.p2 * (r2 + 2 * a**2)
    v = b * radial + LENS.p1 * (r2 + 2 * b**2) + 2 * LENS.p2 * a * b
    return np.stack([camera.focal * u + camera.width / 2, camera.focal * v + camera.height / 2], 1)


def pixel_centres(camera):
    return np.stack(np.meshgrid(np.arange(camera.width) + 0.5, np.arange(camera.height) + 0.5), -1).reshape(-1, 2)


def test_pixels_are_where_opencv_puts_them():
    along = BENT.position + 0.7 * BENT.pixel_directions()
    assert np.abs(opencv_pixels(BENT, along) - pixel_centres(BENT)).max() < 1e-8
    assert np.abs(BENT.project(along) - pixel_centres(BENT)).max() < 1e-8
    # It bends: several pixels in the corners, none in the middle.
    straight = dataclasses.replace(BENT, distortion=None).project(along) - pixel_centres(BENT)
    assert np.abs(straight[0]).max() > 2 and np.abs(straight[len(straight) // 2 + 30]).max() < 0.1
    terms = {key: BENT.frame()[key] for key in ("k1", "k2", "p1", "p2")}
    assert terms == dataclasses.asdict(LENS)
    assert not {"k1", "k2", "p1", "p2"} & set(dataclasses.replace(BENT, distortion=None).frame())


def test_rendered_rays_are_those_of_the_pixels():
    centres = pixel_centres(BENT)
    ray = Lens(BENT).ray(mi.Float(centres[:, 0]), mi.Float(centres[:, 1]), None)
    # Single precision: a thousandth of a pixel.
    assert np.abs(np.array(ray.d).T - BENT.pixel_directions()).max() < 1e-3 / BENT.focal
    assert np.abs(np.array(ray.o).T - BENT.position).max() < 1e-6


def test_masks_see_through_the_lens():
    face = render_toy.toy_face()
    view = view_through_centres(HeadScene(face.chart, face.parts, ChartMaps.truth(face)), BENT)
    rows, columns = np.nonzero(view.mask)
    off = opencv_pixels(BENT, view.position[rows, columns]) - np.stack([columns, rows], 1) - 0.5
    assert len(rows) > 100 and np.abs(off).max() < 2e-3


def test_points_beyond_the_picture_stay_beyond_it():
    """The polynomial alone would fold these directions back into the picture."""
    angles, radii = np.meshgrid(np.linspace(0, 2 * np.pi, 50), np.linspace(1.0, 30.0, 80))
    local = np.stack([radii * np.cos(angles), radii * np.sin(angles), np.full_like(radii, -1)], -1).reshape(-1, 3)
    for terms in (LENS, Distortion(-0.3, 0.0, 0.0, 0.0), Distortion(0.2, 0.0, 0.0, 0.0)):
        camera = dataclasses.replace(BENT, distortion=terms)
        x, y = camera.project(camera.position + local @ camera.matrix[:3, :3].T).T
        assert not ((x > 0) & (x < camera.width) & (y > 0) & (y < camera.height)).any()


@pytest.mark.parametrize("terms", [(-0.9, 0, 0, 0), (0.0, -1.0, 0, 0), (0, 0, 0.5, 0.4), (-2.0, 0.5, 0, 0)])
def test_lenses_that_fold_the_picture_are_refused(terms):
    with pytest.raises(SceneError, match="folds the picture of camera 000"):
        dataclasses.replace(BENT, distortion=Distortion(*map(float, terms)))


WIDE, TALL, FOCAL, DEPTH = 48, 12, 300.0, 0.5
LOOK = Camera("000", WIDE, TALL, FOCAL, look_at(np.array([0.0, 0.0, DEPTH]), np.zeros(3)), True)


def edge_scene(level):
    """A white half plane at z = 0 whose edge crosses the middle of the picture: upright
    (white on the left), or level (white below)."""
    corners = np.array([[-2, -2, 0], [0, -2, 0], [0, 2, 0], [-2, 2, 0]], np.float32)
    if level:
        corners = corners @ np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]], np.float32)
    uv = np.array([[0.1, 0.1], [0.9, 0.1], [0.9, 0.9], [0.1, 0.9]], np.float32)
    chart = Chart(corners, np.tile(np.float32([0, 0, 1]), (4, 1)), uv, np.array([[0, 1, 2], [0, 2, 3]], np.uint32))
    return HeadScene(chart, [], ChartMaps(np.full((2, 2, 3), 0.5, np.float32))).lit(lights.Dome())


UPRIGHT, LEVEL = edge_scene(False), edge_scene(True)


def edge_profile(lens, lit=UPRIGHT, camera=LOOK, seed=1):
    """White share of every column (or row), 1 on the white side."""
    layers = render_layers(lit, camera.sensor(256), samples=256, depth=2, seed=seed, lens=lens)
    assert layers.specular.max() < 1e-6
    white = layers.diffuse[..., 0] / layers.diffuse.max()
    return white.mean(0 if lit is UPRIGHT else 1)


def expected_profile(spread, size=WIDE):
    """A step convolved with a spread function's integral and with the pixel."""
    fine = (np.arange(size * 50) + 0.5) / 50 - size / 2
    return 1 - spread(fine).reshape(size, 50).mean(1)


def disk_edge(radius):
    """Integral of a uniform disk of this radius over a half plane."""

    def spread(x):
        s = (x / radius).clip(-1, 1)
        return 0.5 + (np.arcsin(s) + s * np.sqrt(1 - s * s)) / np.pi

    return spread


@pytest.mark.parametrize(("radius", "focus"), [(0.01, 0.6), (0.01, 0.4), (0.02, 0.55)])
def test_defocus_is_the_analytic_circle_of_confusion(radius, focus):
    blur = radius * FOCAL * abs(1 / DEPTH - 1 / focus)
    measured = edge_profile(Lens(LOOK, aperture_radius=radius, focus_distance=focus))
    assert 0.5 < blur < 3
    assert np.abs(measured - expected_profile(disk_edge(blur))).max() < 0.01
    # The tolerance tells a circle a tenth too large.
    assert np.abs(measured - expected_profile(disk_edge(blur * 1.1))).max() > 0.01


def test_points_in_focus_are_sharp():
    measured = edge_profile(Lens(LOOK, aperture_radius=0.02, focus_distance=DEPTH))
    assert np.abs(measured - (np.arange(WIDE) < WIDE / 2)).max() < 1e-3


@pytest.mark.parametrize("pixels", [3.0, 8.0])
def test_motion_smears_an_edge_over_its_pixels_and_across_it_alone(pixels):
    scene = formed(motion_pixels=pixels, motion_direction_degrees=0.0)
    lens = camera_lens(LOOK, scene)
    ramp = expected_profile(lambda x: (x / pixels + 0.5).clip(0, 1))
    assert np.abs(edge_profile(lens) - ramp).max() < 0.015
    assert np.abs(edge_profile(lens, LEVEL) - (np.arange(TALL) >= TALL / 2)).max() < 0.01
    upwards = camera_lens(LOOK, formed(motion_pixels=pixels, motion_direction_degrees=90.0))
    assert np.abs(edge_profile(upwards) - (np.arange(WIDE) < WIDE / 2)).max() < 0.01
    # Degrees are pixels over the focal length.
    in_degrees = camera_lens(
        LOOK, formed(motion_degrees=math.degrees(2 * math.atan(pixels / 2 / FOCAL)), motion_direction_degrees=0.0)
    )
    assert in_degrees.turn == pytest.approx(lens.turn)


def test_a_lens_without_faults_is_a_pinhole_and_equal_seeds_give_equal_bits():
    face = render_toy.toy_face()
    lit = HeadScene(face.chart, face.parts, ChartMaps.truth(face)).lit(lights.studio())
    camera = dataclasses.replace(BENT, distortion=None)
    heard = []

    def picture(lens, seed=1):
        def hear(done, total):
            heard.append((done, total))

        return render_layers(lit, camera.sensor(16), samples=16, depth=4, seed=seed, lens=lens, progress=hear).total

    pinhole = picture(None)
    assert heard == [(0, 60 * 44 * 16), (60 * 44 * 16, 60 * 44 * 16)]
    # The same samples through the same pixels; rounding moves a ray over an edge now and then.
    assert np.abs(picture(Lens(camera)) - pinhole).mean() < 1e-4 * pinhole.mean()
    shaken = Lens(BENT, aperture_radius=0.004, focus_distance=0.4, turn=0.02, turn_axis=(0.6, 0.8))
    assert picture(shaken).tobytes() == picture(shaken).tobytes()
    assert (picture(shaken) != picture(shaken, seed=2)).any()


def formed(**formation):
    return parse_scene(render_toy.toy_table() | {"image_formation": formation}, "toy", Path())


def test_the_lens_focuses_on_the_eyes_and_withheld_views_stay_perfect():
    scene = formed(aperture_radius_mm=2.0, lens_distortion=[-0.1, 0.02, 0.001, 0.0], pose_noise_mm=1.0)
    assert camera_model(scene) == "OPENCV" and camera_model(formed(pose_noise_mm=1.0)) == "PINHOLE"
    rig, mesh = cameras(scene.rig, 40, 32), render_toy.toy_face().chart
    for camera in rig:
        real, frame = capture_camera(camera, scene), stated_frame(camera, scene, mesh)
        lens = camera_lens(real, scene)
        if camera.train:
            assert dataclasses.astuple(real.distortion) == (-0.1, 0.02, 0.001, 0.0) and frame["k1"] == -0.1
            # Between the corneas, 80 mm before the origin (as far as the camera's tilt lets it).
            assert lens.focus_distance == pytest.approx(np.linalg.norm(camera.position - [0, 0, 0.08]), abs=0.01)
            assert lens.aperture_radius == 0.002 and lens.turn == 0
        else:
            assert lens is None and frame == camera.frame() and real == camera


def stated(scene, count=150):
    """Cameras of many views and the matrices that are stated for them."""
    mesh = render_toy.toy_face().chart
    rig = [dataclasses.replace(LOOK, name=str(number)) for number in range(count)]
    return [(camera, np.array(stated_frame(camera, scene, mesh)["transform_matrix"])) for camera in rig]


def test_pose_noise_has_the_stated_scatter():
    errors = [
        np.linalg.inv(camera.matrix) @ matrix
        for camera, matrix in stated(formed(pose_noise_degrees=0.3, pose_noise_mm=2.0))
    ]
    turns = np.degrees([Rotation.from_matrix(e[:3, :3]).as_rotvec() for e in errors])
    shifts = 1000 * np.array([e[:3, 3] for e in errors])
    # 450 normal deviates: their standard deviation is known to 3.3 percent.
    assert turns.std() == pytest.approx(0.3, rel=0.12) and shifts.std() == pytest.approx(2.0, rel=0.12)
    assert abs(turns.mean()) < 0.06 and abs(shifts.mean()) < 0.4
    assert all(np.abs(e[:3, :3] @ e[:3, :3].T - np.eye(3)).max() < 1e-12 for e in errors)
    assert abs(np.corrcoef(turns[:, 0], turns[:, 1])[0, 1]) < 0.3


def test_pose_noise_in_pixels_is_the_reprojection_error():
    scene, points = formed(pose_noise_pixels=1.5), render_toy.toy_face().chart.vertices.astype(float)
    moved = [
        dataclasses.replace(camera, matrix=m).project(points) - camera.project(points) for camera, m in stated(scene)
    ]
    assert np.sqrt(np.mean(np.square(moved))) == pytest.approx(1.5, rel=0.12)


def test_stated_poses_depend_on_seed_and_view_alone():
    first, again = (stated(formed(pose_noise_mm=1.0), 2) for _ in range(2))
    assert all((a[1] == b[1]).all() for a, b in zip(first, again))
    assert (first[0][1] != first[1][1]).any()
    table = render_toy.toy_table(seed=5) | {"image_formation": {"pose_noise_mm": 1.0}}
    assert (stated(parse_scene(table, "toy", Path()), 1)[0][1] != first[0][1]).any()
    assert all((matrix == camera.matrix).all() for camera, matrix in stated(formed(), 2))

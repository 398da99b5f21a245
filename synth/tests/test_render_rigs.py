"""Cameras: where a rig puts them, and that files, rays and Mitsuba agree on pixels."""

import json
import math

import mitsuba as mi
import numpy as np
import pytest
import render_toy

from unshade.camera.camera import Camera, look_at
from unshade.files.obj_text import obj_text
from unshade.render.probes import TexelVisibility, nearest_texels, view_through_centres
from unshade.render.rigs import cameras
from unshade.render.scene import ChartMaps, HeadScene
from unshade.scene_file import Rig
from unshade.scene_file.rig import parse_rig

FACE = render_toy.toy_face()
HEAD = HeadScene(FACE.chart, FACE.parts, ChartMaps.truth(FACE))
PHONE = Rig("phone", "phone", train=9, test=2, seed=4)
EMILY = Rig("emily", "emily")


def azimuths(rig, train):
    return np.degrees([math.atan2(c.position[0], c.position[2]) for c in rig if c.train == train])


def test_phone_views_are_spread_within_the_angle():
    rig = cameras(PHONE, 64, 64)
    away = np.array([(c.position - [0, 0, 0.06]) / np.linalg.norm(c.position - [0, 0, 0.06]) for c in rig])
    angles = np.degrees(np.arccos(away[:, 2]))
    assert (angles <= 45).all()
    # One view in each ninth of the range, so none is far from its neighbours.
    sideways = np.sort(np.degrees(np.arctan2(away[:9, 0], away[:9, 2])))
    assert ((sideways >= np.linspace(-45, 35, 9)) & (sideways <= np.linspace(-35, 45, 9))).all()
    assert [c.train for c in rig] == [True] * 9 + [False] * 2
    assert (angles[9:] <= 45 * 0.5 + 1).all()
    assert [c.name for c in rig] == [f"{i:03d}" for i in range(11)]


def test_phone_views_depend_on_the_seed_alone():
    again = cameras(PHONE, 64, 64)
    other = cameras(Rig("phone", "phone", train=9, test=2, seed=5), 64, 64)
    assert all((a.matrix == b.matrix).all() for a, b in zip(cameras(PHONE, 64, 64), again))
    assert all((a.matrix != b.matrix).any() for a, b in zip(again, other))


def test_emily_is_the_public_rig_and_two_mirrors():
    rig = cameras(EMILY, 200, 300)
    assert len(rig) == 9 and [c.train for c in rig] == [True] * 8 + [False]
    # The withheld view is the frontal one, with others on all sides.
    assert abs(azimuths(rig, False)[0]) < 5
    assert azimuths(rig, True).min() < -60 and azimuths(rig, True).max() > 60
    vertical = [math.degrees(2 * math.atan(c.height / 2 / c.focal)) for c in rig]
    # The stated vertical angles: 13.1 degrees, 17.8 for the low camera.
    assert round(max(vertical), 1) == 17.8
    assert all(abs(v - 13.1) < 0.2 for v in sorted(vertical)[:-1])
    for camera in rig:
        # The middle of the face lies in the middle of the film, and all of it on it.
        off = camera.project(np.array([[0.0, 0.0, 0.06]]))[0] - [100, 150]
        assert np.abs(off).max() < 22


def rig_of(kind, **keys):
    return parse_rig({"name": kind, "kind": kind} | keys, "rig")


def from_face(views):
    """Unit directions and distances from the middle of the face."""
    away = np.array([view.position - [0, 0, 0.06] for view in views])
    distance = np.linalg.norm(away, axis=1)
    return away / distance[:, None], distance


def test_a_phone_at_arms_length_may_keep_its_whole_frame():
    """26 mm equivalent: 24 mm of film across the shorter side; 25 degrees are its middle half."""
    whole, cropped = (cameras(rig_of("phone", **keys), 60, 80)[0] for keys in ({"equivalent_mm": 26}, {}))
    assert whole.focal / 60 == pytest.approx(26 / 24)
    assert cropped.focal / whole.focal == pytest.approx(1 / 0.48, rel=0.01)
    assert (whole.matrix == cropped.matrix).all()
    _, distance = from_face(cameras(rig_of("phone", train=40), 60, 80))
    assert 0.52 <= distance.min() and distance.max() <= 0.58


def test_the_desktop_rig_surrounds_its_withheld_view():
    views = cameras(rig_of("desktop", seed=3), 64, 64)
    assert [view.train for view in views] == [True] * 5 + [False]
    away, distance = from_face(views)
    assert np.abs(distance - 0.7).max() < 0.06
    assert abs(away[5, 0]) < 0.03 and (away[:5, 0] < -0.6).any() and (away[:5, 0] > 0.6).any()
    assert away[:5, 1].min() < away[5, 1] < away[:5, 1].max()
    # The whole head is in every picture.
    corners = np.array([[x, y, 0.05] for x in (-0.08, 0.08) for y in (-0.11, 0.11)])
    assert all((view.project(corners) > 0).all() and (view.project(corners) < 64).all() for view in views)
    other = cameras(rig_of("desktop", seed=4), 64, 64)
    assert all(0 < np.abs(a.position - b.position).max() < 0.021 for a, b in zip(views, other))


@pytest.mark.parametrize("train, test", [(5, 0), (24, 3), (97, 10)])
def test_a_dome_covers_its_cap_evenly(train, test):
    views = cameras(rig_of("dome", train=train, test=test, max_angle_degrees=60, seed=7), 64, 64)
    assert sum(view.train for view in views) == train and len(views) == train + test
    away, distance = from_face(views)
    np.testing.assert_allclose(distance, 0.9)
    angle = np.degrees(np.arccos(away[:, 2]))
    assert angle.max() <= 60
    # Equal areas hold equal counts: half the views lie in the inner half of the cap's area.
    inner = np.degrees(np.arccos((1 + 0.5) / 2))
    assert abs((angle < inner).sum() - (train + test) / 2) <= 1
    # No two views are much nearer than a grid of this density has them: a cap of 60 degrees is pi sr.
    nearest = np.arccos((away @ away.T - 2 * np.eye(len(away))).max(1).clip(-1, 1))
    spacing = math.sqrt(math.pi / len(away))
    assert nearest.min() > 0.7 * spacing and nearest.max() < 1.7 * spacing


@pytest.mark.parametrize("kind", ["phone", "emily", "desktop", "dome"])
def test_named_views_are_withheld_and_all_cameras_stay(kind):
    default = {view.name: view for view in cameras(rig_of(kind), 64, 64)}
    views = cameras(rig_of(kind, withheld=["003", "001"]), 64, 64)
    assert [view.name for view in views if not view.train] == ["001", "003"]
    assert not views[-1].train and views[0].train
    assert {view.name for view in views} == set(default)
    assert all((view.matrix == default[view.name].matrix).all() for view in views)


@pytest.mark.parametrize("size", [(48, 32), (32, 48), (40, 40)])
def test_pixels_of_files_rays_and_mitsuba_agree(size):
    """A mesh vertex projected through the written camera lands where the pixel-centre
    rays, Mitsuba's sensor and the texture coordinates say it is."""
    rig = cameras(PHONE, *size)
    frames = json.loads(json.dumps([camera.frame() for camera in rig]))
    for camera, frame in list(zip(rig, frames))[::4]:
        view = view_through_centres(HEAD, camera)
        rows, columns = np.nonzero(view.mask)
        assert len(rows) > 100
        # Through the numbers of the file alone, as a reader would.
        world_to_camera = np.linalg.inv(np.array(frame["transform_matrix"]))
        local = view.position[rows, columns] @ world_to_camera[:3, :3].T + world_to_camera[:3, 3]
        x = frame["cx"] + frame["fl_x"] * local[:, 0] / -local[:, 2]
        y = frame["cy"] - frame["fl_y"] * local[:, 1] / -local[:, 2]
        assert np.abs(x - (columns + 0.5)).max() < 2e-3
        assert np.abs(y - (rows + 0.5)).max() < 2e-3
        # Mitsuba's own sensor looks through the same pixels.
        directions = camera.pixel_directions().reshape(*size[::-1], 3)
        for i, j in ((0, 0), (size[0] - 1, 0), (5, size[1] - 1)):
            ray, _ = camera.sensor(16).sample_ray(
                0.0, 0.5, mi.Point2f((i + 0.5) / size[0], (j + 0.5) / size[1]), mi.Point2f(0.5)
            )
            assert np.abs(np.array(ray.d).ravel() - directions[j, i]).max() < 1e-5
            assert np.abs(np.array(ray.o).ravel() - camera.position).max() < 0.011


def test_texture_coordinates_lead_back_to_the_surface():
    """What a ray sees at (u, v) is where the OBJ file puts (u, v)."""
    lines = [line.split() for line in obj_text(FACE.chart).splitlines()]
    vertices, uv = (np.array([line[1:] for line in lines if line[0] == key], float) for key in ("v", "vt"))
    faces = np.array([[corner.split("/") for corner in line[1:]] for line in lines if line[0] == "f"], int) - 1
    assert (faces == faces[..., :1]).all()
    np.testing.assert_array_equal(vertices.astype(np.float32), FACE.chart.vertices)
    camera = cameras(PHONE, 48, 48)[4]
    view = view_through_centres(HEAD, camera)
    from scipy.interpolate import LinearNDInterpolator

    surface = LinearNDInterpolator(uv, vertices)(view.uv[view.mask])
    off = np.linalg.norm(surface - view.position[view.mask], axis=1)
    # The grid's triangulation and scipy's differ along diagonals, by a sagitta.
    assert np.nanmax(off) < 2e-3 and np.nanmedian(off) < 1e-4


def test_pictures_show_the_texel_that_uv_names():
    """A chart that shines with its own albedo: the picture's pixel is the map's texel."""
    from unshade.render import lights
    from unshade.render.passes import render_layers

    size = 64
    ramp = np.stack(np.meshgrid((np.arange(size) + 0.5) / size, 1 - (np.arange(size) + 0.5) / size), -1)
    albedo = np.concatenate([ramp, np.full((size, size, 1), 0.5)], -1).astype(np.float32)
    alone = HeadScene(FACE.chart, [], ChartMaps(albedo))
    camera = cameras(PHONE, 48, 48)[4]
    view = view_through_centres(alone, camera)
    layers = render_layers(alone.lit(lights.Dome()), camera.sensor(64), samples=64, depth=2, seed=1)
    flat = layers.total[view.mask] / layers.total[view.mask][:, 2:] * 0.5
    assert np.abs(flat[:, :2] - view.uv[view.mask]).mean() < 4e-3


def test_nearest_texels_reads_rows_from_the_top():
    picture = np.arange(16).reshape(4, 4)
    uv = np.array([[0.1, 0.9], [0.9, 0.9], [0.1, 0.1], [1.0, 0.0]])
    assert nearest_texels(picture, uv).tolist() == [0, 3, 12, 15]


def test_texels_are_seen_where_pixels_see_them():
    """Both ways round: a texel under a pixel's centre counts as seen, and what counts as
    seen projects onto the mask and is met by its own ray."""
    camera = cameras(PHONE, 96, 96)[0]
    view = view_through_centres(HEAD, camera)
    seen = TexelVisibility(HEAD, FACE.chart, 32).seen_by(camera, view.mask)
    assert 0.1 < seen.mean() < 0.9
    inner = view.mask.copy()
    for _ in range(2):
        inner[1:-1, 1:-1] &= inner[2:, 1:-1] & inner[:-2, 1:-1] & inner[1:-1, 2:] & inner[1:-1, :-2]
    assert nearest_texels(seen, view.uv[inner]).mean() > 0.97
    # Nothing behind the eye, which stands before the chart, is seen.
    hidden = HeadScene(FACE.chart, [], ChartMaps.truth(FACE))
    all_seen = TexelVisibility(hidden, FACE.chart, 32).seen_by(camera, np.ones_like(view.mask))
    assert (all_seen & ~seen).sum() > 0 and not (seen & ~all_seen).any()


def test_a_camera_is_upright():
    matrix = look_at(np.array([0.3, 0.2, 0.5]), np.zeros(3))
    assert np.allclose(matrix[:3, :3] @ matrix[:3, :3].T, np.eye(3))
    assert matrix[1, 0] == pytest.approx(0) and matrix[1, 1] > 0
    assert np.linalg.det(matrix) == pytest.approx(1)
    assert Camera("x", 10, 10, 10.0, matrix, True).project(np.zeros((1, 3)))[0] == pytest.approx([5, 5])

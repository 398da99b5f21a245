"""What a camera sees of eyes and mouth, by rays: lids that cover, films that lie on, teeth that stay inside."""

import mitsuba as mi
import numpy as np
import pytest
from scipy.ndimage import label

from unshade.face import FaceSpec, cache, eyeball, eyes, lids
from unshade.face.caruncle import make_caruncles
from unshade.face.eye_paint import paint_eyes
from unshade.face.geometry import place
from unshade.face.identity import pose, shape
from unshade.face.lashes import make_lashes
from unshade.face.opening import openings
from unshade.face.teeth import make_mouth
from unshade.face.wet_line import make_wet_lines

BLINK = {"eyeBlinkLeft": 1.0, "eyeBlinkRight": 1.0}
SMILE = {"mouthSmileLeft": 0.6, "mouthSmileRight": 0.6}
PITCH = 0.0004
"""Distance (m) of the parallel rays."""


def placed(seed, **expression):
    head, spec = cache.load_head(), FaceSpec.sample(seed, expression=expression)
    return head, spec, place(head, shape(head, spec), pose(head, spec))


def mesh(positions, triangles):
    shape = mi.Mesh("part", len(positions), len(triangles))
    parameters = mi.traverse(shape)
    parameters["vertex_positions"] = np.ascontiguousarray(positions, np.float32).ravel()
    parameters["faces"] = np.ascontiguousarray(triangles, np.uint32).ravel()
    parameters.update()
    return mi.load_dict({"type": "scene", "part": shape})


def depth(scene, low, high, elevation):
    """Ray lengths over a grid of parallel rays that look down by `elevation` degrees."""
    x, y = np.meshgrid(np.arange(low[0], high[0], PITCH), np.arange(low[1], high[1], PITCH))
    away = np.array([0, np.sin(np.radians(elevation)), np.cos(np.radians(elevation))])
    origin = np.stack([x, y, np.full_like(x, 0.08)], -1).reshape(-1, 3) + 0.3 * away
    ray = mi.Ray3f(mi.Point3f(*origin.T.astype(np.float32)), mi.Vector3f(*map(float, -away)))
    return np.array(scene.ray_intersect_preliminary(ray).t).reshape(x.shape)


def eye_parts(head, spec, geometry):
    folds = [lids.sunken_fold(geometry.positions, head.part_chart, *eye) for eye in zip(geometry.eyes, geometry.gaze)]
    return eyes.make_eyes(geometry.eyes, geometry.gaze, folds, spec)


def seen(head, geometry, parts, low, high, *elevations):
    """Which rays meet one of the parts first: one bool picture per elevation."""
    skin = np.concatenate([head.part_chart, head.part_mouth, head.part_sockets])
    corner = geometry.positions[skin]
    near = (np.abs(corner[..., 1] - (low[1] + high[1]) / 2) < 0.07).all(axis=1) & (corner[..., 2] > 0).all(axis=1)
    skin = mesh(geometry.positions, skin[near])
    parts = [mesh(part.vertices, part.triangles) for part in parts]
    pictures = []
    for elevation in elevations:
        nearest = np.min([depth(part, low, high, elevation) for part in parts], axis=0)
        pictures.append(np.isfinite(nearest) & (nearest < depth(skin, low, high, elevation)))
    return np.array(pictures)


def seen_eyes(seed, *elevations, **expression):
    head, spec, geometry = placed(seed, **expression)
    return seen(head, geometry, eye_parts(head, spec, geometry), (-0.06, -0.02), (0.06, 0.015), *(elevations or (0.0,)))


@pytest.mark.parametrize("seed", [7, 202])
def test_a_blink_covers_the_eyeballs(seed):
    opened = seen_eyes(seed).sum()
    assert opened > 1200
    assert seen_eyes(seed, -20.0, 0.0, 25.0, **BLINK).sum(axis=(1, 2)).max() < 0.01 * opened
    assert seen_eyes(seed, **BLINK, **SMILE).sum() < 0.01 * opened
    assert 0.2 < seen_eyes(seed, eyeBlinkLeft=0.5, eyeBlinkRight=0.5).sum() / opened < 0.8


@pytest.mark.parametrize("seed", [7, 101, 202])
@pytest.mark.parametrize(
    "expression", [{}, {"eyeLookOutLeft": 1.0, "eyeLookDownRight": 1.0}, {"eyeBlinkLeft": 0.5, "eyeBlinkRight": 0.3}]
)
def test_eyeballs_show_between_the_lids_alone(seed, expression):
    """Each eye is one patch of the picture: none pokes through a lid."""
    patches, _ = label(seen_eyes(seed, **expression)[0], np.ones((3, 3)))
    size = np.bincount(patches.ravel())[1:]
    assert (size > 50).sum() == 2 and size[size <= 50].sum() <= 3


def test_the_cornea_stands_as_high_as_a_natural_one():
    limbus = np.radians(eyeball.IRIS)
    # Gullstrand: a cap of 7.8 mm radius over a limbus of 11.7 mm is 2.64 mm high.
    cap = (eyeball.height(np.zeros(1)) - np.cos(limbus))[0] / np.sin(limbus) * 5.85
    assert cap == pytest.approx(2.64, abs=0.02)
    assert eyeball.height(np.array([np.radians(60)]))[0] == pytest.approx(1, abs=1e-4)
    assert (np.diff(eyeball.height(np.linspace(0, np.pi, 500))) < 1e-9).all()


@pytest.mark.parametrize("seed", [7, 101, 202])
def test_the_wet_line_lies_on_the_eyeball_along_the_lower_lid(seed):
    head, _, geometry = placed(seed)
    lines = make_wet_lines(head, geometry)
    assert [line.name for line in lines] == ["wet_line_left", "wet_line_right"]
    margin = lids.margin_distance(geometry.positions, head.part_chart, geometry.eyes)
    for line, eye in zip(lines, geometry.eyes):
        gap = eyeball.clearance(line.vertices.astype(float), eye, np.eye(3))
        assert gap.min() > -0.0001 and gap.max() < 0.0004
        near = geometry.positions[head.chart_vertices][margin[head.chart_vertices] < 0.0008]
        distance = np.linalg.norm(
            line.vertices[:, None] - near[None, np.abs(near[:, 0] - eye[0]).argsort()[:400]], axis=2
        ).min(axis=1)
        assert np.median(distance) < 0.001
        assert np.ptp(line.vertices[:, 0]) > 0.015
        assert line.vertices[:, 1].max() < eye[1] + 0.003
    assert make_wet_lines(head, placed(seed, **BLINK)[2]) == []


@pytest.mark.parametrize("seed", [7, 202])
def test_lashes_grow_from_the_edges_of_the_lids_and_miss_the_eye(seed):
    head, spec, geometry = placed(seed)
    lids = openings(head, geometry)
    vertices = make_lashes(head, geometry, lids, np.zeros(3), spec)[0].vertices.astype(float)
    # Tubes of three sides and eight rings.
    lashes = vertices.reshape(-1, 8, 3, 3).mean(axis=2)
    margin = np.concatenate([np.concatenate([lid.upper, lid.lower]) for lid in lids])
    root, tip = lashes[:, 0], lashes[:, -1]
    distance = np.linalg.norm(root[:, None] - margin, axis=2)
    assert distance.min(axis=1).max() < 0.002
    upper = (distance.argmin(axis=1) % (2 * len(lids[0].upper))) < len(lids[0].upper)
    assert (tip[upper, 1] > root[upper, 1]).mean() > 0.95 and (tip[~upper, 1] < root[~upper, 1]).mean() > 0.95
    for eye, gaze in zip(geometry.eyes, geometry.gaze):
        assert eyeball.clearance(tip, eye, gaze).min() > 0.0005
    shut = placed(seed, **BLINK)[2]
    assert make_caruncles(openings(head, shut)) == [] and len(make_caruncles(lids)) == 2
    fallen = make_lashes(head, shut, openings(head, shut), np.zeros(3), spec)[0].vertices.reshape(-1, 8, 3, 3).mean(2)
    assert (fallen[: len(fallen) // 2, -1, 1] - fallen[: len(fallen) // 2, 0, 1]).mean() < 0


@pytest.mark.parametrize("seed", [7, 202])
def test_the_white_of_a_natural_eye_is_darkest_under_the_lids_and_reddest_in_the_corner(seed):
    head, spec, geometry = placed(seed)
    lids = openings(head, geometry)
    for part, lid in zip(paint_eyes(eye_parts(head, spec, geometry), lids, spec), lids):
        middle = 0.5 * (lid.upper + lid.lower)
        places = np.stack([middle[-40], lid.upper[-40] - [0, 0.0004, 0], middle[14]]) - lid.sphere[:3]
        x, y, z = (places @ lid.turn).T
        rows, columns = part.diffuse.shape[:2]
        row = np.arccos(z / np.linalg.norm(places, axis=1)) / np.pi * rows
        column = np.arctan2(y, x) % (2 * np.pi) / (2 * np.pi) * columns
        white, shaded, corner = part.diffuse[row.astype(int), column.astype(int)]
        assert white.min() > 0.2 and shaded.mean() < 0.8 * white.mean()
        assert corner[0] / corner[1] > 1.3 * white[0] / white[1]


@pytest.mark.parametrize("seed", [7, 202])
def test_teeth_and_tongue_stay_behind_closed_lips(seed):
    def picture(**expression):
        head, spec, geometry = placed(seed, **expression)
        return seen(head, geometry, make_mouth(head, geometry, spec), (-0.06, -0.13), (0.06, 0.0), 0.0)[0]

    # Lips may part by a slit; nothing pokes through the cheeks.
    rows = np.flatnonzero(picture().any(axis=1))
    assert len(rows) == 0 or np.ptp(rows) * PITCH < 0.002
    assert picture(jawOpen=0.6).sum() > 200

"""Expressions: named as ARKit names them, on the same chart, neutral unless asked for."""

import dataclasses

import numpy as np
import pytest

from unshade.face import FaceError, FaceSpec, base_mesh, cache
from unshade.face.expression import UNITS
from unshade.face.geometry import place
from unshade.face.identity import pose, shape
from unshade.face.teeth import make_mouth

TABLE = {"name": "x", "seed": 7, "fitzpatrick": "III"}


def placed(**expression):
    head, spec = cache.load_head(), FaceSpec.from_table(TABLE | {"expression": expression})
    return place(head, shape(head, spec), pose(head, spec))


@pytest.fixture(scope="module")
def neutral():
    return placed()


def moved(neutral, **expression):
    """Largest way (mm) that a vertex goes."""
    return 1000 * np.linalg.norm(placed(**expression).positions - neutral.positions, axis=1).max()


def test_the_units_are_those_of_the_data():
    folder = base_mesh.data_folder().parent / "faceunits01" / "targets"
    assert sorted(path.stem for path in folder.rglob("*.target")) == sorted(UNITS)
    assert len(UNITS) == 52


def test_no_expression_is_the_neutral_face_to_the_last_bit(neutral):
    head = cache.load_head()
    eyes = neutral.eyes[:, :3].mean(axis=0)
    np.testing.assert_allclose(eyes, [0, 0, 0.07], atol=1e-12)
    zero = placed(jawOpen=0.0)
    for field in dataclasses.fields(zero):
        np.testing.assert_array_equal(getattr(zero, field.name), getattr(neutral, field.name))
    spec = FaceSpec.from_table(TABLE)
    assert "expression" not in spec.to_table() and pose(head, spec) is None


@pytest.mark.parametrize(
    "unit", ["jawOpen", "eyeBlinkLeft", "eyeLookUpRight", "eyeWideLeft", "mouthSmileRight", "eyeSquintLeft"]
)
def test_a_hint_of_an_expression_moves_the_skin_a_hint(neutral, unit):
    assert moved(neutral, **{unit: 0.001}) < 0.15 < moved(neutral, **{unit: 1.0})


def test_a_unit_moves_its_own_side(neutral):
    chart = cache.load_head().chart_vertices
    way = np.linalg.norm(placed(eyeBlinkLeft=1.0).positions - neutral.positions, axis=1)[chart]
    left = neutral.positions[chart, 0] > 0
    assert way[left].max() > 0.004 and way[~left].max() < 0.0005


def test_gaze_turns_the_eyeballs_and_leaves_them_where_they_are(neutral):
    aside = placed(eyeLookOutLeft=1.0, eyeLookInRight=1.0)
    np.testing.assert_array_equal(aside.eyes, neutral.eyes)
    for turn in aside.gaze:
        np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-12)
        assert 10 < np.degrees(np.arctan2(turn[0, 2], turn[2, 2])) < 45
    assert placed(eyeLookUpLeft=1.0).gaze[0][1, 2] > 0.1


def test_an_open_jaw_takes_the_lower_teeth_along(neutral):
    head, spec = cache.load_head(), FaceSpec.from_table(TABLE)
    shut, opened = (make_mouth(head, geometry, spec)[0].vertices for geometry in (neutral, placed(jawOpen=1.0)))
    way = shut[:, 1] - opened[:, 1]
    half = len(way) // 2
    # The back teeth are nearer to the hinge.
    assert np.abs(way[:half]).max() == 0 and way[half:].min() > 0.005 and way[half:].max() > 0.02


@pytest.mark.parametrize(
    ("expression", "message"),
    [
        ({"eyeBlinkleft": 0.5}, "unknown key 'eyeBlinkleft' in expression of .face.; did you mean 'eyeBlinkLeft'"),
        ({"jaw_open": 0.5}, "did you mean 'jawOpen'"),
        ({"jawOpen": 1.5}, "jawOpen in expression of .face. is 1.5; use a number from 0 to 1"),
        ([0.5], "expression in .face. is not a table"),
    ],
)
def test_faults_name_the_unit_and_the_fix(expression, message):
    with pytest.raises(FaceError, match=message):
        FaceSpec.from_table(TABLE | {"expression": expression})


def test_a_written_expression_reads_back():
    spec = FaceSpec.from_table(TABLE | {"expression": {"mouthSmileLeft": 0.25, "jawOpen": 1, "tongueOut": 0}})
    assert spec.expression == (("jawOpen", 1.0), ("mouthSmileLeft", 0.25))
    assert FaceSpec.from_table(spec.to_table()) == spec

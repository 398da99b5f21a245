"""Tuning and held-out faces stay apart: what scenes/face-sets.toml names, and who uses which."""

import sys
from pathlib import Path

import pytest

from unshade.face import FaceSpec

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

SCENES = Path(__file__).resolve().parents[2] / "scenes"


def read(path):
    return tomllib.loads(path.read_text())


SETS = read(SCENES / "face-sets.toml")


@pytest.mark.parametrize("held", ["held_out", "held_out_full_size"])
def test_no_face_is_in_two_sets_and_every_held_out_one_is_another_person(held):
    listed = [name for names in SETS.values() for name in names]
    faces = {name: FaceSpec.from_table(read(SCENES / "faces" / name)) for name in listed}
    assert len({face.seed for face in faces.values()}) == len(faces) == len(listed)
    held_out = [faces[name] for name in SETS[held]]
    assert {face.fitzpatrick for face in held_out} == {"I", "II", "III", "IV", "V", "VI"}
    assert all(face.detail == "natural" for face in held_out)
    assert min(face.gender for face in held_out) < 0.3 and max(face.gender for face in held_out) > 0.7
    assert max(face.years for face in held_out) - min(face.years for face in held_out) > 30


@pytest.mark.parametrize("path", sorted((SCENES / "suites").glob("*.toml")), ids=lambda path: path.stem)
def test_held_out_faces_are_in_the_suites_that_are_opened_last_alone(path):
    used = {Path(face).name for face in read(path).get("faces", []) if isinstance(face, str)}
    if path.stem in ("held-out", "held-out-lights"):
        assert used == set(SETS["held_out"])
    elif path.stem in ("competitors", "seeds"):
        # What they report is of methods as they are; nothing is chosen by it.
        assert used < set(SETS["held_out"])
    elif path.stem in ("portrait", "emily", "emily-medium", "turntable-held-out"):
        assert used <= set(SETS["held_out_full_size"])
    else:
        assert not used & {*SETS["held_out"], *SETS["held_out_full_size"]}
    if path.stem in ("tuning", "portrait-tuning"):
        assert used == set(SETS["tuning"])

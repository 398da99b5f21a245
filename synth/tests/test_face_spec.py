"""The `[face]` table: complete, reproducible, and its faults named."""

import pytest

from unshade.face import FaceError, FaceSpec

TABLE = {"name": "demo", "seed": 7, "fitzpatrick": "III"}


def test_absent_fields_are_drawn_from_the_seed_alone():
    assert FaceSpec.from_table(TABLE) == FaceSpec.from_table(dict(TABLE))
    assert FaceSpec.from_table(TABLE | {"seed": 8}).gender != FaceSpec.from_table(TABLE).gender


def test_fixing_one_field_leaves_the_draws_of_the_others():
    drawn, fixed = FaceSpec.from_table(TABLE), FaceSpec.from_table(TABLE | {"age": 0.25})
    assert fixed.age == 0.25
    assert (fixed.gender, fixed.ethnicity, fixed.weight) == (drawn.gender, drawn.ethnicity, drawn.weight)


@pytest.mark.parametrize("seed", range(20))
def test_a_written_table_reads_back(seed):
    spec = FaceSpec.from_table({"name": "x", "seed": seed})
    assert FaceSpec.from_table(spec.to_table()) == spec
    assert sum(spec.ethnicity) == pytest.approx(1)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"sed": 3}, "unknown key 'sed' in .face.; did you mean 'seed'"),
        ({"seed": -1}, "seed in .face. is -1; use a whole number"),
        ({"seed": True}, "seed in .face. is True"),
        ({"name": ""}, "name in .face. is missing"),
        ({"fitzpatrick": 3}, "fitzpatrick in .face. is 3; use one of I, II"),
        ({"gender": 1.5}, "gender in .face. is 1.5; use a number from 0 to 1"),
        ({"age": float("nan")}, "age in .face. is nan"),
        ({"weight": "heavy"}, "weight in .face. is 'heavy'"),
        ({"texture_size": 512.0}, "texture_size in .face. is 512.0"),
        ({"texture_size": 20}, "texture_size in .face. is 20; use a whole number from 64"),
        ({"ethnicity": [1, 0, 0]}, "ethnicity in .face. is not a table"),
        ({"ethnicity": {"african": 0.5}}, "ethnicity in .face. sums to 0.5; make the shares sum to 1"),
        ({"ethnicity": {"martian": 1.0}}, "unknown key 'martian' in ethnicity"),
    ],
)
def test_faults_name_the_key_and_the_fix(change, message):
    with pytest.raises(FaceError, match=message) as fault:
        FaceSpec.from_table(TABLE | change)
    assert "\n" not in str(fault.value)


def test_seed_is_required():
    with pytest.raises(FaceError, match="seed in .face. is missing"):
        FaceSpec.from_table({"name": "x"})

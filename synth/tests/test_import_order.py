"""The check of import directions finds what it is for."""

import pytest
from import_order import faults

SOUND = {"low": set(), "middle": {"low"}, "high": {"low", "middle", "high.part"}, "high.part": {"low"}}


def test_imports_of_earlier_rooms_and_of_the_same_room_are_sound():
    assert faults(SOUND, ["low", "middle", "high"]) == []


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"low": {"high.part"}}, "low imports high.part, whose room stands later"),
        ({"high.part": {"high"}}, "circle: "),
        ({"new": set()}, "new: its room has no place"),
    ],
)
def test_a_fault_is_named(change, words):
    assert words in "\n".join(faults(SOUND | change, ["low", "middle", "high"]))

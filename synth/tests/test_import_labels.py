"""Label pictures of face parsers in our names."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from unshade.errors import CaptureError
from unshade.importing.parser_labels import LABELS, PARSERS, name_table, our_labels


@pytest.mark.parametrize(
    ("parser", "count", "some"),
    [
        (
            "celebamask-hq",
            19,
            {1: "skin", 2: "nose", 3: "glasses", 6: "brow", 8: "ear", 12: "lips", 13: "hair", 17: "neck"},
        ),
        ("bisenet", 19, {1: "skin", 2: "brow", 4: "eye", 6: "glasses", 7: "ear", 10: "nose", 13: "lips", 17: "hair"}),
        ("lapa", 11, {1: "skin", 2: "brow", 4: "eye", 6: "nose", 7: "lips", 8: "mouth", 9: "lips", 10: "hair"}),
        ("farl", 19, {1: "neck", 2: "skin", 4: "ear", 6: "brow", 10: "nose", 11: "mouth", 14: "hair"}),
        ("farl-lapa", 11, {1: "skin", 6: "nose", 7: "lips", 9: "lips"}),
    ],
)
def test_parsers_are_known_by_name(parser: str, count: int, some: dict[int, str]) -> None:
    names = name_table(parser)
    assert set(names) == set(range(1, count))
    assert {number: names[number] for number in some} == some
    ids = np.arange(count, dtype=np.uint8).reshape(1, -1)
    ours = our_labels(Path("a.png"), ids, names)
    assert ours[0, 0] == 0 and (ours[0, 1:] > 0).all()
    for number, name in some.items():
        assert ours[0, number] == LABELS[name]


def test_our_own_ids_stay(tmp_path: Path) -> None:
    ids = np.arange(len(PARSERS["unshade"]), dtype=np.uint8)[None]
    np.testing.assert_array_equal(our_labels(tmp_path, ids, name_table("unshade")), ids)


def test_other_parsers_are_a_file(tmp_path: Path) -> None:
    table = tmp_path / "names.json"
    table.write_text(json.dumps({"0": "background", "3": "Skin", "9": "beard"}))
    ours = our_labels(tmp_path / "a.png", np.array([[0, 3, 9]], np.uint16), name_table(str(table)))
    assert ours.tolist() == [[0, LABELS["skin"], LABELS["other"]]]
    with pytest.raises(CaptureError, match=r"a.png: has the id 4, which the table of names lacks"):
        our_labels(tmp_path / "a.png", np.array([[4]], np.uint8), name_table(str(table)))
    for text in ("[]", "{", '{"skin": 1}', '{"0": "none"}', '{"-3": "skin"}'):
        table.write_text(text)
        with pytest.raises(CaptureError, match="names.json") as refusal:
            name_table(str(table))
        assert "\n" not in str(refusal.value)
    with pytest.raises(CaptureError, match="is neither a face parser nor a file; known by name are celebamask-hq"):
        name_table("mediapipe")

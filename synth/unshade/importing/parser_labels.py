"""Label pictures of face parsers: the meaning of their ids, and our ids."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import CaptureError

LABELS = {
    "skin": 1, "lips": 2, "brow": 3, "eyelid": 4, "ear": 5, "nose": 6, "scalp": 7,
    "hair": 8, "eye": 9, "mouth": 10, "neck": 11, "cloth": 12, "glasses": 13, "other": 14,
}  # fmt: skip
"""Our ids; the first seven are those of synthetic captures."""

_CELEBAMASK = (
    "", "skin", "nose", "glasses", "eye", "eye", "brow", "brow", "ear", "ear", "mouth", "lips", "lips", "hair", "other",
    "other", "other", "neck", "cloth",
)  # fmt: skip
"""The order of CelebAMask-HQ's attributes: skin, nose, eye_g, l_eye, r_eye, l_brow, r_brow, l_ear, r_ear, mouth,
u_lip, l_lip, hair, hat, ear_r, neck_l, neck, cloth."""

_BISENET = (
    "", "skin", "brow", "brow", "eye", "eye", "glasses", "ear", "ear", "other", "nose", "mouth", "lips", "lips", "neck",
    "other", "cloth", "hair", "other",
)  # fmt: skip
"""face-parsing.PyTorch, trained on CelebAMask-HQ in another order: skin, brows, eyes, eye_g, ears, ear_r, nose, mouth,
u_lip, l_lip, neck, neck_l, cloth, hair, hat."""

_LAPA = ("", "skin", "brow", "brow", "eye", "eye", "nose", "lips", "mouth", "lips", "hair")
"""LaPa: skin, brows, eyes, nose, upper lip, inner mouth, lower lip, hair."""

_FARL = (
    "", "neck", "skin", "cloth", "ear", "ear", "brow", "brow", "eye", "eye", "nose", "mouth", "lips", "lips", "hair",
    "glasses", "other", "other", "other",
)  # fmt: skip
"""FaRL's parser of 19 classes (CelebAMask): neck, face, cloth, ears, brows, eyes, nose, inner mouth, lips, hair,
glasses, hat, earring, necklace."""

_FARL_LAPA = ("", "skin", "brow", "brow", "eye", "eye", "nose", "lips", "mouth", "lips", "hair")
"""FaRL's parser of 11 classes (LaPa)."""

_OURS = ("", *LABELS)

PARSERS: dict[str, tuple[str, ...]] = {
    "celebamask-hq": _CELEBAMASK,
    "bisenet": _BISENET,
    "lapa": _LAPA,
    "farl": _FARL,
    "farl-lapa": _FARL_LAPA,
    "unshade": _OURS,
}
"""Our names for the ids 0, 1, ... of each parser; empty is none."""


def name_table(parser: str) -> dict[int, str]:
    """Names by id of a parser that is known by name, or of a JSON file ``{"1": "skin", ...}``.

    Names that are not ours are ``other``. Raises `CaptureError`.
    """
    if parser in PARSERS:
        return {number: name for number, name in enumerate(PARSERS[parser]) if name}
    path = Path(parser)
    known = f"known by name are {', '.join(PARSERS)}"
    if not path.is_file():
        raise CaptureError(
            f"labels: {parser!r} is neither a face parser nor a file; {known}, others are a JSON file of names by id"
        )
    try:
        table: Any = json.loads(path.read_bytes().decode("utf-8-sig"))
        names = {int(number): str(name).lower() for number, name in table.items() if int(number)}
    except (OSError, ValueError, AttributeError, RecursionError) as error:
        raise CaptureError(f'{path}: is not a table of names by id, as {{"1": "skin"}}: {error}; {known}') from error
    if not names or min(names) < 0:
        raise CaptureError(f'{path}: names no id above 0; write {{"1": "skin"}}')
    return {number: name if name in LABELS else "other" for number, name in names.items()}


def our_labels(path: Path, ids: NDArray[Any], names: dict[int, str]) -> NDArray[np.uint8]:
    """A parser's picture [H, W] in our ids; background and ids without a name are 0. Raises `CaptureError`."""
    present = np.unique(ids)
    strange = [int(number) for number in present if number and int(number) not in names]
    if strange:
        raise CaptureError(
            f"{path}: has the id {strange[0]}, which the table of names lacks; name the parser that made it"
        )
    table = np.zeros(int(present[-1]) + 1, np.uint8)
    for number, name in names.items():
        if number < len(table):
            table[number] = LABELS[name]
    return np.asarray(table[ids], np.uint8)

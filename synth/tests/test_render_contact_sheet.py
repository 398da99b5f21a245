"""The contact sheet: evenly mixed, reproducible, whole or not there."""

import numpy as np
import pytest
from PIL import Image

from unshade.errors import SceneError, StorageError
from unshade.face.spec import FITZPATRICK
from unshade.render import contact_sheet
from unshade.scene_file import LIGHT_KINDS


@pytest.fixture
def small(monkeypatch):
    # One light, hence one kernel to compile.
    for name, value in {"SIDE": 32, "_SAMPLES": 4, "_TEXTURE": 64, "LIGHTS": {"flash": 1.5}}.items():
        monkeypatch.setattr(contact_sheet, name, value)


def test_types_ages_and_lights_are_evenly_mixed():
    chosen = contact_sheet.sampled_faces(24, 0)
    met = {(sitter.spec.fitzpatrick, sitter.light) for sitter in chosen}
    assert len(met) == 24 == len(FITZPATRICK) * len(contact_sheet.LIGHTS)
    assert set(contact_sheet.LIGHTS) <= set(LIGHT_KINDS)
    years = sorted(sitter.spec.years for sitter in chosen)
    np.testing.assert_allclose(np.diff(years), 50 / 24)
    assert len({sitter.spec.seed for sitter in chosen}) == 24
    assert contact_sheet.sampled_faces(24, 0) == chosen != contact_sheet.sampled_faces(24, 1)


@pytest.mark.parametrize(("count", "columns"), [(1, 1), (24, 6), (12, 4), (7, 4)])
def test_the_grid_is_wide_and_wastes_little(count, columns):
    assert contact_sheet._columns(count) == columns


def test_a_sheet_holds_its_faces_and_is_the_same_again(small, tmp_path):
    steps, out = [], tmp_path / "new" / "sheet.png"
    contact_sheet.contact_sheet(2, out, 4, lambda done, total, what: steps.append((done, total)))
    assert steps == [(0, 2), (1, 2), (2, 2)]
    assert [file.name for file in out.parent.iterdir()] == ["sheet.png"]
    picture = np.asarray(Image.open(out))
    tiles = [picture[4:36, x : x + 32] for x in (4, 40)]
    np.testing.assert_array_equal(tiles[0], contact_sheet._portrait(contact_sheet.sampled_faces(2, 4)[0]))
    for tile in (tile.astype(float) for tile in tiles):
        # Skin in the middle, the same backdrop in both upper corners.
        assert tile[12:24, 12:24].std() > 5 and np.abs(tile[0, 0] - tile[0, -1]).max() <= 1
    assert np.abs(tiles[0].astype(float) - tiles[1]).mean() > 3
    assert (picture[40:68, 4:36] > 150).any(), "a caption stands under the picture"


def test_faults_are_named(small, tmp_path, monkeypatch):
    monkeypatch.setattr(contact_sheet, "_portrait", lambda sitter: np.zeros((32, 32, 3), np.uint8))
    with pytest.raises(SceneError, match="ask for 1 or more"):
        contact_sheet.contact_sheet(0, tmp_path / "x.png")
    (tmp_path / "file").write_text("")
    with pytest.raises(StorageError, match="cannot be written"):
        contact_sheet.contact_sheet(1, tmp_path / "file" / "x.png")


def test_tones_are_srgb_with_soft_highlights():
    middle = contact_sheet.srgb(np.array([0.0, 0.18, 0.5]))
    np.testing.assert_array_equal(middle, [0, 118, 188])
    bright = contact_sheet.srgb(np.array([0.7, 1.0, 3.0, 100.0]))
    assert (np.diff(bright.astype(int)) >= 0).all() and bright[1] < 255 and bright[-1] == 255

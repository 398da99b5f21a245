"""Labels as an imperfect face parser gives them, against counts made pixel by pixel."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import render_toy

from unshade.errors import SceneError
from unshade.face import Label
from unshade.formation import stated_labels
from unshade.render.rigs import cameras
from unshade.scene_file import LabelFaults, Scene, parse_scene

SIZE = 120


def scene(**labels) -> Scene:
    return parse_scene(render_toy.toy_table() | {"labels": labels}, "toy", Path())


def camera(number=0):
    return cameras(scene().rig, SIZE, SIZE)[number]


def regions() -> np.ndarray:
    """Discs and half planes of four labels, and a background."""
    y, x = np.mgrid[:SIZE, :SIZE]
    labels = np.where(x + 0.3 * y < 80, 1, 2)
    labels[(x - 30) ** 2 + (y - 40) ** 2 < 15**2] = 3
    labels[(x - 75) ** 2 + (y - 75) ** 2 < 22**2] = 7
    labels[(x - 60) ** 2 + (y - 60) ** 2 > 58**2] = 0
    return labels.astype(np.uint8)


def neighbours(labels, y, x):
    """Labels other than the pixel's own and the background, of its four neighbours."""
    at = [(y - 1, x), (y, x - 1), (y, x + 1), (y + 1, x)]
    values = [labels[p] for p in at if 0 <= p[0] < SIZE and 0 <= p[1] < SIZE]
    return [v for v in values if v not in (0, labels[y, x])]


def boundary(labels):
    return {(y, x) for y, x in np.argwhere(labels > 0) if neighbours(labels, y, x)}


@pytest.mark.parametrize("fraction", [0.1, 0.5, 1.0])
def test_the_share_of_boundary_pixels_is_exact_and_nothing_else_changes(fraction):
    perfect = regions()
    stated = stated_labels(perfect, camera(), scene(boundary_error=fraction))
    edge = boundary(perfect)
    wrong = {tuple(p) for p in np.argwhere(stated != perfect)}
    assert len(edge) > 300 and len(wrong) == round(fraction * len(edge)) and wrong <= edge
    for y, x in wrong:
        around = neighbours(perfect, y, x)
        majority = max(around.count(v) for v in around)
        assert stated[y, x] == min(v for v in around if around.count(v) == majority)
    assert stated.dtype == np.uint8


def test_mistakes_come_in_runs_on_one_side():
    perfect = np.where(np.arange(SIZE)[None] < SIZE // 2, 1, 2).repeat(SIZE, 0).astype(np.uint8)
    lengths, opposite, count = [], 0, 0
    for seed in range(40):
        table = render_toy.toy_table(seed=seed) | {"labels": {"boundary_error": 0.1}}
        wrong = stated_labels(perfect, camera(), parse_scene(table, "toy", Path())) != perfect
        left, right = wrong[:, SIZE // 2 - 1], wrong[:, SIZE // 2]
        opposite += int((left & right).sum())
        for side in (left, right):
            starts = np.flatnonzero(np.diff(np.r_[0, side.astype(int)]) == 1)
            lengths += [int(side.sum()) / len(starts)] * len(starts) if len(starts) else []
            count += int(side.sum())
    # Rice's formula says four; white noise would have runs of 1.1.
    assert 3 < np.mean(lengths) < 6 and opposite < 0.15 * count


def test_equal_seeds_and_names_give_equal_labels():
    perfect, faulty = regions(), scene(boundary_error=0.2)
    first = stated_labels(perfect, camera(), faulty)
    np.testing.assert_array_equal(first, stated_labels(perfect, camera(), faulty))
    assert (first != stated_labels(perfect, camera(1), faulty)).any()
    reseeded = replace(faulty, render=replace(faulty.render, seed=9))
    assert (first != stated_labels(perfect, camera(), reseeded)).any()


def test_withheld_views_and_labels_without_a_boundary_stay():
    perfect, faulty = regions(), scene(boundary_error=1.0)
    withheld = next(one for one in cameras(faulty.rig, SIZE, SIZE) if not one.train)
    assert stated_labels(perfect, withheld, faulty) is perfect
    plain = np.where(perfect > 0, 1, 0).astype(np.uint8)
    np.testing.assert_array_equal(stated_labels(plain, camera(), faulty), plain)
    assert not stated_labels(np.zeros((4, 5), np.uint8), camera(), faulty).any()
    assert stated_labels(perfect, camera(), scene()) is perfect
    assert stated_labels(perfect, camera(), scene(omit=True)) is None


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ({"boundary_error": 1.5}, "boundary_error .* is 1.5; use a number from 0 to 1"),
        ({"boundary_eror": 0.1}, "did you mean 'boundary_error'"),
        ({"omit": 1}, "omit .* is 1; use true or false"),
        ({"omit": True, "boundary_error": 0.1}, "does nothing where omit = true"),
    ],
)
def test_contradictory_tables_are_refused(table, message):
    with pytest.raises(SceneError, match=message):
        scene(**table)


def test_the_table_survives_writing_and_reading():
    import tomllib

    from unshade.render.scene_text import scene_text

    for table in ({"boundary_error": 0.1}, {"omit": True}, {"hair_is_skin": True}):
        full = scene(**table)
        assert full.labels == LabelFaults(**table)
        assert parse_scene(tomllib.loads(scene_text(full)), "again", Path()) == full
    assert "labels" not in scene_text(scene())


def test_one_label_covers_all_that_has_any_in_training_views_alone():
    perfect = regions()
    views = cameras(scene().rig, SIZE, SIZE)
    training, withheld = views[0], views[-1]
    np.testing.assert_array_equal(stated_labels(perfect, training, scene(one=True)), perfect > 0)
    assert not withheld.train
    np.testing.assert_array_equal(stated_labels(perfect, withheld, scene(one=True)), perfect)
    for other in ({"omit": True}, {"boundary_error": 0.2}, {"hair_is_skin": True}):
        with pytest.raises(SceneError, match="one = true in .* keep one of them"):
            scene(one=True, **other)


def test_hair_is_called_skin_in_training_views_alone_and_its_edge_is_none():
    perfect = np.where(np.arange(SIZE)[None] < SIZE // 2, Label.SKIN, Label.SCALP).repeat(SIZE, 0).astype(np.uint8)
    perfect[:4] = Label.BROW
    views = cameras(scene().rig, SIZE, SIZE)
    stated = stated_labels(perfect, views[0], scene(hair_is_skin=True))
    assert set(np.unique(stated)) == {Label.SKIN, Label.BROW} and (stated[:4] == Label.BROW).all()
    np.testing.assert_array_equal(stated_labels(perfect, views[-1], scene(hair_is_skin=True)), perfect)
    mistaken = stated_labels(perfect, views[0], scene(hair_is_skin=True, boundary_error=1.0))
    assert np.argwhere(mistaken != stated)[:, 0].max() < 6
    with pytest.raises(SceneError, match="omit = true in .* leaves nothing to hair_is_skin"):
        scene(hair_is_skin=True, omit=True)

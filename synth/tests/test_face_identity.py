"""Sampled identities: reproducible, spread over people, no two alike."""

import numpy as np
import pytest

from unshade.face import FaceSpec, cache, identity
from unshade.face.spec import FITZPATRICK

COUNT = 200
SPECS = [FaceSpec.sample(seed) for seed in range(COUNT)]


@pytest.fixture(scope="module")
def fronts():
    """Base vertices of 200 faces' fronts, (200, N, 3) in millimetres."""
    head = cache.load_head()
    own = head.chart_vertices[head.chart_vertices < len(head.base)]
    front = own[head.template[own, 2] > -20]
    return np.stack([1000 * identity.shape(head, spec)[front] for spec in SPECS])


def aligned(points, onto):
    """`points` after the rigid motion that brings them nearest to `onto` (Kabsch)."""
    centre, goal = points.mean(axis=0), onto.mean(axis=0)
    u, _, vt = np.linalg.svd((points - centre).T @ (onto - goal))
    return (points - centre) @ (u @ np.diag([1, 1, np.linalg.det(u @ vt)]) @ vt) + goal


def test_no_two_of_200_faces_are_nearer_than_a_millimetre_and_a_half(fronts):
    """Mean distance of corresponding points of the front of the face, after the best rigid alignment."""
    mean = fronts.mean(axis=0)
    posed = np.stack([aligned(front, mean) for front in fronts]).astype(np.float32)
    near = np.full((COUNT, COUNT), np.inf)
    for i in range(COUNT - 1):
        offset = posed[i + 1 :] - posed[i]
        near[i, i + 1 :] = np.sqrt(np.einsum("nvk,nvk->nv", offset, offset)).mean(axis=1)
    # Aligned to the mean is not yet aligned to each other: do that for the pairs that could be nearest.
    for pair in np.argsort(near, axis=None)[:40]:
        a, b = np.unravel_index(pair, near.shape)
        near[a, b] = np.linalg.norm(aligned(fronts[a], fronts[b]) - fronts[b], axis=1).mean()
    assert near.min() > 1.5
    # The faces differ, but none is a monster.
    assert np.abs(posed - mean).max() < 30


def test_samples_are_spread_and_skin_is_independent_of_shape():
    types = np.array([FITZPATRICK.index(spec.fitzpatrick) for spec in SPECS])
    assert np.bincount(types, minlength=6).min() > 15
    years = np.array([spec.years for spec in SPECS])
    assert years.min() < 25 and years.max() > 60
    for component in range(3):
        shape = [spec.ethnicity[component] for spec in SPECS]
        # Three standard errors of a correlation of 0.
        assert abs(np.corrcoef(types, shape)[0, 1]) < 3 / np.sqrt(COUNT)


def test_sampling_is_a_table_with_nothing_but_a_seed():
    assert FaceSpec.sample(9) == FaceSpec.from_table({"name": "face0009", "seed": 9})
    assert FaceSpec.sample(9, age=0.5).gender == FaceSpec.sample(9).gender


@pytest.mark.parametrize(("age", "years"), [(0.0, 20.0), (0.5, 45.0), (1.0, 70.0)])
def test_age_runs_from_20_to_70_years(age, years):
    assert FaceSpec.sample(1, age=age).years == years

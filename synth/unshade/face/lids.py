"""The eyelids: their visible margin, where the skin meets the eyeball, and how they slide over it."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components, depth_first_order
from scipy.spatial import cKDTree

from .eyeball import clearance

_FOLD = 0.002
"""Skin nearer (m) than this to the margin is the lid's edge, not its fold."""


def margin_distance(positions: np.ndarray, triangles: np.ndarray, eyes: np.ndarray) -> np.ndarray:
    """Distance (C,) in metres from chart vertices (C,3) to the lid margins of both eyes (2,4)."""
    curves = []
    for eye in eyes:
        gap = np.linalg.norm(positions - eye[:3], axis=1) - eye[3]
        crossing, fraction, _ = margin(triangles, gap)
        curves.append(between(positions, crossing, fraction))
    return cKDTree(np.concatenate(curves)).query(positions)[0]


def margin(triangles: np.ndarray, gap: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The margin of one eye's lids: edges (K,2) that cross it, the fractions (K,) of the way where, and the hidden rim (C,) bool.

    `gap` (C,) is the distance of the chart's vertices from the eyeball's surface. The chart
    runs on under the lids, into the eyeball: the margin is the curve in which the rim of
    each eye hole's submerged skin crosses the surface. Skin that dips into the eyeball
    elsewhere (a deep fold) is not a margin.
    """
    edges = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    under = gap < 0
    wet = edges[under[edges].all(axis=1)]
    graph = sp.coo_matrix((np.ones(len(wet)), wet.T), shape=(len(gap),) * 2)
    group = connected_components(graph, directed=False)[1]
    hidden = under & (group == np.bincount(group[under]).argmax())
    crossing = edges[hidden[edges].sum(axis=1) == 1]
    return crossing, gap[crossing[:, 0]] / (gap[crossing[:, 0]] - gap[crossing[:, 1]]), hidden


def margin_sides(
    triangles: np.ndarray, crossing: np.ndarray, hidden: np.ndarray, edge: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Upper and lower lid's share of a margin: indices into its `crossing` edges (K,2) and points `edge` (K,3).

    The margin is one curve round the opening, split in the corners of the eye.
    Following it tells the lids apart even where they nearly touch.
    """
    names, number = np.unique(np.sort(crossing, axis=1), axis=0, return_inverse=True)
    first = np.unique(number.ravel(), return_index=True)[1]
    cut = triangles[np.isin(hidden[triangles].sum(axis=1), (1, 2))]
    sides = np.sort(cut[:, [[0, 1], [1, 2], [2, 0]]], axis=2)
    step = sides[hidden[sides].sum(axis=2) == 1].reshape(-1, 2, 2)
    key = {tuple(name): i for i, name in enumerate(names)}
    links = np.array([[key[tuple(a)], key[tuple(b)]] for a, b in step])
    graph = sp.coo_matrix((np.ones(len(links)), links.T), shape=(len(names),) * 2).tocsr()
    group = connected_components(graph, directed=False)[1]
    own = np.flatnonzero(group == np.bincount(group).argmax())
    # The hidden rim may come to an end in a corner of the eye: follow such a curve from there.
    ends = own[np.bincount(links.ravel(), minlength=len(names))[own] == 1]
    start = ends[0] if len(ends) else own[edge[first[own], 0].argmin()]
    loop = depth_first_order(graph, start, directed=False, return_predecessors=False)
    points = edge[first[loop]]
    turn = np.abs(points[:, 0] - points[0, 0]).argmax()
    one, other = first[loop[: turn + 1]], first[loop[turn:]]
    return (one, other) if edge[one, 1].mean() > edge[other, 1].mean() else (other, one)


def between(values: np.ndarray, crossing: np.ndarray, fraction: np.ndarray) -> np.ndarray:
    """Values (C,...) of vertices at the points `fraction` (K,) of the way along edges (K,2)."""
    fraction = fraction.reshape(-1, *[1] * (values.ndim - 1))
    return values[crossing[:, 0]] * (1 - fraction) + values[crossing[:, 1]] * fraction


def sunken_fold(positions: np.ndarray, triangles: np.ndarray, eye: np.ndarray, gaze: np.ndarray) -> np.ndarray:
    """Places (K,3) where a lid's fold dips into the eyeball, or nearly: its own skin, not the hidden rim."""
    gap = clearance(positions, eye, gaze)
    crossing, fraction, hidden = margin(triangles, gap)
    skin = np.unique(triangles)
    skin = skin[(gap[skin] < 0.0002) & ~hidden[skin]]
    if not len(skin):
        return positions[skin]
    return positions[skin[cKDTree(between(positions, crossing, fraction)).query(positions[skin])[0] > _FOLD]]

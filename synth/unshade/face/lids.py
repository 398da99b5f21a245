"""The visible margin of the eyelids: where the skin meets the eyeball."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree


def margin_distance(positions: np.ndarray, triangles: np.ndarray, eyes: np.ndarray) -> np.ndarray:
    """Distance (C,) in metres from chart vertices (C,3) to the lid margins of both eyes (2,4).

    The chart runs on under the lids, into the eyeball: the margin is the curve in which
    the rim of each eye hole's submerged skin crosses the sphere. Skin that dips into the
    sphere elsewhere (a deep fold) is no margin.
    """
    edges = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    curves = []
    for eye in eyes:
        gap = np.linalg.norm(positions - eye[:3], axis=1) - eye[3]
        under = gap < 0
        wet = edges[under[edges].all(axis=1)]
        graph = sp.coo_matrix((np.ones(len(wet)), wet.T), shape=(len(gap),) * 2)
        group = connected_components(graph, directed=False)[1]
        hidden = under & (group == np.bincount(group[under]).argmax())
        crossing = edges[hidden[edges].sum(axis=1) == 1]
        share = gap[crossing[:, 0]] / (gap[crossing[:, 0]] - gap[crossing[:, 1]])
        curves.append(positions[crossing[:, 0]] * (1 - share[:, None]) + positions[crossing[:, 1]] * share[:, None])
    return cKDTree(np.concatenate(curves)).query(positions)[0]

"""Where the nodes of a glTF file place what they hold."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from .gltf_accessor import item


def local_transform(node: dict[str, Any]) -> np.ndarray:
    """The transform [4, 4] of a node against the one above it."""
    matrix = np.eye(4)
    if "matrix" in node:
        matrix = np.array(node["matrix"], np.float64).reshape(4, 4).T
    if "translation" in node:
        moved = np.eye(4)
        moved[:3, 3] = node["translation"]
        matrix = matrix @ moved
    if "rotation" in node:
        rotated = np.eye(4)
        rotated[:3, :3] = Rotation.from_quat(node["rotation"]).as_matrix()
        matrix = matrix @ rotated
    if "scale" in node:
        matrix = matrix @ np.diag([*node["scale"], 1.0])
    return matrix


class Worlds:
    """Transforms [4, 4] of all nodes to the scene, whether it shows them or not."""

    def __init__(self, document: dict[str, Any]) -> None:
        self._document = document
        self._known: dict[int, np.ndarray] = {}
        self._above: dict[int, int] = {}
        for number, node in enumerate(document.get("nodes", [])):
            for child in node.get("children", []):
                if self._above.setdefault(child, number) != number:
                    raise ValueError(f"node {child} stands below two nodes")

    def of(self, number: int) -> np.ndarray:
        """The transform of a node."""
        way = []
        at: int | None = number
        while at is not None and at not in self._known:
            if at in way:
                raise ValueError(f"node {at} stands below itself")
            way.append(at)
            at = self._above.get(at)
        world = np.eye(4) if at is None else self._known[at]
        for step in reversed(way):
            world = world @ local_transform(item(self._document, "nodes", step))
            self._known[step] = world
        return world

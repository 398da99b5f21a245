"""Skinned meshes of a glTF file, in the pose in which its joints stand."""

from __future__ import annotations

from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from ..face.spec import FaceError
from .gltf_accessor import Accessors, item
from .gltf_node import Worlds

_Shape = TypeVar("_Shape", bound=Any)


class Skins:
    """The skins of a document (glTF 2.0 specification, 3.7.3.3)."""

    def __init__(self, document: dict[str, Any], accessors: Accessors) -> None:
        self._document, self._accessors = document, accessors
        self._worlds: Worlds | None = None

    def posed(self, path: Path, name: str, number: int, primitive: dict[str, Any], shape: _Shape) -> _Shape:
        """A shape under its joints' transforms times their inverse bind matrices, weighted at every vertex; the
        place of the mesh's node does not matter. Raises `FaceError` for vertices that no joint holds."""
        matrices = self._joint_matrices(number)
        count = len(shape.vertices)
        blended, sums = np.zeros((count, 4, 4)), np.zeros(count)
        for joints, weights in self._influences(name, primitive["attributes"], count):
            if weights.any() and not 0 <= joints[weights != 0].min() <= joints[weights != 0].max() < len(matrices):
                raise ValueError(f"object {name!r} is held by a joint that its skin lacks")
            blended += weights[:, None, None] * matrices[joints.clip(0, len(matrices) - 1)]
            sums += weights
        if not (sums > 0).all():
            loose = int((~(sums > 0)).sum())
            raise FaceError(
                f"{path}: no joint holds {loose} of {count} vertices of {name!r}; apply the pose and export without armature"
            )
        blended /= sums[:, None, None]
        linear = blended[:, :3, :3]
        vertices = np.einsum("vij,vj->vi", linear, shape.vertices) + blended[:, :3, 3]
        a, b, c = np.moveaxis(linear, 2, 0)
        cofactors = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], 2)
        turned = np.sign((cofactors[:, :, 0] * a).sum(1))
        normals = shape.normals
        if normals is not None:
            normals = turned[:, None] * np.einsum("vij,vj->vi", cofactors, normals)
        triangles = shape.triangles[:, ::-1] if turned.sum() < 0 else shape.triangles
        return shape._replace(vertices=vertices, normals=normals, triangles=triangles)

    def _joint_matrices(self, number: int) -> np.ndarray:
        """From the mesh to the scene for every joint, [J, 4, 4]."""
        skin = item(self._document, "skins", number)
        joints = skin["joints"]
        inverse = np.broadcast_to(np.eye(4), (len(joints), 4, 4))
        if "inverseBindMatrices" in skin:
            columns = self._accessors.read(skin["inverseBindMatrices"], 16).astype(np.float64)
            inverse = columns.reshape(-1, 4, 4).transpose(0, 2, 1)
        if not joints or len(inverse) < len(joints):
            raise ValueError(f"skins[{number}] has {len(joints)} joints and {len(inverse)} inverse bind matrices")
        if self._worlds is None:
            self._worlds = Worlds(self._document)
        return np.stack([self._worlds.of(joint) @ matrix for joint, matrix in zip(joints, inverse)])

    def _influences(self, name: str, attributes: dict[str, int], count: int) -> Any:
        """Joints (V,) and weights (V,), one after the other."""
        if "JOINTS_0" not in attributes or "WEIGHTS_0" not in attributes:
            raise ValueError(f"object {name!r} has a skin, but no JOINTS_0 and WEIGHTS_0")
        four = 0
        while f"JOINTS_{four}" in attributes:
            joints = self._accessors.read(attributes[f"JOINTS_{four}"], 4).astype(np.int64)
            weights = self._accessors.read(attributes[f"WEIGHTS_{four}"], 4).astype(np.float64)
            if len(joints) != count or len(weights) != count:
                raise ValueError(f"object {name!r} has {count} vertices, but {len(joints)} joints")
            yield from zip(joints.T, weights.T)
            four += 1

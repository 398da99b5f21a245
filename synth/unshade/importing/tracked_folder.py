"""A tracked face: meshes of the frames of a video, as VHAP exports them (``--flame-mode mesh``).

``transforms.json`` has a ``mesh_path`` for every frame besides its camera: an OBJ of the face as it was in that frame, all
with the same vertices. The head moves and the camera stands, so the rigid motion of the meshes is that of the head. It is
undone: cameras move around one neutral mesh, the mean of all, and the light stands still with respect to the camera.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import CaptureError
from .chart_mesh import ChartMesh
from .source import Matrix, Source, SourceView
from .transforms_file import picture_file, read_document, read_transforms, transforms_files

Points = NDArray[np.float64]

EXPRESSION_MM = 3.0
"""Distance (95th percentile of the vertices) to the neutral face from which a frame is left out."""

_STILL_DEGREES, _STILL_SHARE = 0.5, 0.01
"""Turn, and share of its distance, by which a camera may move between frames and still stand."""

_ROUNDS = 20


def read_tracked(path: Path, pictures: Path | None = None) -> Source:
    """Reads the export's folder or its ``transforms.json``. Raises `CaptureError`.

    Lengths are metres, as FLAME's are. Masks of the export (``fg_mask_path``) hold hair and shoulders, and are not read.
    """
    source, meshes = read_transforms(path), _mesh_paths(path)
    views = [view for view in source.views if view.picture in meshes]
    if len(views) < len(source.views):
        missing = next(view for view in source.views if view.picture not in meshes)
        raise CaptureError(f"{source.origin}: {missing.stated} has no mesh_path; export the meshes of all frames")
    files = list(dict.fromkeys(meshes[view.picture] for view in views))
    read = [_read_vertices(file) for file in files]
    for file, points in zip(files, read):
        if len(points) != len(read[0]):
            raise CaptureError(
                f"{file}: has {len(points)} vertices, but {files[0].name} {len(read[0])}; export the meshes of one tracking"
            )
    shapes = np.stack(read)
    neutral, poses, distances = neutral_face(shapes)
    moved = {file: (pose, 1000 * far) for file, pose, far in zip(files, poses, distances)}
    left_out = [(view.name, f"expression: further than {EXPRESSION_MM:g} mm from the neutral face")
                for view in views if moved[meshes[view.picture]][1] > EXPRESSION_MM]  # fmt: skip
    gone = {name for name, _ in left_out}
    kept = [view for view in views if view.name not in gone]
    if len(kept) < 3:
        far = sorted(1000 * distances)
        raise CaptureError(
            f"{source.origin}: the expression changes: the meshes are {far[0]:.1f} to {far[-1]:.1f} mm from their mean "
            f"(95th percentile of a frame), and {len(kept)} frames lie within {EXPRESSION_MM:g}; track a still expression"
        )
    stands = _stand([view.camera_to_world for view in kept])
    turns = [pose for pose, _ in (moved[meshes[view.picture]] for view in kept)]
    if not stands and not _stand(turns, about=neutral.mean(0)):
        raise CaptureError(
            f"{source.origin}: head and cameras both move, so the light stands still with neither; export the frames of "
            "one camera"
        )
    largest = max(moved[meshes[view.picture]][1] for view in kept)
    return replace(
        source,
        views=tuple(_around_head(view, moved[meshes[view.picture]][0]) for view in kept),
        mesh=files[0],
        withheld=tuple(name for name in source.withheld if name not in gone),
        metres=1.0,
        vertices=neutral,
        left_out=(*source.left_out, *left_out),
        light_frame="camera" if stands else "head",
        assumed=(
            *source.assumed,
            f"one neutral mesh, the mean of {len(files)}; those of the kept frames are up to {largest:.2f} mm away",
        ),
    )


def _around_head(view: SourceView, pose: Matrix) -> SourceView:
    return replace(view, camera_to_world=np.linalg.inv(pose) @ view.camera_to_world, mask=None)


def neutral_face(shapes: Points) -> tuple[Points, list[Matrix], Points]:
    """The neutral face (V, 3) of meshes (T, V, 3), the rigid pose (4, 4) from it to each, and each mesh's distance (T,)
    from it, the 95th percentile over the vertices.

    Generalised Procrustes analysis (Gower 1975) without scale; a vertex weighs by its inverse variance over the frames,
    so that the skull settles the pose, not mouth and brows.
    """
    weights = np.ones(shapes.shape[1])
    neutral = shapes[0]
    for _ in range(_ROUNDS):
        poses = [_rigid(neutral, shape, weights) for shape in shapes]
        back = np.stack([(shape - pose[:3, 3]) @ pose[:3, :3] for shape, pose in zip(shapes, poses)])
        neutral = np.median(back, axis=0)
        offset = np.linalg.norm(back - neutral, axis=2)
        variance = (offset**2).mean(0)
        weights = 1 / (variance + 0.1 * np.median(variance) + 1e-12)
    return neutral, poses, np.percentile(offset, 95, axis=1)


def _rigid(a: Points, b: Points, weights: Points) -> Matrix:
    """The rotation and translation (4, 4) from points ``a`` to ``b`` of weighted least squares (Kabsch 1976)."""
    weights = weights / weights.sum()
    middle_a, middle_b = weights @ a, weights @ b
    u, _, vt = np.linalg.svd((b - middle_b).T @ (weights[:, None] * (a - middle_a)))
    turn = (u * [1, 1, np.sign(np.linalg.det(u @ vt))]) @ vt
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = turn, middle_b - turn @ middle_a
    return pose


def _stand(matrices: list[Matrix], about: Points | None = None) -> bool:
    """Whether poses are one: their turns alike, and the places of the origin, or of the point ``about``."""
    turns = np.stack([matrix[:3, :3] for matrix in matrices])
    point = np.zeros(3) if about is None else about
    places = np.stack([matrix[:3, :3] @ point + matrix[:3, 3] for matrix in matrices])
    cosine = (np.einsum("nij,ij->n", turns, turns[0]) - 1) / 2
    distance = np.linalg.norm(places - places[0], axis=1)
    reach = max(float(np.linalg.norm(places[0])), 0.1)
    turned = np.degrees(np.arccos(cosine.clip(-1, 1)))
    return bool(turned.max() < _STILL_DEGREES and distance.max() < _STILL_SHARE * reach)


def _mesh_paths(path: Path) -> dict[Path, Path]:
    """The OBJ of each picture. Raises `CaptureError`."""
    found: dict[Path, Path] = {}
    for file in transforms_files(path):
        frames: list[dict[str, Any]] = [
            frame for frame in read_document(file).get("frames", []) if isinstance(frame, dict)
        ]
        for frame in frames:
            mesh, picture = frame.get("mesh_path"), frame.get("file_path")
            if isinstance(mesh, str) and isinstance(picture, str):
                found[picture_file(file, picture)] = file.parent / mesh.replace("\\", "/")
        if not found:
            has = (
                "only FLAME's parameters (flame_param_path)"
                if any("flame_param_path" in f for f in frames)
                else "no mesh_path"
            )
            raise CaptureError(f"{file}: its frames have {has}; export their meshes (VHAP: --flame-mode mesh)")
    return found


def _read_vertices(file: Path) -> Points:
    """The vertices (V, 3) of an OBJ, in the order of its lines. Raises `CaptureError`."""
    try:
        lines = file.read_text(encoding="utf-8").splitlines()
        points = np.array([line.split()[1:4] for line in lines if line.startswith("v ")], float)
    except (OSError, ValueError) as error:
        raise CaptureError(f"{file}: cannot be read as an OBJ: {error}; export the meshes again") from error
    if points.ndim != 2 or points.shape[1] != 3 or not np.isfinite(points).all():
        raise CaptureError(f"{file}: has no vertices of three finite numbers each; export the meshes again")
    return points


def with_vertices(mesh: ChartMesh, file: Path, vertices: Points) -> ChartMesh:
    """The mesh of ``file`` with other positions of its vertices (V, 3), in the order of the file's lines.

    Raises `CaptureError` if the file has another number of vertices, or two in one place.
    """
    lines = _read_vertices(file)
    if len(lines) != len(vertices):
        raise CaptureError(
            f"{file}: has {len(lines)} vertices, but the tracked meshes {len(vertices)}; name their template"
        )
    row = {tuple(point): number for number, point in enumerate(lines.tolist())}
    rows = [row.get(tuple(point), -1) for point in mesh.vertices.tolist()]
    if len(row) < len(lines) or -1 in rows:
        raise CaptureError(f"{file}: has several vertices in one place; name a mesh without")
    return replace(mesh, vertices=vertices[rows], normals=None, verbatim=None)

"""The convention detective: does the mesh project onto the masks, and if not, after which one change does it?

It compares silhouettes of the mesh with the masks, in views spread over all.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from statistics import median

import numpy as np
from numpy.typing import NDArray

from .changes import CENTRE, PLAIN, Change, distance_factor, focal_factor, half_pixels, shift, single_changes
from .chart_mesh import ChartMesh
from .lens import undistorted
from .orientation import oriented
from .pinhole import Pinhole
from .source import Lens, Matrix

SOUND = 0.9
"""Median intersection over union of a capture that fits."""

FITTING = 0.6
"""Intersection over union below which cameras do not fit a mesh."""

_NAMED = 0.75
"""Union that a single change must reach to be named."""

_GAIN = 0.1
"""Gain in union that it must bring."""

_MIN_VIEWS, _MAX_VIEWS = 3, 6
_MAX_TRIANGLES = 300_000
"""Drawn for one change."""

_ROUNDS = 6
"""In which a factor is fitted."""

_SIZE = 256
"""Longest side of the small pictures at which changes are tried."""

_MAX_FRACTION, _MIN_FRACTION = 0.98, 0.002
"""Fractions of a picture beyond which a mask is uninformative."""

_VIEWS_AGREE = 0.8
"""Share of views that must gain by half a pixel."""

_OF_OPPOSITE = 0.5
"""Share of what half a pixel the other way loses that half a pixel must gain."""


_SAME = 0.02
"""Difference of unions that does not distinguish one principal point from another."""


@dataclass(frozen=True)
class Evidence:
    """A view's camera, its mask (height, width) as the lens shows it, True where the face is, and that lens."""

    camera: Pinhole
    mask: NDArray[np.bool_]
    lens: Lens = field(default_factory=Lens)

    @property
    def is_telling(self) -> bool:
        """Whether the mask is neither empty nor the whole picture."""
        return bool(_MIN_FRACTION < self.mask.mean() < _MAX_FRACTION)

    def straight(self) -> Evidence:
        """The view without its lens, which is taken out about the camera's own principal point."""
        if self.lens.straight:
            return self
        plane = self.mask.astype(np.uint8)
        mask = undistorted(plane, self.lens, self.camera.focal, self.camera.centre, smooth=False) > 0
        return Evidence(self.camera, mask)


@dataclass(frozen=True)
class Verdict:
    """Result: intersection over union as it is, and with the change if one is named. ``nearest`` is the change that
    fits best where none is named, and its union."""

    views: int
    union: float
    change: Change | None = None
    union_after: float | None = None
    nearest: tuple[Change, float] | None = None

    @property
    def sound(self) -> bool:
        return self.change is None and self.union >= SOUND


def examine(mesh: ChartMesh, evidence: list[Evidence], elsewhere: tuple[str, str, Matrix] | None) -> Verdict | None:
    """Returns the verdict on cameras, mesh and masks; None where no mask is informative."""
    telling = [e for e in evidence if e.is_telling]
    if not telling:
        return None
    count = min(max(_MAX_TRIANGLES // len(mesh.triangles), _MIN_VIEWS), _MAX_VIEWS)
    chosen = [telling[i * len(telling) // count] for i in range(count)] if len(telling) > count else telling
    small = [_smaller(e) for e in chosen]
    before = _union(mesh, small, PLAIN)
    if before >= SOUND:
        return _finer(mesh, [e.straight() for e in chosen], before)
    width = chosen[0].camera.width
    changes = single_changes(elsewhere, chosen[0].camera, lens=not all(e.lens.straight for e in chosen))
    found = [(change, _union(mesh, small, change)) for change in changes]
    if max(union for _, union in found) < SOUND:
        # Nothing that has a name fits: factors are fitted.
        found += [(change, _union(mesh, small, change)) for change in _fitted(mesh, small, width)]
    best, union = _best(found)
    if union >= _NAMED and union >= before + _GAIN:
        return Verdict(len(chosen), before, best, union)
    return Verdict(len(chosen), before, nearest=(best, union) if union > before else None)


def overlap(mesh: ChartMesh, evidence: Evidence) -> float | None:
    """Intersection over union of silhouette and mask in a small picture of one view; None where the mask is uninformative."""
    return _union(mesh, [_smaller(evidence)], PLAIN) if evidence.is_telling else None


def _best(found: list[tuple[Change, float]]) -> tuple[Change, float]:
    """The change that fits best; of principal points that fit alike, the first."""
    best = max(found, key=lambda pair: pair[1])
    if best[0].id.startswith(CENTRE):
        alike = (pair for pair in found if pair[0].id.startswith(CENTRE) and pair[1] >= best[1] - _SAME)
        return next(alike)
    return best


def _fitted(mesh: ChartMesh, evidence: list[Evidence], width: int) -> list[Change]:
    """Focal lengths, and distances of the cameras, times what makes silhouettes as large as masks."""
    found: list[Change] = []
    for make, power, starts in (
        (focal_factor, 1.0, (1.0, width / 36, float(width))),
        (distance_factor, -1.0, (1.0, 0.01, 100.0)),
    ):
        for start in starts:
            factor = start
            for _ in range(_ROUNDS):
                growth = _growth(mesh, evidence, make(factor))
                if growth is None:
                    break
                factor = min(max(factor * growth**power, 1e-6), 1e6)
            else:
                found.append(make(factor))
    return found


def _growth(mesh: ChartMesh, evidence: list[Evidence], change: Change) -> float | None:
    """How much larger the masks are than the silhouettes, along an edge; None where no mesh is seen."""
    sizes = [(int(seen.sum()), int(mask.sum())) for seen, mask in (_silhouette(mesh, e, change) for e in evidence)]
    ratios = [(mask / seen) ** 0.5 for seen, mask in sizes if seen]
    return median(ratios) if ratios else None


def _finer(mesh: ChartMesh, evidence: list[Evidence], union: float) -> Verdict:
    """Whether half a pixel makes masks fit that fit already, but for their edges.

    Occluders of the mesh, and masks that are a little wide, make every shift equally wrong; a shift that
    is due gains about what its opposite loses, a shift twice as far gains nothing more, and one across neither.
    """
    before = [_wrong(mesh, e, PLAIN) for e in evidence]
    for change, half in zip(half_pixels(), (0.5, -0.5)):
        after = [_wrong(mesh, e, change) for e in evidence]
        gain = sum(before) - sum(after)
        if gain <= 0 or sum(a < b for a, b in zip(after, before)) < _VIEWS_AGREE * len(evidence):
            continue

        def losing(dx: float, dy: float) -> int:
            return sum(_wrong(mesh, e, shift(dx, dy)) for e in evidence) - sum(before)

        if gain < _OF_OPPOSITE * losing(-half, -half) or losing(2 * half, 2 * half) < -_OF_OPPOSITE * gain:
            continue
        if min(losing(half, -half), losing(-half, half)) > -_OF_OPPOSITE * gain:
            area = sum(int(e.mask.sum()) for e in evidence)
            return Verdict(len(evidence), union, change, min(1.0, union + gain / max(area, 1)))
    return Verdict(len(evidence), union)


def _smaller(evidence: Evidence) -> Evidence:
    every = max(1, -(-max(evidence.camera.width, evidence.camera.height) // _SIZE))
    camera = evidence.camera.smaller(every)
    mask = evidence.mask[every // 2 :: every, every // 2 :: every][: camera.height, : camera.width]
    # A picture whose size is not a multiple of the step may end before the last small pixel's middle.
    mask = np.pad(mask, ((0, camera.height - mask.shape[0]), (0, camera.width - mask.shape[1])), mode="edge")
    return Evidence(camera, mask, evidence.lens)


def changed(evidence: Evidence, change: Change) -> Evidence:
    """The view after the change, but for the mesh's size, and without its lens."""
    mask = oriented(evidence.mask, change.orientation)
    lens = Lens() if change.no_lens else evidence.lens
    return Evidence(change.camera(evidence.camera), ~mask if change.inverted else mask, lens).straight()


def _silhouette(mesh: ChartMesh, evidence: Evidence, change: Change) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    after = changed(evidence, change)
    camera = after.camera
    if change.mesh_scale != 1:
        # Scaling the mesh is scaling the cameras' distances the other way, without another copy of it.
        matrix = camera.camera_to_world.copy()
        matrix[:3, 3] /= change.mesh_scale
        camera = replace(camera, camera_to_world=matrix)
    return camera.silhouette(mesh.vertices, mesh.triangles), after.mask


def _union(mesh: ChartMesh, evidence: list[Evidence], change: Change) -> float:
    def fit(view: Evidence) -> float:
        seen, mask = _silhouette(mesh, view, change)
        return float((seen & mask).sum() / max(int((seen | mask).sum()), 1))

    return median(fit(view) for view in evidence)


def _wrong(mesh: ChartMesh, evidence: Evidence, change: Change) -> int:
    seen, mask = _silhouette(mesh, evidence, change)
    return int((seen ^ mask).sum())

"""From another program's capture to a capture folder."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from .. import _native
from ..errors import CaptureError
from ..files.folder import content_hash
from .capture_folder import CaptureWriter
from .changes import PLAIN, Change
from .chart_mesh import ChartMesh, read_mesh
from .choices import HULL, MASKS, Choices
from .detective import FITTING, SOUND, Verdict, examine, overlap
from .grabcut import discs_of_common_ball
from .hull import carve
from .moving_light import LightMotion, LitView, light_motion
from .parser_labels import LABELS, name_table
from .photographs import ImportedView, Reading, camera_of, take, up_directions
from .pictures import Photograph, read_photograph
from .pinhole import Pinhole
from .placement import UNITS, Placement, place
from .programs import read_source
from .source import Lens, Source, SourceView, moved
from .summary import ViewStatistics, left_out_by_reason, summary
from .view_files import (
    present,
    refuse_overlap,
    refuse_shared_masks,
    refuse_shared_photographs,
    unregistered,
    with_planes,
)
from .view_names import listed, named_views, withheld_views, without

Progress = Callable[[int, int, str], object]
AnyPath = str | os.PathLike[str]

_EXAMINED = 8
"""Views that the detective examines."""


class CaptureWarning(UserWarning):
    """A property of an imported capture that its maker should know."""


def import_capture(
    format: str,
    path: AnyPath,
    out: AnyPath,
    *,
    mesh: AnyPath | None = None,
    objects: Sequence[str] = (),
    pictures: AnyPath | None = None,
    masks: AnyPath | None = None,
    labels: AnyPath | None = None,
    parser: str | None = None,
    curve: str = "auto",
    brackets: int = 1,
    even_exposure: bool = False,
    holdout: int | Sequence[str] | None = None,
    shrink: int = 1,
    unit: str | None = None,
    place: str = "auto",
    front: str | None = None,
    apply: bool = False,
    skip_missing: bool = False,
    leave_out: Sequence[str] = (),
    light_frame: str | None = None,
    progress: Progress | None = None,
) -> Path:
    """Bring a capture of ``format`` (``transforms``, ``colmap``, ``metashape``, ``emily``) at ``path`` into the
    capture folder ``out``, with ``import.json``, which lists the assumptions; returns the folder.

    ``mesh`` is an OBJ with texture coordinates, of which ``objects`` are the face, or ``hull``: the visual hull of
    the masks. ``pictures`` is the folder of the photographs, where the files do not name it. ``masks`` is a folder of
    masks, ``alpha`` (that of the photographs), ``silhouette`` (of the mesh) or ``grabcut`` (what differs from the
    surroundings of the place that the cameras look at); by default those that the file names, else alpha, else the
    silhouette, or for a hull ``grabcut``. ``labels`` is a folder of a face parser's pictures and ``parser`` its name or a JSON file of
    names by id. ``curve`` is the photographs' transfer curve (``auto``, ``srgb``, ``linear``, ``rec709``,
    ``gamma=2.2``), ``brackets`` how many exposures each view has, ``even_exposure`` divides by what EXIF
    says the camera let through. ``holdout`` withholds every n-th view (from the n-th on) or those named;
    ``shrink`` averages so many pixels a side. ``unit`` (``m``, ``cm``, ``mm``, ``dm``, ``in``) is the
    source's; ``place`` is ``auto``, ``keep`` or ``cameras`` (upright by the cameras), ``front`` the name of a
    view that looks at the face, where cameras stand all round. If one change of a
    convention makes masks and mesh fit, ``apply`` makes it; without it that change is the error. ``skip_missing``
    leaves out views whose photograph or mask is missing, ``leave_out`` those named. ``light_frame`` is ``camera`` if the
    light stands still with respect to the camera (a head that turns in a room, or a lamp on the camera), by default what
    the file states, else ``head``.

    Raises `CaptureError`, `PictureError` or `StorageError`.
    """

    def path_of(value: AnyPath | None) -> Path | None:
        return None if value is None else Path(value)

    choices = Choices(
        mesh=mesh if mesh == HULL else path_of(mesh),
        objects=tuple(objects),
        pictures=path_of(pictures),
        masks=masks if isinstance(masks, str) and masks in MASKS else path_of(masks),
        labels=path_of(labels),
        holdout=holdout if holdout is None or isinstance(holdout, int) else tuple(holdout),
        leave_out=tuple(leave_out),
        parser=parser, curve=curve, brackets=brackets, even_exposure=even_exposure, shrink=shrink, unit=unit, place=place,
        front=front, apply=apply, skip_missing=skip_missing,
        light_frame=light_frame,
    )  # fmt: skip
    choices.check()
    source = read_source(format, Path(path), choices.pictures)
    _Import(format, Path(path), source, choices, progress or (lambda done, total, what: None)).write(Path(out))
    return Path(out)


class _Import:
    """One import: examines a few views, then reads, places and writes all."""

    def __init__(self, format: str, path: Path, source: Source, choices: Choices, progress: Progress) -> None:
        self.format, self.path, self.source, self.choices, self.progress = format, path, source, choices, progress
        self.notes: set[str] = set(source.assumed)
        self.light: LightMotion | None = None
        mesh = choices.mesh or source.mesh
        if mesh is None:
            raise CaptureError(
                f"{source.origin}: names no mesh; name an OBJ file with texture coordinates, or let one be carved from "
                "the masks (mesh hull)"
            )
        self.mesh_file = mesh if isinstance(mesh, Path) else None
        if self.mesh_file is not None:
            self.mesh = read_mesh(self.mesh_file, choices.objects or source.objects)
            self._check_layout()
        self.light_frame = choices.light_frame or source.light_frame
        self.source = self._with_files(source)
        self.withheld = withheld_views(self.source, choices.holdout)
        for words in left_out_by_reason(self.source):
            self._warn(words)

    def _check_layout(self) -> None:
        fault, warning, _ = self.mesh.layout_faults()
        if fault is not None:
            raise CaptureError(f"{self.mesh_file or 'mesh hull'}: {fault}")
        if not self.mesh.has_own_uv:
            self._warn("the mesh has no texture coordinates: it is unwrapped")
        if warning is not None:
            self._warn(f"the mesh {warning}")

    def _carve(self, reading: Reading) -> None:
        """Makes the mesh from all masks."""
        evidence = []
        for number, view in enumerate(self.source.views):
            self.progress(number, len(self.source.views), f"mask of {view.name}")
            taken = take(self.source, view, reading, self.notes)
            if taken.mask is not None:
                evidence.append(taken.evidence())
        self.progress(0, len(self.source.views), "carving the hull")
        self.mesh = carve(evidence)
        self._warn(
            f"the mesh is the visual hull of {len(evidence)} masks: concavities (eye sockets, beside the nose) are filled"
        )
        self._check_layout()

    def _with_files(self, source: Source) -> Source:
        """The views that are imported, with all their files."""
        choices = self.choices
        if source.whole_folders and choices.brackets == 1:
            source = replace(source, left_out=(*source.left_out, *unregistered(source)))
        if choices.leave_out:
            source = without(source, named_views(source, choices.leave_out, "leave_out"), "is left out by request")
        source = present(source, skip_missing=choices.skip_missing)
        refuse_shared_photographs(source, choices.brackets, self._warn)
        if choices.masks in MASKS:
            source = replace(source, views=tuple(replace(view, mask=None) for view in source.views))
        masks = choices.masks if isinstance(choices.masks, Path) else None
        source = with_planes(source, masks, choices.labels, skip_missing=choices.skip_missing)
        refuse_shared_masks(source)
        return source

    def write(self, out: Path) -> None:
        refuse_overlap(self.source, self.mesh_file, out)
        first = read_photograph(self.source.views[0].picture, self.choices.curve)
        reading = self._reading(first)
        if self.mesh_file is None:
            self._carve(reading)
        verdict = self._look(reading)
        change = verdict.change if verdict is not None and verdict.change is not None and self.choices.apply else PLAIN
        mesh = self.mesh
        if change.mesh_scale != 1:
            mesh = mesh.moved(np.diag([change.mesh_scale] * 3 + [1.0]))
        placement = self._place(mesh, change)
        if not np.array_equal(placement.matrix, np.eye(4)):
            mesh = mesh.moved(placement.matrix)
        folder = CaptureWriter(out, self._key())
        folder.mesh(mesh)
        report = ViewStatistics()
        examined, lit = {view.name for view in self._examined()}, list[LitView]()
        for number, view in enumerate(self.source.views):
            self.progress(number, len(self.source.views), f"view {view.name}")
            taken = self._placed(take(self.source, view, reading, self.notes), change, placement)
            report.note(taken, overlap(mesh, taken.evidence()) if taken.mask is not None else None)
            taken = self._finished(taken, mesh)
            if view.name in examined:
                lit.append(LitView.of(taken))
            folder.view(taken, withheld=view.name in self.withheld, light=view.light)
        self._judge(report)
        self.notes |= report.notes(even=reading.reference is not None)
        self.light = light_motion(mesh, lit)
        warning = None if self.light is None else self.light.warning(self.light_frame)
        if warning is not None:
            self._warn(warning)
        folder.transforms(sorted({*LABELS.items()}, key=lambda item: item[1]), self.light_frame)
        folder.record(self._record(reading, verdict, placement, report))
        folder.commit()
        self.progress(len(self.source.views), len(self.source.views), "capture")

    def _judge(self, report: ViewStatistics) -> None:
        """Refuses single views that do not fit, even if the others do."""
        misfits = report.below(FITTING)
        if misfits:
            shown = listed([f"{name} ({overlap:.2f})" for name, overlap in misfits.items()])
            raise CaptureError(
                f"{self.source.origin}: silhouettes overlap the masks by less than {FITTING:g} in {len(misfits)} of "
                f"{len(self.source.views)} views: {shown}; fix their cameras or masks, or leave them out (--leave-out)"
            )

    def _reading(self, first: Photograph) -> Reading:
        choices, source = self.choices, self.source
        own = any(view.mask is not None for view in source.views)
        alpha = choices.masks == "alpha"
        if choices.masks is None and not own and first.alpha is not None and first.alpha.min() < 0.5:
            alpha = True
            self.notes.add("masks are the photographs' alpha")
        discs = {}
        if choices.masks == "grabcut" or (self.mesh_file is None and not (own or alpha)):
            cameras = [camera_of(source, view) for view in source.views]
            discs = dict(zip((view.name for view in source.views), discs_of_common_ball(cameras)))
            self._warn("masks are cut from the photographs by GrabCut; inspect them")
        names = name_table(choices.parser or "unshade")
        if choices.parser is None and source.label_names:
            names = {number: name if name in LABELS else "other" for number, name in source.label_names.items()}
        reference = None
        if choices.brackets > 1 or choices.even_exposure:
            if first.exposure is None:
                raise CaptureError(
                    f"{source.views[0].picture}: has no exposure time in its EXIF; keep it, or even exposures beforehand"
                )
            reference = first.exposure
        return Reading(choices.curve, choices.brackets, reference, alpha, choices.masks == "silhouette", names, discs)

    def _look(self, reading: Reading) -> Verdict | None:
        """Verdict of the detective on some views; a change that fixes them is an error unless it is to be made."""
        evidence = []
        for view in self._examined():
            self.progress(0, len(self.source.views), f"looking at {view.name}")
            taken = take(self.source, view, reading, self.notes)
            if taken.mask is not None:
                evidence.append(taken.evidence())
        verdict = examine(self.mesh, evidence, self.source.elsewhere)
        if verdict is None:
            self.notes.add("cannot check whether the cameras fit the mesh; inspect the masks over the images")
            return None
        if verdict.change is not None and not self.choices.apply:
            raise CaptureError(
                f"{self.source.origin}: the mesh covers {verdict.union:.3f} of the masks (union, median of {verdict.views} views), "
                f"but {verdict.union_after:.3f} if {verdict.change.words} [{verdict.change.id}]; fix the files, or import with apply"
            )
        if verdict.change is not None:
            self.notes.add(f"applied: {verdict.change.words} [{verdict.change.id}]")
        elif verdict.union < FITTING:
            near = ""
            if verdict.nearest is not None:
                near = f"; nearest, {verdict.nearest[1]:.2f}, if {verdict.nearest[0].words} [{verdict.nearest[0].id}]"
            raise CaptureError(
                f"{self.source.origin}: silhouettes overlap the masks by {verdict.union:.2f} (median of {verdict.views} "
                f"views) and no single change makes them fit{near}; name mesh and masks of the reconstruction that "
                "the cameras are of"
            )
        elif verdict.union < SOUND:
            self._warn(
                f"silhouettes overlap the masks by {verdict.union:.2f} and no single change makes them fit; "
                "look at masks over images"
            )
        return verdict

    def _examined(self) -> list[SourceView]:
        """Views that are spread over all."""
        views = self.source.views
        count = min(len(views), _EXAMINED)
        return [views[number * len(views) // count] for number in range(count)]

    def _warn(self, words: str) -> None:
        self.notes.add(words)
        warnings.warn(f"{self.source.origin}: {words}", CaptureWarning, stacklevel=4)

    def _place(self, mesh: ChartMesh, change: Change) -> Placement:
        pinhole = [Pinhole(1, 1, (1.0, 1.0), (0.5, 0.5), view.camera_to_world) for view in self.source.views]
        metres = UNITS[self.choices.unit] if self.choices.unit else self.source.metres
        cameras = [change.camera(p).camera_to_world for p in pinhole]
        placement = place(
            mesh.vertices,
            cameras,
            up_directions(self.source, cameras, turned=change.orientation != 1),
            metres=metres,
            how=self.choices.place,
            facing=None if self.choices.front is None else self._view_called(self.choices.front),
        )
        self.notes.update(placement.words)
        for warning in placement.warnings:
            self._warn(warning)
        return placement

    def _view_called(self, name: str) -> tuple[str, int]:
        (view,) = named_views(self.source, [name], "front")
        return name, [other.name for other in self.source.views].index(view)

    def _placed(self, taken: ImportedView, change: Change, placement: Placement) -> ImportedView:
        """The view after the change, where the head comes to stand."""
        taken = taken.oriented(change.orientation, inverted=change.inverted)
        camera = change.camera(taken.camera)
        camera = replace(camera, camera_to_world=moved(placement.matrix, camera.camera_to_world))
        return replace(taken, camera=camera, lens=Lens() if change.no_lens else taken.lens)

    def _finished(self, taken: ImportedView, mesh: ChartMesh) -> ImportedView:
        """The view as it is written: without its lens where a capture cannot state it, smaller, with a mask."""
        if not taken.lens.kept or taken.mask is None or taken.name in self.withheld:
            taken = taken.undistorted()
        taken = taken.smaller(self.choices.shrink)
        if taken.mask is None or taken.name in self.withheld:
            # The mesh cannot predict what it lacks, so withheld photographs count where it is seen.
            seen = taken.camera.silhouette(mesh.vertices, mesh.triangles)
            inside = seen if taken.mask is None else seen & (taken.mask > 0)
            taken = replace(taken, mask=np.where(inside, 255, 0).astype(np.uint8))
        return taken

    def _key(self) -> str:
        """All that determines the output; for photographs their sizes and times."""
        parts = [self.format, str(self.path), repr(self.choices)]
        if self.mesh_file is not None:
            parts.append(content_hash(self.mesh_file))
        for view in self.source.views:
            parts.append(f"{view!r}")
            files = [file for file in (view.picture, view.mask, view.label) if file is not None and file.is_file()]
            parts += [f"{file} {file.stat().st_size} {file.stat().st_mtime_ns}" for file in files]
        return "\n".join(parts)

    def _record(
        self, reading: Reading, verdict: Verdict | None, placement: Placement, seen: ViewStatistics
    ) -> dict[str, Any]:
        choices, stated = self.choices, len(self.source.views) + len(self.source.left_out)
        masks = "grabcut" if reading.discs else "alpha" if reading.alpha else "silhouette"
        if any(view.mask is not None for view in self.source.views):
            masks = "files"
        return {
            "format": 1,
            "unshade": _native.__version__,
            "source": {"format": self.format, "path": str(self.path), "mesh": str(self.mesh_file or HULL)},
            "views": {view.name: str(view.picture) for view in self.source.views},
            "left_out": [{"name": name, "reason": reason} for name, reason in self.source.left_out],
            "withheld": sorted(self.withheld),
            "masks": masks,
            "labels": choices.parser if choices.labels else None,
            "curves": sorted(seen.curves),
            "profiles": sorted(seen.profiles),
            "shrink": choices.shrink,
            "brackets": choices.brackets,
            "fit": None
            if verdict is None
            else {
                "views": verdict.views,
                "union": round(verdict.union, 4),
                "change": verdict.change.id if verdict.change else None,
                "union_with_change": round(verdict.union_after, 4) if verdict.union_after is not None else None,
            },
            "front": placement.front,
            "light": None if self.light is None else self.light.record(),
            "source_to_capture": placement.matrix.tolist(),
            "overlap": {"median": seen.overlap, "views": seen.overlaps},
            "summary": summary(len(self.source.views), stated, placement.upright, masks, seen.overlap),
            "assumed": sorted(self.notes),
        }

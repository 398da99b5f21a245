"""One import: examines a few views, then reads, places and writes all."""

from __future__ import annotations

import warnings
from collections.abc import Callable
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
from .frame_choice import chosen_frames, directions, sharpness
from .grabcut import discs_of_common_ball, looked_at
from .hull import carve
from .moving_light import LightMotion, LitView, light_motion
from .parser_labels import LABELS, name_table
from .photographs import ImportedView, Reading, camera_of, take, up_directions
from .pictures import Photograph, read_photograph
from .pinhole import Pinhole
from .placement import UNITS, Placement, place
from .source import Lens, Source, SourceView, moved
from .summary import ViewStatistics, left_out_by_reason, summary
from .tracked_folder import with_vertices
from .uv_choice import with_uv
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

_EXAMINED = 8
"""Views that the detective examines."""


class CaptureWarning(UserWarning):
    """A property of an imported capture that its maker should know."""


class CaptureImport:
    """One import: examines a few views, then reads, places and writes all."""

    def __init__(self, format: str, path: Path, source: Source, choices: Choices, progress: Progress) -> None:
        self.format, self.path, self.source, self.choices, self.progress = format, path, source, choices, progress
        self.notes: set[str] = set(source.assumed)
        self.uv: dict[str, Any] = {}
        self.frames: dict[str, Any] | None = None
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
            if source.vertices is not None:
                self.mesh = with_vertices(self.mesh, self.mesh_file, source.vertices)
            self._settle_uv()
        self.light_frame = choices.light_frame or source.light_frame
        self.unknown_exposure = choices.unknown_exposure or source.unknown_exposure
        if self.unknown_exposure and (self.light_frame == "camera" or any(view.light for view in source.views)):
            raise CaptureError(
                f"{source.origin}: exposures are unknown and the light moves or changes, and one cannot be told from the "
                "other; fix the camera's exposure and white balance"
            )
        self.source = self._with_files(source)
        self.withheld = withheld_views(self.source, choices.holdout)
        for words in left_out_by_reason(self.source):
            self._warn(words)

    def _settle_uv(self) -> None:
        self.progress(0, len(self.source.views), "texture coordinates")
        self.mesh, warnings, self.uv = with_uv(self.mesh, self.choices.uv, str(self.mesh_file or "mesh hull"))
        for words in warnings:
            self._warn(words)

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
        self._settle_uv()

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
        if self.choices.frames is not None:
            self._choose_frames(reading, self.choices.frames)
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
        self.notes |= report.notes(even=reading.reference is not None or self.unknown_exposure)
        self.light = light_motion(mesh, lit)
        # Tracked meshes show whether the head moved.
        if self.light is not None and self.source.vertices is None:
            warning = self.light.warning(self.light_frame, fits=(report.overlap or 0) >= SOUND)
            if warning is not None:
                self._warn(warning)
        names = sorted({*LABELS.items()}, key=lambda item: item[1])
        folder.transforms(names, self.light_frame, unknown_exposure=self.unknown_exposure)
        folder.record(self._record(reading, verdict, placement, report))
        folder.commit()
        self.progress(len(self.source.views), len(self.source.views), "capture")

    def _choose_frames(self, reading: Reading, count: int) -> None:
        """Leaves so many of the views, besides those that are withheld or in front by name."""
        named = set(self.source.withheld)
        if isinstance(self.choices.holdout, tuple):
            named |= named_views(self.source, self.choices.holdout, "holdout")
        if self.choices.front is not None:
            named |= named_views(self.source, [self.choices.front], "front")
        views = [view for view in self.source.views if view.name not in named]
        mesh = None if self.mesh_file is None else self.mesh
        sharp: list[float] = []
        for number, view in enumerate(views):
            self.progress(number, len(views), f"sharpness of {view.name}")
            sharp.append(sharpness(take(self.source, view, reading, set()), mesh))
        cameras = [view.camera_to_world for view in views]
        centre = looked_at(cameras) if mesh is None else mesh.vertices.mean(0)
        chosen = chosen_frames(directions(cameras, centre), sharp, count)
        kept = {views[number].name for number in chosen} | named
        stated = len(self.source.views)
        views_kept = tuple(view for view in self.source.views if view.name in kept)
        self.source = replace(self.source, views=views_kept)
        self.withheld = withheld_views(self.source, self.choices.holdout)
        self.notes.add(f"{len(views_kept)} of {stated} frames are chosen by the directions they cover and by sharpness")
        rounded = {view.name: float(f"{value:.4g}") for view, value in zip(views, sharp)}
        self.frames = {"chosen": len(chosen), "of": len(views), "sharpness": rounded}

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
            "uv": self.uv,
            "frames": self.frames,
            "exposure": "unknown" if self.unknown_exposure else "known",
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

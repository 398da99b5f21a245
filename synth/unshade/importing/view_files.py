"""The files of each view: photograph, mask and label picture, none of them missing, shared or ambiguous."""

from __future__ import annotations

import filecmp
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..errors import CaptureError, StorageError
from .brackets import bracket
from .source import Source, SourceView
from .view_names import listed, short_names, tails, without, without_ending

_ENDINGS = (".png", ".tif", ".tiff", ".jpg", ".jpeg")
"""Endings of masks and label pictures."""

_SAME_POSE = 0.02
"""By how much two cameras of one photograph may differ: radians, and shares of their distance from the others' middle."""

_SAMPLE = 1 << 16
"""Bytes that distinguish files of one size before they are compared."""

Warn = Callable[[str], None]


def present(source: Source, *, skip_missing: bool) -> Source:
    """The source without the views whose photograph is missing, which are left out only with ``skip_missing``.
    Raises `CaptureError`."""
    missing = [view for view in source.views if not view.picture.is_file()]
    if not missing:
        return source
    first = missing[0].picture
    if len(missing) == len(source.views):
        raise CaptureError(
            f"{source.origin}: none of its {len(missing)} photographs is there, {first} the first of them; "
            "name the photographs' folder (--pictures)"
        )
    if not skip_missing:
        raise CaptureError(
            f"{source.origin}: {first} is missing{_count(source, missing, 'photographs')}; add it, or leave out views "
            "whose files are missing (--skip-missing)"
        )
    return without(source, {view.name for view in missing}, "its photograph is missing")


def with_planes(source: Source, masks: Path | None, labels: Path | None, *, skip_missing: bool) -> Source:
    """The source with the mask and label picture of each view, those of the folders ``masks`` and ``labels`` where
    they are named. Where any view has a mask, the views without are left out only with ``skip_missing``. Raises
    `CaptureError`."""
    photographs = {view.picture.resolve() for view in source.views}

    def of(folder: Path, view: SourceView, what: str) -> Path | None:
        return _named(folder, view, source.views, photographs, what)

    if masks is not None:
        source = replace(source, views=tuple(replace(v, mask=of(masks, v, "mask")) for v in source.views))
    bare = [view for view in source.views if view.mask is None or not view.mask.is_file()]
    if bare and (masks is not None or any(view.mask is not None for view in source.views)):
        first = bare[0]
        if not skip_missing or len(bare) == len(source.views):
            lacks = f"has no mask {first.picture.stem}.png for {short_names([first])[0]}"
            where = f"{masks or source.origin}: {lacks if first.mask is None else f'{first.mask} is missing'}"
            raise CaptureError(
                f"{where}{_count(source, bare, 'masks')}; add it, or leave out views whose files are missing "
                "(--skip-missing)"
            )
        source = without(source, {view.name for view in bare}, "its mask is missing")
    if labels is not None:
        source = replace(source, views=tuple(replace(v, label=of(labels, v, "label picture")) for v in source.views))
        for view in source.views:
            if view.label is None:
                stem = view.picture.stem
                raise CaptureError(f"{labels}: has no label picture {stem}.png for {view.picture.name}; add it")
    return source


def _count(source: Source, views: Sequence[SourceView], what: str) -> str:
    if len(views) == 1:
        return ""
    return f" ({len(views)} of {len(source.views)} {what} are missing: {listed(short_names(views))})"


def _named(
    folder: Path, view: SourceView, views: Sequence[SourceView], photographs: set[Path], what: str
) -> Path | None:
    """The picture of a folder that is called as the photograph: by as much of its path as there is, with the
    photograph's ending before its own or without."""
    ends = tails(view.picture)
    candidates = [(end, True) for end in ends[:-1]] + [(view.name, False), (ends[-1], True)]
    for name, is_path in candidates:
        bare = without_ending(name)
        for stem in (name, bare, f"{bare}_mask") if is_path else (name,):
            for ending in _ENDINGS:
                file = folder / f"{stem}{ending}"
                if not file.is_file() or file.resolve() in photographs:
                    continue
                rivals = [v for v in views if is_path and _called(v, name if stem == name else bare, stem == name)]
                if len(rivals) > 1:
                    names = short_names(rivals)
                    raise CaptureError(
                        f"{file}: could be the {what} of {' or '.join(names[:2])}; put each into the folder of its "
                        f"photograph, {folder / names[0]}.png"
                    )
                return file
    return None


def _called(view: SourceView, name: str, whole: bool) -> bool:
    ends = tails(view.picture)
    return name in ends if whole else name in map(without_ending, ends)


def unregistered(source: Source) -> list[tuple[str, str]]:
    """Photographs beside those of the views, of the same kinds, that no view has, each with the reason."""
    used = {view.picture.resolve() for view in source.views}
    kinds = {view.picture.suffix.lower() for view in source.views}
    folders = sorted({view.picture.parent for view in source.views if view.picture.parent.is_dir()})
    stated = {Path(name).name for name, _ in source.left_out}
    return [
        (file.name, "has no pose in the model")
        for folder in folders
        for file in sorted(folder.iterdir())
        if file.suffix.lower() in kinds and file.resolve() not in used and file.name not in stated
    ]


def refuse_shared_photographs(source: Source, brackets: int, warn: Warn) -> None:
    """Refuses views that share a photograph, or one of a bracket, and copies of one photograph with several cameras;
    warns of copies with one camera. Raises `CaptureError` or `PictureError`."""
    taken: dict[Path, SourceView] = {}
    for view in source.views:
        for file in bracket(view.picture, brackets) if brackets > 1 else [view.picture]:
            _claim(source, taken, file, view, "the photograph")
    for first, second in _copies(source.views):
        names = " and ".join(short_names([first, second]))
        if _differ(source, first, second):
            raise CaptureError(
                f"{source.origin}: {names} are copies of one photograph, but have different cameras; "
                "copy the photograph that belongs there, or remove one of the cameras"
            )
        warn(f"{names} are copies of one photograph, which counts twice; remove one of the cameras")


def refuse_shared_masks(source: Source) -> None:
    """Refuses views that share a mask's file. Raises `CaptureError`."""
    masks: dict[Path, SourceView] = {}
    for view in source.views:
        if view.mask is not None:
            _claim(source, masks, view.mask, view, "the mask")


def refuse_overlap(source: Source, mesh: Path | None, out: Path) -> None:
    """Raises `StorageError` for an output that would replace an input."""
    target = out.resolve()
    for view in source.views:
        for file in (source.origin, mesh, view.picture, view.mask, view.label):
            if file is not None and target in (file.resolve(), *file.resolve().parents):
                raise StorageError(f"{out}: holds {file.name}, which is read; choose another folder for the capture")


def _claim(source: Source, claimed: dict[Path, SourceView], file: Path, view: SourceView, what: str) -> None:
    other = claimed.setdefault(file.resolve(), view)
    if other is not view:
        raise CaptureError(
            f"{source.origin}: {other.stated or other.name} and {view.stated or view.name} share {what} {file}; "
            "state the file of each"
        )


def _copies(views: Sequence[SourceView]) -> list[tuple[SourceView, SourceView]]:
    """Pairs of views whose photographs hold the same bytes."""
    alike: dict[tuple[int, bytes], list[SourceView]] = {}
    sizes: dict[int, list[SourceView]] = {}
    for view in views:
        sizes.setdefault(view.picture.stat().st_size, []).append(view)
    for size, group in sizes.items():
        for view in group if len(group) > 1 else ():
            with view.picture.open("rb") as file:
                file.seek(max(size - _SAMPLE, 0) // 2)
                alike.setdefault((size, file.read(_SAMPLE)), []).append(view)
    return [
        (group[0], view)
        for group in alike.values()
        for view in group[1:]
        if filecmp.cmp(group[0].picture, view.picture, shallow=False)
    ]


def _differ(source: Source, first: SourceView, second: SourceView) -> bool:
    a, b = first.camera_to_world, second.camera_to_world
    places = np.array([view.camera_to_world[:3, 3] for view in source.views])
    spread = float(np.linalg.norm(places - places.mean(0), axis=1).max())
    turned = float(np.linalg.norm(a[:3, :3] - b[:3, :3])) / 2**0.5
    return turned > _SAME_POSE or float(np.linalg.norm(a[:3, 3] - b[:3, 3])) > _SAME_POSE * spread

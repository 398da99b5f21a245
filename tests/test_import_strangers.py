"""Captures as strangers have them, from the command line: right, or refused in one line with the fix."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import foreign_heads as heads
import numpy as np
import pytest
from foreign_heads import CENTRE, HEIGHT, NAMES, WIDTH

from unshade.importing.command import main

MIDDLE = (WIDTH / 2, HEIGHT / 2)
LENS = "<k1>0.15</k1><k2>-1.2</k2><k3>2.2</k3>"
MASKS = ("--masks", "masks")
CAMERAS = "".join(heads.camera(n, name, name) for n, name in enumerate(NAMES))
RIGHT = "imported 6 of 6 views, head upright by the cameras' mean up, silhouettes overlap 1.00"
NO_MASKS = "masks are the mesh's silhouette, so the fit of the cameras is unchecked"

Case = tuple[Callable[[Path], object], tuple[str, ...], str]
"""What writes the source, the arguments after the format and path, and what the terminal must say."""


def _agisoft(*chunks: str, masks: bool = True, bare: bool = False) -> Callable[[Path], object]:
    return lambda folder: heads.metashape(heads.photographs(folder, masks=masks), *chunks, bare=bare)


def _grouped(inside: str, *, flat: bool = False, groups: bool = True) -> Callable[[Path], object]:
    """Three labels that stand in two groups, photographs in folders named as the groups."""

    def write(folder: Path) -> None:
        paths = {name: f"images/cam{n % 2 + 1}/IMG_{n // 2}.png" for n, name in enumerate(NAMES)}
        heads.photographs(folder, paths, masks=False)
        if flat:
            for n in range(3):
                heads.photograph(folder / "images" / f"IMG_{n}.png", NAMES[2 * n])
        listed = ["".join(heads.camera(n, NAMES[n], f"IMG_{n // 2}") for n in (m, m + 2, m + 4)) for m in (0, 1)]
        if groups:
            listed = [
                f'<group id="{n}" label="cam{n + 1}" type="folder">{text}</group>' for n, text in enumerate(listed)
            ]
        heads.metashape(folder, heads.chunk("".join(listed)) if inside == "chunk" else
                        heads.chunk(listed[0], label="cam1", more=_PLACED) + heads.chunk(listed[1], label="cam2", more=_PLACED))  # fmt: skip

    return write


_PLACED = (
    "<transform><rotation>1 0 0 0 1 0 0 0 1</rotation><translation>0 0 0</translation><scale>1</scale></transform>"
)


def _rig(location: str, *, master: bool = True) -> str:
    """Cameras 0, 2 and 4 are masters, each with a slave as camera 1 is to 0."""
    relative = np.linalg.inv(heads.pose("000") @ heads.OPENCV_AXES) @ heads.pose("001") @ heads.OPENCV_AXES
    placed = f"<rotation>{heads.numbers(relative[:3, :3])}</rotation>" + location.format(heads.numbers(relative[:3, 3]))
    cameras = heads.camera(0, "000" if master else None, "000")
    cameras += heads.camera(1, None, "001", 'master_id="0"', 1) + "".join(
        heads.camera(n, name, name) for n, name in enumerate(NAMES) if n > 1
    )
    return heads.chunk(cameras, heads.sensor() + heads.sensor(number=1, attributes='master_id="0"', placed=placed))


METASHAPE: dict[str, Case] = {
    "PhotoScan's centre": (_agisoft(heads.chunk(CAMERAS, heads.sensor(heads.PHOTOSCAN))), MASKS, RIGHT),
    "PhotoScan's centre without masks": (
        _agisoft(heads.chunk(CAMERAS, heads.sensor(heads.PHOTOSCAN)), masks=False), (), NO_MASKS),
    "PhotoScan's chunk": (_agisoft(heads.chunk(CAMERAS, heads.sensor(heads.PHOTOSCAN)), bare=True), MASKS, RIGHT),
    "PhotoScan's centre and a lens": (
        _agisoft(heads.chunk(CAMERAS, heads.sensor(heads.PHOTOSCAN + LENS))), MASKS, "6 of 6 views"),
    "a centre beyond a quarter": (
        _agisoft(heads.chunk(CAMERAS, heads.sensor(heads.PHOTOSCAN.replace("fx>", "f>").replace("fy>", "b1>").replace(
            f"<b1>{heads.FOCAL}</b1>", "")))), MASKS, RIGHT),
    "offsets from the middle": (_agisoft(heads.chunk(CAMERAS)), MASKS, RIGHT),
    "a rig": (_agisoft(_rig("<location>{}</location>")), MASKS, RIGHT),
    "a rig without its geometry": (_agisoft(_rig("")), MASKS, "001 is a slave of 000 in a rig, but its sensor 'sensor 1' has no"),
    "a rig whose master is not aligned": (
        _agisoft(_rig("<location>{}</location>", master=False)), MASKS, "left out 1 of 6 views, 001: the master of its rig was"),
    "groups with folders, and copies": (_grouped("chunk", flat=True), (), "imported 6 of 6 views"),
    "groups with folders": (_grouped("chunk"), (), "imported 6 of 6 views"),
    "chunks with folders": (_grouped("document", groups=False), (), "imported 6 of 6 views"),
    "one label in two folders": (_grouped("chunk", groups=False), (), "could be images/cam1/IMG_0.png or images/cam2/IMG_0.png"),
    "one label, one file": (
        _agisoft(heads.chunk(CAMERAS.replace('label="001"', 'label="000"'))), (), "share the photograph images/000.png"),
    "one label, two endings": (
        lambda folder: (_agisoft(heads.chunk(CAMERAS))(folder), heads.photograph(folder / "images/003.tif", "003")),
        (), "'003' could be images/003.png or images/003.tif"),
    "chunks without a common world": (
        _agisoft(heads.chunk("".join(heads.camera(n, m, m) for n, m in enumerate(NAMES[:4]))),
                 heads.chunk("".join(heads.camera(n, m, m) for n, m in enumerate(NAMES[4:])), label="B")),
        MASKS, "left out 2 of 6 views, 004, 005: chunk 'B' has no coordinates in common with chunk 'Chunk 1'"),
    "chunks of one size": (
        _agisoft(heads.chunk("".join(heads.camera(n, m, m) for n, m in enumerate(NAMES[:3]))),
                 heads.chunk("".join(heads.camera(n, m, m) for n, m in enumerate(NAMES[3:])), label="B")),
        MASKS, "have 3 cameras each and no common coordinates"),
    "a component apart": (
        _agisoft(heads.chunk("".join(heads.camera(n, m, m, f'component_id="{n // 4}"') for n, m in enumerate(NAMES)),
                             more='<components><component id="0"/><component id="1" label="rest"/></components>')),
        MASKS, "left out 2 of 6 views, 004, 005: chunk 'Chunk 1', component 'rest' has no coordinates in common"),
    "what is not aligned or enabled": (
        _agisoft(heads.chunk(CAMERAS + heads.camera(7, None, "lost") + heads.camera(8, "000", "off", 'enabled="false"'))),
        MASKS, "left out 1 of 8 views, lost: was not aligned"),
}  # fmt: skip


def _model(*models: list[tuple[str, str]], paths: dict[str, str] | None = None) -> Callable[[Path], object]:
    def write(folder: Path) -> None:
        heads.photographs(folder, paths)
        for number, images in enumerate(models):
            heads.colmap(folder / "sparse" / str(number), images)

    return write


ALL = [(name, f"{name}.png") for name in NAMES]
RIG = [(name, f"cam{n % 2 + 1}/{n // 2}.png") for n, name in enumerate(NAMES)]
_FOLDERS = {name: f"images/{path}" for name, path in RIG}


def _rig_masks(form: str) -> Callable[[Path], object]:
    def write(folder: Path) -> None:
        _model(RIG, paths=_FOLDERS)(folder)
        shutil.rmtree(folder / "masks")
        for name, path in RIG:
            heads.mask(folder, form.format(path=path, stem=Path(path).stem, flat=path[:-4].replace("/", "_")), name)

    return write


COLMAP: dict[str, Case] = {
    "one model": (_model(ALL), MASKS, RIGHT),
    "a fragment first": (
        _model(ALL[:2], ALL[2:]), MASKS, "left out 2 of 6 views, 000.png, 001.png: is in sparse/0 alone, a model of 2 views; sparse/1 has 4"),
    "models of one size": (_model(ALL[:3], ALL[3:]), MASKS, "the models sparse/0 and sparse/1 have 3 views each"),
    "photographs without a pose": (_model(ALL[1:]), MASKS, "left out 1 of 6 views, 000.png: has no pose in the model"),
    "one picture twice": (_model([*ALL[:5], ("005", "000.png")]), MASKS, "share the photograph images/000.png"),
    "masks as COLMAP has them": (_rig_masks("masks/{path}.png"), MASKS, RIGHT),
    "masks in folders": (_rig_masks("masks/{path}"), MASKS, RIGHT),
    "masks by the names of views": (_rig_masks("masks/{flat}.png"), MASKS, RIGHT),
    "flat masks": (_rig_masks("masks/{stem}.png"), MASKS,
                   "masks/0.png: could be the mask of cam1/0.png or cam2/0.png; put each into the folder"),
    "withheld by a name of two": (
        _rig_masks("masks/{path}"), (*MASKS, "--holdout", "0,1"), "holdout: '0' could be cam1/0.png or cam2/0.png"),
    "withheld by paths": (_rig_masks("masks/{path}"), (*MASKS, "--holdout", "cam1/0.png,cam2/1"), RIGHT),
    "withheld by a step that reaches none": (_model(ALL), ("--holdout", "8"), "holdout is 8, but there are 6 views"),
}  # fmt: skip


def _frames(*names: str, **more: str) -> list[dict]:
    return [heads.frame(name, f"images/{name}.png", **more) for name in names]


def _split(**files: list[tuple[str, str]]) -> Callable[[Path], object]:
    """As Blender's exporters write it: an angle, no size, no endings, masks as alpha."""

    def write(folder: Path) -> None:
        heads.mesh(folder)
        angle = 2 * np.arctan(WIDTH / 2 / heads.FOCAL)
        bare = dict.fromkeys(("w", "h", "fl_x", "fl_y", "cx", "cy"))
        for file, listed in files.items():
            for name, path in listed:
                heads.photograph(
                    folder / f"{path}.png", name, alpha=heads.silhouette(folder / "head.obj", name, MIDDLE)
                )
            frames = [heads.frame(name, f"./{path}") for name, path in listed]
            heads.transforms(folder, frames, f"transforms_{file}.json", **bare, camera_angle_x=angle)

    return write


_TRAIN, _TEST = ([(name, f"{where}/r_{n}") for n, name in enumerate(some)]
                 for where, some in (("train", NAMES[:4]), ("test", NAMES[4:])))  # fmt: skip


def _written(change: Callable[[Path], object], **document: object) -> Callable[[Path], object]:
    """A sound capture of transforms.json, but for one change."""

    def write(folder: Path) -> None:
        heads.photographs(folder)
        heads.transforms(folder, **document)  # type: ignore[arg-type]
        change(folder)

    return write


def _nothing(folder: Path) -> None: ...


def _copied(folder: Path) -> None:
    shutil.copy(folder / "images" / "000.png", folder / "images" / "001.png")


def _mask_of(name: str, other: np.ndarray) -> Callable[[Path], None]:
    return lambda folder: heads.Image.fromarray(other).save(folder / "masks" / f"{name}.png")


_OFF = np.zeros((HEIGHT, WIDTH), np.uint8)
_OFF[:12, :12] = 255
_FROM_MIDDLE = {"cx": CENTRE[0] - WIDTH / 2, "cy": CENTRE[1] - HEIGHT / 2, "k1": 0.15, "k2": -1.2, "k3": 2.2}


def _halves(folder: Path) -> None:
    """Masks that lack the lower third of the head."""
    for name in NAMES:
        plane = heads.silhouette(folder / "head.obj", name)
        rows = np.flatnonzero(plane.any(1))
        plane[rows[int(len(rows) * 0.72)] :] = 0
        _mask_of(name, plane)(folder)


TRANSFORMS: dict[str, Case] = {
    "as it is": (_written(_nothing), (), RIGHT),
    "a split by files": (_split(train=_TRAIN, test=_TEST), (), RIGHT),
    "a split whose val repeats test": (_split(train=_TRAIN, test=_TEST, val=_TEST), (), RIGHT),
    "a split that tests what it trains": (_split(train=_TRAIN, test=_TRAIN[:1]), (), "share the photograph"),
    "a split without its training": (_split(test=_TEST), (), "has transforms_test.json, but not transforms_train.json"),
    "two endings": (
        lambda folder: (_split(train=_TRAIN, test=_TEST)(folder), heads.photograph(folder / "train/r_0.tif", "000")),
        (), "'./train/r_0' could be r_0.png or r_0.tif"),
    "a frame twice": (
        _written(_nothing, frames=_frames(*NAMES, "000")), (), "share the photograph images/000.png"),
    "a mask for two": (
        _written(_nothing, frames=_frames(*NAMES, mask_path="masks/000.png")), (), "share the mask masks/000.png"),
    "a copy for another photograph": (_written(_copied), (), "000.png and 001.png are copies of one photograph"),
    "a mask that is missing": (
        _written(lambda folder: (folder / "masks/002.png").unlink()), (), "masks/002.png is missing; add it, or leave out"),
    "a mask that is left out": (
        _written(lambda folder: (folder / "masks/002.png").unlink()), ("--skip-missing",), "imported 5 of 6 views"),
    "a frame without a mask": (
        _written(_nothing, frames=[*_frames("000"), *(heads.frame(n, f"images/{n}.png", mask_path=f"masks/{n}.png") for n in NAMES[1:])]),
        (), "has no mask 000.png for 000.png"),
    "masks of something else": (
        _written(lambda folder: [_mask_of(name, _OFF)(folder) for name in NAMES]), (),
        "silhouettes overlap the masks by 0.00 (median of 6 views) and no single change makes them fit"),
    "masks without the chin": (_written(_halves), (), "and no single change makes them fit; look at masks"),
    "one mask of something else": (
        _written(_mask_of("003", _OFF)), (), "in 1 of 6 views: 003 (0.00); fix their cameras or masks, or leave them out"),
    "one mask left out": (
        _written(_mask_of("003", _OFF)), ("--leave-out", "003"), "left out 1 of 6 views, 003: is left out by request"),
    "a centre from the middle, and a lens": (_written(_nothing, **_FROM_MIDDLE), (), "[principal-point-from-middle]"),
    "a centre from the middle, applied": (_written(_nothing, **_FROM_MIDDLE), ("--apply",), "imported 6 of 6 views"),
    "a lens that the photographs lack": (_written(_nothing, k1=4.0), (), "[no-lens]"),
}  # fmt: skip

REFUSED = ("could be", "share the", "is missing", "is a slave of", "each", "but there are", "but not", "copies of one",
           "has no mask", "views) and no single change", "in 1 of 6", "[")  # fmt: skip


@pytest.mark.parametrize(
    ("format", "path", "case"),
    [
        pytest.param(format, path, case, id=f"{format}: {name}")
        for format, path, cases in (("metashape", "cameras.xml", METASHAPE), ("colmap", ".", COLMAP), ("transforms", ".", TRANSFORMS))
        for name, case in cases.items()
    ],
)  # fmt: skip
def test_each_capture_is_right_or_refused(
    format: str,
    path: str,
    case: Case,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    write, arguments, words = case
    (tmp_path / "source").mkdir()
    write(tmp_path / "source")
    monkeypatch.chdir(tmp_path / "source")
    capsys.readouterr()
    pictures = ["--pictures", "images"] if format == "metashape" else []
    code = main([format, path, "-o", "out", "--mesh", "head.obj", *pictures, *arguments])
    said = capsys.readouterr().err
    assert words in said, said
    lines = said.splitlines()
    if code:
        assert code == 2 and len(lines) == 1 and any(word in said for word in REFUSED) and not Path("out").exists()
        return
    assert heads.wrong_views(Path("out"), MIDDLE if Path("transforms_train.json").is_file() else CENTRE) == []
    record = json.loads(Path("out/import.json").read_text())
    assert record["summary"] in lines[-1] and lines[-1].startswith("out: imported ")
    assert len(record["views"]) + len(record["left_out"]) == int(record["summary"].split()[3])


def _of_format(format: str, folder: Path) -> tuple[str, list[str]]:
    """A sound capture, and the photograph of its third camera."""
    if format == "emily":
        heads.emily(folder)
        return ".", ["DigitalEmily2_FlashParallel/cam2_flash.exr"]
    heads.photographs(folder, masks=False)
    if format == "transforms":
        heads.transforms(folder, _frames(*NAMES))
    elif format == "colmap":
        heads.colmap(folder / "sparse", ALL)
    else:
        heads.metashape(folder, heads.chunk(CAMERAS))
    return "cameras.xml" if format == "metashape" else ".", ["images/002.png"]


@pytest.mark.parametrize("format", ["transforms", "colmap", "metashape", "emily"])
def test_a_missing_photograph_is_named_and_left_out_on_request(
    format: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    path, [missing] = _of_format(format, tmp_path)
    mesh = [] if format == "emily" else ["--mesh", "head.obj"]
    (tmp_path / missing).unlink()
    whole = [format, path, "-o", "out", *mesh]
    if format != "emily":  # Its pictures are found by the cameras' numbers.
        assert main(whole) == 2
        said = capsys.readouterr().err
        assert "images/002" in said and "is missing; add it, or leave out" in said and "--skip-missing" in said
        whole.append("--skip-missing")
    assert main(whole) == 0
    said = capsys.readouterr().err.splitlines()
    assert "left out 1 of 6 views, " in said[0] and "imported 5 of 6 views" in said[-1] and NO_MASKS in said[-1]
    assert format == "emily" or heads.wrong_views(tmp_path / "out") == []

"""The rendering stages as child processes: ``python -m unshade.stage``.

Standard input carries a line of JSON, the request: the name of the stage as ``stage``, and its arguments by name.
When standard input then ends, the parent has died, and this process ends too. Standard output carries JSON lines:
``progress``, ``warning``, and one ``result`` or ``error`` at the end. The exit code is 0 after success, 2 for bad
input, 3 after an interrupt, and 1 for a fault of unshade (its traceback goes to standard error).
"""

from __future__ import annotations

import json
import os
import sys
import threading
import traceback
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

from . import errors
from .errors import ExportError, MapsError, SceneError, UnshadeError

_INTERRUPTED, _FAULT = 3, 1


def main() -> int:
    """Does the stage that standard input names; returns the exit code."""
    request = json.loads(sys.stdin.buffer.readline())
    warnings.showwarning = _show_warning
    threading.Thread(target=_leave_with_parent, daemon=True).start()
    try:
        result = _STAGES[request.pop("stage")](**request)
    except UnshadeError as error:
        place = None
        if isinstance(error, SceneError) and error.key is not None:
            place = {"table": error.table, "key": error.key}
        _send("error", kind=_public_kind(error), message=" ".join(str(error).split()), place=place)
        return error.exit_code
    except KeyboardInterrupt:
        return _INTERRUPTED
    except Exception:
        traceback.print_exc()
        return _FAULT
    _send("result", **result)
    return 0


def _public_kind(error: UnshadeError) -> str:
    """The nearest class of `unshade.errors`, which is all that callers can catch."""
    return next(kind.__name__ for kind in type(error).__mro__ if hasattr(errors, kind.__name__))


def _synth(scene: str, out: str) -> dict[str, Any]:
    from .render import llvm
    from .scene_file import read_scene

    read = read_scene(Path(scene))
    choice = _activate(llvm.choose(read.render.variant))
    from .render.capture import synthesise

    synthesise(read, Path(out), choice, _progress)
    return {"capture": out, "variant": choice.variant}


def _relight(
    capture: str, maps: str, out: str, renderer: str, scales: list[tuple[str, float]], light: str | None
) -> dict[str, Any]:
    from .render import llvm

    for name, factor in scales:
        if not 0 < (factor or 0) < float("inf"):
            raise MapsError(f"{maps}: the {name} factor on the albedo is {factor}; give an albedo that is not black")
    folder = Path(capture)
    photographed = not (folder / "truth").is_dir() and (folder / "transforms.json").is_file()
    if photographed:
        source: Any = folder
        choice = _activate(llvm.choose("auto"))
        from .render.photographed import relight_photographed as relight
    else:
        from .render.truth_scene import captured_scene

        source = captured_scene(folder)
        choice = _activate(llvm.choose(source.versions["variant"]))
        if renderer == "cycles":
            from .cycles.relight import relight
        else:
            from .render.relight import relight
    relight(
        source, Path(maps), Path(out), given=_given(light),
        scales=dict(scales), seed_offset=0, progress=_progress, warn=_warn,
    )  # fmt: skip
    return {"relit": out, "variant": choice.variant}


def _given(light: str | None) -> Any:
    """The light of a file; no stage of a run has one."""
    if not light:
        return None
    from .render.given_light import given_light

    return given_light(Path(light))


def _budget(capture: str, maps: str, out: str, light: str | None, view: str | None, factor: float) -> dict[str, Any]:
    scene = _rendered(capture)
    from .render.error_budget import write_budget

    chosen = {"light": light, "view": view, "factor": factor}
    return write_budget(scene, Path(capture), Path(maps), Path(out), **chosen, progress=_progress, warn=_warn)


def _lights(capture: str, out: str) -> dict[str, Any]:
    scene = _rendered(capture)
    from .render.handed_lights import write_lights

    return {"lights": write_lights(scene, Path(out))}


def _rendered(capture: str) -> Any:
    """The scene of a rendered capture, with the renderer that made it."""
    from .render import llvm
    from .render.truth_scene import captured_scene

    scene = captured_scene(Path(capture))
    _activate(llvm.choose(scene.versions["variant"]))
    return scene


def _export(
    maps: str, out: str, capture: str | None, mesh: str | None, format: str, bits: int, normal_y: str, no_fidelity: bool
) -> dict[str, Any]:
    from .render import llvm

    if bits not in (8, 16):
        raise ExportError(f"bits is {bits}; use 8 or 16")
    _activate(llvm.choose())
    from .exporting.assets import Options, export

    place, head = (None if path is None else Path(path) for path in (capture, mesh))
    chosen = Options(format, bits, normal_y == "plus", not no_fidelity)
    rows, lines = export(Path(maps), Path(out), place, head, chosen, _progress, _warn)
    return {"asset": out, "fidelity": rows, "lines": lines}


def _lpips(net: str, pictures: list[dict[str, Any]]) -> dict[str, Any]:
    from .perceptual import judge

    return {"values": judge(net, pictures)}


def _metrics(**request: Any) -> dict[str, Any]:
    from .own_metrics import answer

    return answer(request)


def _figure(folder: str) -> dict[str, Any]:
    from .figures.draw import draw

    return {"files": [str(path) for path in draw(Path(folder))]}


def _method(name: str, capture: str, out: str, settings: dict[str, Any]) -> dict[str, Any]:
    import unshade

    from .methods import CONTROLLED, method, require_still_light
    from .render import llvm

    require_still_light(name, Path(capture))

    # A capture without a truth, which passive methods get, does not say what rendered it.
    scene = _rendered(capture) if name in CONTROLLED else None
    if scene is None:
        _activate(llvm.choose("auto"))
    # Their modules name the renderer's classes, which need a variant.
    recover = method(name, settings)
    given: list[Any] = [unshade.Capture(capture)]
    if scene is not None:
        from .methods.laboratory import Laboratory

        given.append(Laboratory(scene, _progress))
    recovered = recover(*given, **settings)
    maps, light = recovered if isinstance(recovered, tuple) else (recovered, None)
    maps.write(out, light=light)
    return {"maps": out}


def _cluster(order: dict[str, Any], address: str, store: str, workers: int) -> dict[str, Any]:
    from .cluster.command import on_cluster

    return on_cluster(order, address, store, workers, _progress)


def _check(scenes: list[str]) -> dict[str, Any]:
    from .scene_file import read_scene

    return {"names": [read_scene(Path(scene)).name for scene in scenes]}


def _describe(scene: str) -> dict[str, Any]:
    from .render import llvm
    from .scene_file import read_scene

    read = read_scene(Path(scene))
    _activate(llvm.choose(read.render.variant))
    from .render.describe import describe

    return {"text": describe(read)}


def _contact_sheet(count: int, seed: int, out: str) -> dict[str, Any]:
    from .render import llvm

    _activate(llvm.choose())
    from .render.contact_sheet import contact_sheet

    contact_sheet(count, Path(out), seed, _progress)
    return {"picture": out}


def _history(history: str, out: str) -> dict[str, Any]:
    from .history_chart import write

    return {"steps": write(Path(history), Path(out))}


def _physics() -> dict[str, Any]:
    from .render import llvm

    _activate(llvm.choose())
    from .render.physics import examine

    return {"checks": examine(_progress)}


def _doctor() -> dict[str, Any]:
    from .render.doctor import examine

    return {"checks": examine()}


_STAGES: dict[str, Callable[..., dict[str, Any]]] = {
    stage.__name__.removeprefix("_"): stage
    for stage in (
        _synth, _relight, _budget, _lights, _export, _lpips, _metrics, _figure, _method, _cluster, _check, _describe,
        _contact_sheet, _history, _physics, _doctor,
    )
}  # fmt: skip
"""The stages by their names in requests (`harness/src/synth/request.rs`)."""


def _activate(choice):
    from .render import llvm

    if choice.warning:
        _warn(choice.warning)
    llvm.activate(choice)
    return choice


def _progress(done: int, total: int, what: str) -> None:
    _send("progress", done=done, total=total, what=what)


def _warn(message: str) -> None:
    _send("warning", message=message)


def _show_warning(message: Warning | str, category: type[Warning], *place: Any, **more: Any) -> None:
    """Warnings of ours are for the user; those of libraries for whoever reads the log."""
    if category.__module__.startswith("unshade."):
        _warn(str(message))
    else:
        print(f"{category.__name__}: {message}", file=sys.stderr)


def _send(event: str, **fields: Any) -> None:
    print(json.dumps({"event": event, **fields}), flush=True)


def _leave_with_parent() -> None:
    """Ends this process at once when the parent closes our standard input or dies."""
    while os.read(0, 4096):
        pass
    os._exit(_INTERRUPTED)


if __name__ == "__main__":
    sys.exit(main())

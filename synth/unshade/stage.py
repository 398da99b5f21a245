"""The rendering stages as child processes: ``python -m unshade.stage VERB ...``.

Standard output carries JSON lines: ``progress``, ``warning``, and one ``result`` or
``error`` at the end. The exit code is 0 done, 2 bad input, 3 interrupted, 1 a fault of our
own (its traceback goes to standard error).
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import threading
import traceback
import warnings
from pathlib import Path
from typing import Any

from . import errors
from .errors import UnshadeError

_INTERRUPTED, _FAULT = 3, 1


def main(arguments: list[str] | None = None) -> int:
    options = _parser().parse_args(arguments)
    warnings.showwarning = _show_warning
    if options.watch_stdin:
        threading.Thread(target=_leave_with_parent, daemon=True).start()
    try:
        result = options.stage(options)
    except UnshadeError as error:
        _say("error", kind=_public_kind(error), message=" ".join(str(error).split()))
        return error.exit_code
    except KeyboardInterrupt:
        return _INTERRUPTED
    except Exception:
        traceback.print_exc()
        return _FAULT
    _say("result", **result)
    return 0


def _public_kind(error: UnshadeError) -> str:
    """The nearest class of `unshade.errors`, which is all that callers can catch."""
    return next(kind.__name__ for kind in type(error).__mro__ if hasattr(errors, kind.__name__))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m unshade.stage", description=__doc__)
    verbs = parser.add_subparsers(required=True, metavar="VERB")

    synth = verbs.add_parser("synth", help="render a scene into a capture")
    synth.add_argument("--scene", type=Path, required=True)
    synth.add_argument("--out", type=Path, required=True)
    synth.set_defaults(stage=_synth)

    relight = verbs.add_parser("relight", help="render recovered maps in a capture's lights")
    relight.add_argument("--capture", type=Path, required=True)
    relight.add_argument("--maps", type=Path, required=True)
    relight.add_argument("--out", type=Path, required=True)
    relight.add_argument("--scale", type=_scale, action="append", required=True, metavar="NAME=FACTOR")
    relight.add_argument("--seed-offset", type=int, default=0)
    relight.add_argument("--light", type=Path)
    relight.add_argument("--renderer", choices=("mitsuba", "cycles"), default="mitsuba")
    relight.set_defaults(stage=_relight)

    budget = verbs.add_parser("budget", help="attribute a relit view's error to each map")
    budget.add_argument("--capture", type=Path, required=True)
    budget.add_argument("--maps", type=Path, required=True)
    budget.add_argument("--out", type=Path, required=True)
    budget.add_argument("--factor", type=float, required=True)
    budget.add_argument("--light")
    budget.add_argument("--view")
    budget.set_defaults(stage=_budget)

    lights = verbs.add_parser("lights", help="write the other lights of a capture as lat-long pictures")
    lights.add_argument("--capture", type=Path, required=True)
    lights.add_argument("--out", type=Path, required=True)
    lights.set_defaults(stage=_lights)

    export = verbs.add_parser("export", help="write maps as an asset of another program")
    export.add_argument("--maps", type=Path, required=True)
    export.add_argument("--out", type=Path, required=True)
    export.add_argument("--format", required=True)
    export.add_argument("--capture", type=Path)
    export.add_argument("--mesh", type=Path)
    export.add_argument("--bits", type=int, choices=(8, 16), default=16)
    export.add_argument("--normal-y", choices=("plus", "minus"), default="plus")
    export.add_argument("--no-fidelity", action="store_true")
    export.set_defaults(stage=_export)

    lpips = verbs.add_parser("lpips", help="compute LPIPS of pictures")
    lpips.add_argument("--net", required=True)
    lpips.add_argument("--pictures", type=Path, required=True)
    lpips.set_defaults(stage=_lpips)

    metrics = verbs.add_parser("metrics", help="call a user's metrics")
    metrics.add_argument("--request", type=Path, required=True)
    metrics.set_defaults(stage=_metrics)

    figure = verbs.add_parser("figure", help="draw a figure that was gathered from runs")
    figure.add_argument("--folder", type=Path, required=True)
    figure.set_defaults(stage=_figure)

    method = verbs.add_parser("method", help="recover maps by a built-in method")
    method.add_argument("--name", required=True)
    method.add_argument("--capture", type=Path, required=True)
    method.add_argument("--out", type=Path, required=True)
    method.add_argument("--settings", type=json.loads, default={})
    method.set_defaults(stage=_method)

    cluster = verbs.add_parser("cluster", help="run the stages of a suite on a Dask cluster")
    cluster.add_argument("--order", type=Path, required=True)
    cluster.add_argument("--address", required=True)
    cluster.add_argument("--store", required=True)
    cluster.add_argument("--workers", type=int, default=1)
    cluster.set_defaults(stage=_cluster)

    check = verbs.add_parser("check", help="read a scene and render nothing")
    check.add_argument("--scene", type=Path, required=True)
    check.set_defaults(stage=_check)

    describe = verbs.add_parser("describe", help="describe a scene")
    describe.add_argument("--scene", type=Path, required=True)
    describe.set_defaults(stage=_describe)

    sheet = verbs.add_parser("contact-sheet", help="render sampled identities into one picture")
    sheet.add_argument("--count", type=int, required=True)
    sheet.add_argument("--seed", type=int, required=True)
    sheet.add_argument("--out", type=Path, required=True)
    sheet.set_defaults(stage=_contact_sheet)

    history = verbs.add_parser("history", help="draw the history of a suite's scores")
    history.add_argument("--history", type=Path, required=True)
    history.add_argument("--out", type=Path, required=True)
    history.set_defaults(stage=_history)

    doctor = verbs.add_parser("doctor", help="say what rendering finds on this machine")
    doctor.set_defaults(stage=_doctor)
    physics = verbs.add_parser("physics", help="check the renderer against physics")
    physics.set_defaults(stage=_physics)
    for verb in (
        synth,
        relight,
        budget,
        lights,
        export,
        lpips,
        metrics,
        figure,
        method,
        cluster,
        check,
        describe,
        sheet,
        history,
        doctor,
        physics,
    ):
        verb.add_argument("--watch-stdin", action="store_true", help="leave when standard input ends")
    return parser


def _scale(text: str) -> tuple[str, float]:
    name, _, factor = text.partition("=")
    try:
        value = float(factor)
    except ValueError:
        value = float("nan")
    if not name.isidentifier() or not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text!r} is not NAME=FACTOR with a positive factor")
    return name, value


def _synth(options: argparse.Namespace) -> dict[str, Any]:
    from .render import llvm
    from .scene_file import read_scene

    scene = read_scene(options.scene)
    choice = _activate(llvm.choose(scene.render.variant))
    from .render.capture import synthesise

    synthesise(scene, options.out, choice, _progress)
    return {"capture": str(options.out), "variant": choice.variant}


def _relight(options: argparse.Namespace) -> dict[str, Any]:
    from .render import llvm

    if not (options.capture / "truth").is_dir() and (options.capture / "transforms.json").is_file():
        return _relight_photographed(options)
    from .render.truth_scene import captured_scene

    scene = captured_scene(options.capture)
    choice = _activate(llvm.choose(scene.versions["variant"]))
    if options.renderer == "cycles":
        from .cycles.relight import relight
    else:
        from .render.relight import relight

    relight(
        scene, options.maps, options.out, given=_given_light(options),
        scales=dict(options.scale), seed_offset=options.seed_offset, progress=_progress, warn=_warn,
    )  # fmt: skip
    return {"relit": str(options.out), "variant": choice.variant}


def _given_light(options: argparse.Namespace):
    from .render.given_light import given_light

    return given_light(options.light) if options.light else None


def _budget(options: argparse.Namespace) -> dict[str, Any]:
    from .render import llvm
    from .render.truth_scene import captured_scene

    scene = captured_scene(options.capture)
    _activate(llvm.choose(scene.versions["variant"]))
    from .render.error_budget import write_budget

    chosen = {"light": options.light, "view": options.view, "factor": options.factor}
    return write_budget(scene, options.capture, options.maps, options.out, **chosen, progress=_progress, warn=_warn)


def _lights(options: argparse.Namespace) -> dict[str, Any]:
    from .render import llvm
    from .render.truth_scene import captured_scene

    scene = captured_scene(options.capture)
    _activate(llvm.choose(scene.versions["variant"]))
    from .render.handed_lights import write_lights

    return {"lights": write_lights(scene, options.out)}


def _export(options: argparse.Namespace) -> dict[str, Any]:
    from .render import llvm

    _activate(llvm.choose())
    from .exporting.assets import Options, export

    chosen = Options(options.format, options.bits, options.normal_y == "plus", not options.no_fidelity)
    rows, lines = export(options.maps, options.out, options.capture, options.mesh, chosen, _progress, _warn)
    return {"asset": str(options.out), "fidelity": rows, "lines": lines}


def _lpips(options: argparse.Namespace) -> dict[str, Any]:
    from .perceptual import judge

    return {"values": judge(options.net, json.loads(options.pictures.read_text()))}


def _metrics(options: argparse.Namespace) -> dict[str, Any]:
    from .own_metrics import answer

    return answer(json.loads(options.request.read_text()))


def _figure(options: argparse.Namespace) -> dict[str, Any]:
    from .figures.draw import draw

    return {"files": [str(path) for path in draw(options.folder)]}


def _relight_photographed(options: argparse.Namespace) -> dict[str, Any]:
    from .render import llvm

    choice = _activate(llvm.choose("auto"))
    from .render.photographed import relight_photographed

    relight_photographed(
        options.capture, options.maps, options.out, given=_given_light(options),
        scales=dict(options.scale), seed_offset=options.seed_offset, progress=_progress, warn=_warn,
    )  # fmt: skip
    return {"relit": str(options.out), "variant": choice.variant}


def _method(options: argparse.Namespace) -> dict[str, Any]:
    import unshade

    from .methods import CONTROLLED, method
    from .render import llvm

    # A capture without a truth, which passive methods get, was rendered by nobody knows what.
    controlled = options.name in CONTROLLED
    from .render.truth_scene import captured_scene

    scene = captured_scene(options.capture) if controlled else None
    _activate(llvm.choose(scene.versions["variant"] if scene else "auto"))
    # Their modules name the renderer's classes, which need a variant.
    recover = method(options.name, options.settings)
    given: list[Any] = [unshade.Capture(options.capture)]
    if scene is not None:
        from .methods.laboratory import Laboratory

        given.append(Laboratory(scene, _progress))
    recovered = recover(*given, **options.settings)
    maps, light = recovered if isinstance(recovered, tuple) else (recovered, None)
    maps.write(options.out, light=light)
    return {"maps": str(options.out)}


def _cluster(options: argparse.Namespace) -> dict[str, Any]:
    from .cluster.command import on_cluster

    return on_cluster(options.order, options.address, options.store, options.workers, _progress)


def _check(options: argparse.Namespace) -> dict[str, Any]:
    from .scene_file import read_scene

    return {"name": read_scene(options.scene).name}


def _describe(options: argparse.Namespace) -> dict[str, Any]:
    from .render import llvm
    from .scene_file import read_scene

    scene = read_scene(options.scene)
    _activate(llvm.choose(scene.render.variant))
    from .render.describe import describe

    return {"text": describe(scene)}


def _contact_sheet(options: argparse.Namespace) -> dict[str, Any]:
    from .render import llvm

    _activate(llvm.choose())
    from .render.contact_sheet import contact_sheet

    contact_sheet(options.count, options.out, options.seed, _progress)
    return {"picture": str(options.out)}


def _history(options: argparse.Namespace) -> dict[str, Any]:
    from .history_chart import write

    return {"steps": write(options.history, options.out)}


def _physics(options: argparse.Namespace) -> dict[str, Any]:
    from .render import llvm

    _activate(llvm.choose())
    from .render.physics import examine

    return {"checks": examine(_progress)}


def _doctor(options: argparse.Namespace) -> dict[str, Any]:
    from .render.doctor import examine

    return {"checks": examine()}


def _activate(choice):
    from .render import llvm

    if choice.warning:
        _warn(choice.warning)
    llvm.activate(choice)
    return choice


def _progress(done: int, total: int, what: str) -> None:
    _say("progress", done=done, total=total, what=what)


def _warn(message: str) -> None:
    _say("warning", message=message)


def _show_warning(message: Warning | str, category: type[Warning], *place: Any, **more: Any) -> None:
    """Warnings of ours are for the user; those of libraries for whoever reads the log."""
    if category.__module__.startswith("unshade."):
        _warn(str(message))
    else:
        print(f"{category.__name__}: {message}", file=sys.stderr)


def _say(event: str, **fields: Any) -> None:
    print(json.dumps({"event": event, **fields}), flush=True)


def _leave_with_parent() -> None:
    """Ends this process at once when the parent closes our standard input or dies."""
    while os.read(0, 4096):
        pass
    os._exit(_INTERRUPTED)


if __name__ == "__main__":
    sys.exit(main())

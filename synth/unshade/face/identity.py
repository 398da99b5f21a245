"""The shape of one identity: a seeded blend of morph targets."""

from __future__ import annotations

import itertools

import numpy as np

from .expression import target
from .geometry import Pose
from .head import ETHNIC, JAW, LOCAL_FOLDERS, Head
from .spec import FaceSpec, stream

_LOCAL_SD = 0.28
"""Standard deviation of a local shape parameter; from 0.45 on faces turn into caricatures."""

_ASYMMETRY_SD = 0.10

_JAW = -0.05
"""Closes the lips, which the neutral head holds slightly apart."""

_BLINKS = ("eyeBlinkLeft", "eyeBlinkRight")

# Local parameters that distort sooner than the rest, and the factor that tames each.
_DAMPED = (
    ("head/head-age", 0.0),  # age has its own macro targets
    ("head/", 0.35),
    ("forehead/", 0.35),
    ("ears/", 0.6),
    ("eyes/l-eye-epicanthus", 0.5),
    ("eyes/l-eye-push", 0.4),
    ("eyes/l-eye-height", 0.7),
    ("mouth/mouth-scale-depth", 0.5),
)


def macro_weights(spec: FaceSpec) -> dict[str, float]:
    """Weights of the macro targets: ethnicity x gender x age, and gender x age x muscle x weight."""
    muscle = stream(spec.seed, "muscle").uniform(0.3, 0.7)
    genders = {"female": 1 - spec.gender, "male": spec.gender}
    ages = {"young": 1 - spec.age, "old": spec.age}
    weights = {}
    for (gender, g), (age, a) in itertools.product(genders.items(), ages.items()):
        for ethnicity, e in zip(ETHNIC, spec.ethnicity):
            weights[f"macrodetails/{ethnicity}-{gender}-{age}"] = g * a * e
        for (m_name, m), (w_name, w) in itertools.product(_three(muscle).items(), _three(spec.weight).items()):
            weights[f"macrodetails/universal-{gender}-{age}-{m_name}muscle-{w_name}weight"] = g * a * m * w
    return weights


def _three(value: float) -> dict[str, float]:
    """Piecewise-linear shares of the stops min, average and max at 0, 0.5 and 1."""
    side = abs(2 * value - 1)
    return {"average": 1 - side, "min" if value < 0.5 else "max": side}


def local_weights(names: list[str], seed: int) -> dict[str, float]:
    """Weights of the local targets, symmetric, and of the slight asymmetry.

    Targets come as opposite pairs (`nose-hump-decr`, `nose-hump-incr`), of which the
    sign picks one, or as groups of alternatives (`head-oval`, `head-round`), of which
    one is drawn. Each parameter draws from its own stream.
    """
    groups: dict[str, list[str]] = {}
    for name in names:
        folder, short = name.split("/")
        # Left and right share one parameter.
        if folder not in LOCAL_FOLDERS or short.startswith("r-"):
            continue
        groups.setdefault(f"{folder}/{short.rsplit('-', 1)[0]}", []).append(name)
    weights = {}
    for stem, options in groups.items():
        rng = stream(seed, "local", stem)
        value = min(max(rng.normal(0.0, _LOCAL_SD), -1.0), 1.0)
        option = options[int(value > 0)] if len(options) == 2 else options[rng.integers(len(options))]
        value = abs(value) * next((factor for prefix, factor in _DAMPED if option.startswith(prefix)), 1.0)
        weights[option] = value
        if "/l-" in option:
            weights[option.replace("/l-", "/r-")] = value
    for name in names:
        if name.startswith("asym/"):
            weights[name] = abs(stream(seed, name).normal(0.0, _ASYMMETRY_SD))
    return weights


def identity_weights(head: Head, spec: FaceSpec) -> dict[str, float]:
    """Weights of all targets of the neutral face."""
    return macro_weights(spec) | local_weights(list(head.target_names), spec.seed) | {JAW: _JAW}


def shape(head: Head, spec: FaceSpec) -> np.ndarray:
    """Base positions (B,3) in metres of the identity without expression, in the coordinates of the head data."""
    return head.morph(identity_weights(head, spec))


def pose(head: Head, spec: FaceSpec) -> Pose | None:
    """The expression of the specification; none for the neutral face."""
    if not spec.expression:
        return None
    units = dict(spec.expression)
    blink = np.array([units.pop(unit, 0.0) for unit in _BLINKS])
    weights = identity_weights(head, spec)
    for unit, weight in units.items():
        weights[target(unit)] = weights.get(target(unit), 0.0) + weight
    return Pose(head.morph(weights), blink, np.stack([head.morph({target(unit): 1.0}) - head.base for unit in _BLINKS]))

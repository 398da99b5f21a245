"""In even white light, what comes back is what the model reflects: no energy made or lost.

Two furnaces. One patch: its directional albedo, estimated by the material's own samples,
against quadrature of the stated model. And a picture: a convex ball in a uniform dome,
whose radiance at every pixel is the albedo at that pixel's angle. The lobes add to the
Lambert term without coupling, so a near-white skin reflects more than it gets at grazing
angles; `EXCESS` states by how much. Skin as it is (rho_d to 0.7, rho_s to 0.05, standard
roughness) stays below 1 at all angles.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import product

import drjit as dr
import mitsuba as mi
import numpy as np

from ...vectors import unit
from ..lights import Dome
from ..passes import render_layers
from ..scene import ChartMaps, HeadScene
from . import reference, specimen
from .material import NORMALS, PARTS, ROUGHNESS, Alter, Skin, context, direction, interaction, unaltered, vectors
from .verdict import Verdict

EXCESS = {None: 0.05, "standard": 0.05, "wet": 0.40, "oily": 0.22, "dry": 0.0}
"""How far above 1 the albedo of a near-white skin (rho_d 0.8, rho_s 0.05) rises, at 88 degrees."""

SINGLE, POOLED, PICTURE = 0.003, 0.001, 0.003
"""Relative tolerances: of one albedo beside 4.5 standard errors (0.2 % of false alarms over
all), of their mean (10 standard errors), and of the picture's mean. A gain of 1 % fails
the latter two for certain."""

_ANGLES = (1, 45, 70, 85)
_GRAZING = 88


def check_furnace(
    samples: int = 1 << 18,
    normals: Iterable[str] = tuple(NORMALS),
    alter: Alter = unaltered,
    render: Callable = render_layers,
) -> Verdict:
    """Heats both furnaces. ``alter`` replaces the material of the patch, ``render`` the ball's renderer."""
    errors, noise, where = [], [], []
    for tilt, roughness in product(normals, (None, *ROUGHNESS)):
        skin = Skin(tilt, roughness)
        bsdf = alter(skin.bsdf())
        for part, angle in product(PARTS, _ANGLES):
            expected = reference.albedo(skin, direction(angle, 20), part)
            got, error = _sampled_albedo(bsdf, part, angle, samples, len(errors))
            # A lobe whose normal faces away reflects nothing at all.
            errors.append(got / expected - 1 if expected else got)
            noise.append(error / expected if expected else 0.0)
            where.append(f"{tilt}, {roughness or 'standard'}, {part}, {angle} degrees")
    worst = int(np.abs(errors).argmax())
    pooled = float(np.mean(errors))

    def brightest(diffuse: float, roughness: str | None) -> float:
        bsdf = alter(Skin("mesh", roughness, diffuse, 0.05).bsdf())
        return max(_sampled_albedo(bsdf, "all", angle, samples, 1)[0] for angle in (*_ANGLES, _GRAZING))

    excess = {name: brightest(0.8, name) - 1 for name in EXCESS}
    skin_brightest = brightest(0.7, None)
    picture = _picture_error(render)
    ok = (
        all(abs(e) < SINGLE + 4.5 * n for e, n in zip(errors, noise))
        and abs(pooled) < POOLED
        and all(excess[name] < EXCESS[name] + 0.01 for name in EXCESS)
        and skin_brightest < 1
        and abs(picture) < PICTURE
    )
    found = (
        f"{len(errors)} albedos within {100 * abs(errors[worst]):.2f} % of quadrature (worst at {where[worst]}), {100 * pooled:+.3f} % "
        f"in the mean; ball in a dome {100 * picture:+.2f} %; skin reflects {skin_brightest:.3f} at most, near-white skin {1 + max(excess.values()):.2f}"
    )
    return Verdict(
        "furnace", ok, found, "render/skin_bsdf.py (patch) or render/split.py and passes.py (ball): energy is not kept"
    )


def _sampled_albedo(bsdf, part: str, angle: float, samples: int, seed: int) -> tuple[float, float]:
    """Directional albedo as the material's own samples have it, and its standard error."""
    sampler = mi.load_dict({"type": "independent"})
    # The seed is opaque, so that equal materials share a compiled kernel.
    sampler.seed(dr.opaque(mi.UInt32, seed), samples)
    si = interaction(vectors(direction(angle, 20)), samples)
    _, weight = bsdf.sample(context(part), si, sampler.next_1d(), sampler.next_2d())
    weight = np.array(weight.x, float)
    return float(weight.mean()), float(weight.std() / np.sqrt(samples))


def _picture_error(render: Callable) -> float:
    """Relative error of the mean radiance of the ball, up to 70 degrees."""
    skin = Skin("mesh", "dry", 0.6, 0.05)
    grey = ChartMaps(
        np.full((2, 2, 3), skin.diffuse, np.float32), np.full((2, 2), skin.specular, np.float32),
        roughness=np.broadcast_to(np.float32(ROUGHNESS["dry"]), (2, 2, 3)),
    )  # fmt: skip
    camera = specimen.camera(48, 40)
    lit = HeadScene(specimen.ball(), [], grey).lit(Dome())
    layers = render(lit, camera.sensor(64), samples=64, depth=2, seed=1)
    cosine = _cosines(camera)
    table = np.linspace(0, 75, 16)
    albedo = [reference.albedo(skin, direction(angle, 20)) for angle in table]
    inner = (cosine > np.cos(np.radians(70))).all(-1)
    expected = np.interp(np.degrees(np.arccos(cosine[inner])), table, albedo).mean(-1)
    return float(layers.total[inner].mean() / expected.mean() - 1)


def _cosines(camera, fine: int = 3) -> np.ndarray:
    """Cosines [H, W, fine^2] between view and the ball's normal, 0 beside it."""
    steps = (np.arange(fine) + 0.5) / fine
    column, row, dx, dy = np.meshgrid(np.arange(camera.width), np.arange(camera.height), steps, steps, indexing="xy")
    x, y = column + dx - camera.width / 2, camera.height / 2 - row - dy
    d = np.stack([x, y, np.full_like(x, -camera.focal)], -1)
    d = unit(d) @ camera.matrix[:3, :3].T
    along = d @ camera.position
    inside = along**2 - camera.position @ camera.position + specimen.RADIUS**2
    distance = -along - np.sqrt(inside.clip(0))
    normal = (camera.position + distance[..., None] * d) / specimen.RADIUS
    return np.where(inside > 0, -(normal * d).sum(-1), 0).reshape(camera.height, camera.width, -1)

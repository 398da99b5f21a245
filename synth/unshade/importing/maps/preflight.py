"""Trials of the open questions and the claims of a statement: which encoding makes plausible maps of a face.

The witnesses are the capture's: its photographs, projected into the chart, for the albedo's pattern and curve; its
mesh for normals; skin's ranges for highlights. A relief has no curl, which distinguishes green up from green down.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_erosion, gaussian_filter

from ...errors import MapsError
from . import decoding
from .counterpart import Counterparts, Layout
from .statement import AUTO, Statement, Texture
from .texture import Codes, Floats, padded, sampled

_SIGMAS = (2.0, 6.0)
"""Widths (texels of the trial) of what is taken away from a pattern, so that shading, slow, does not count."""

_DECIDES, _CONTRADICTS = 0.04, 0.15
"""By how much a correlation must be better to decide, and to contradict what is stated."""

_REDNESS, _FACTOR = (0.75, 1.75), (0.55, 2.0)
"""Right albedos beside the projected photographs, in lights from one softbox to a uniform sphere: ln(red / blue) over
theirs, brightness over theirs."""

_SKIN_F0 = (0.008, 0.07)
_SKIN_ALPHA = (0.12, 0.6)
"""Medians of skin: reflectance at normal incidence, GGX alpha of one lobe."""


@dataclass(frozen=True)
class Witness:
    """A capture in a small texture (N,N): ``texture`` its projected photographs, ``seen`` where, ``normals`` its mesh's
    (M,3) at the M texels of its chart; ``turn`` (3,3) from the other mesh's own axes to the capture's."""

    texture: Floats
    seen: NDArray[np.bool_]
    normals: NDArray[np.float32]
    turn: NDArray[np.float64]


@dataclass(frozen=True)
class Trial:
    """One question: what was ``stated``, what was ``taken``, the ``evidence`` by candidate, and in words how it came to
    be: ``stated``, ``found``, ``assumed`` or ``applied``."""

    key: str
    stated: str
    taken: str
    how: str
    evidence: dict[str, float]


class Preflight:
    """Settles a statement against a capture. ``apply`` takes what fits better than what is stated; without it that is
    the error, `MapsError`."""

    def __init__(
        self, statement: Statement, codes: dict[str, Codes], layouts: dict[str, Layout], counterparts: Counterparts,
        witness: Witness, *, apply: bool,
    ) -> None:  # fmt: skip
        self.statement, self.trials = statement, list[Trial]()
        self._codes, self._layouts, self._counterparts = codes, layouts, counterparts
        self._witness, self._apply = witness, apply

    def settle(self) -> Statement:
        """The statement with nothing left open."""
        self._first_row()
        if "diffuse_albedo" in self._codes:
            self._curve()
        for name in ("normal", "diffuse_normal", "specular_normal"):
            if name in self._codes:
                self._normals(name)
        self._range("specular_albedo", ("reflectance", "level", "share", "ior"), decoding.reflectance, _SKIN_F0)
        self._lobes()
        self._range("roughness", ("perceptual", "alpha", "gloss", "alpha-squared"), decoding.alpha, _SKIN_ALPHA)
        return self.statement

    def _looked_up(self, values: Floats, v: str) -> Floats:
        layout = self._layouts[v]
        chart = layout.chart(len(values))
        return sampled(padded(values, chart), self._counterparts.at(layout.uv, layout.mesh.triangles))

    def _image(self, values: Floats) -> Floats:
        return self._counterparts.texels.image(np.asarray(values, np.float32))

    def _settled(
        self,
        key: str,
        stated: str,
        evidence: dict[str, float],
        *,
        decides: float,
        contradicts: float,
        default: str = "",
    ) -> str:
        """The best candidate, unless what is stated is about as good; closer than ``decides`` it is the
        default, if there is one."""
        best = max(evidence, key=lambda name: evidence[name])
        rest = max((value for name, value in evidence.items() if name != best), default=-np.inf)
        if stated == AUTO:
            sure = evidence[best] - rest >= decides
            taken, how = (best, "found") if sure else (default or best, "assumed")
        elif self.statement.certain or evidence[best] - evidence.get(stated, -np.inf) < contradicts:
            taken, how = stated, "stated"
        elif self._apply:
            taken, how = best, "applied"
        else:
            shown = ", ".join(f"{name} {value:.3g}" for name, value in evidence.items())
            map_name = key.partition(".")[0]
            file = self._codes[map_name if map_name in self._codes else "diffuse_albedo"].path
            raise MapsError(
                f"{file}: {self.statement.stated_by(key)} says {key} = {stated}, but {best} fits ({shown}); "
                f"state {key} = {best}, or import with apply"
            )
        self.trials.append(Trial(key, stated, taken, how, {name: round(float(v), 4) for name, v in evidence.items()}))
        return taken

    def _first_row(self) -> None:
        """Row 0 at v = 1 or at v = 0: which pattern is that of the photographs."""
        stated = self.statement.v
        evidence = {}
        if "diffuse_albedo" in self._codes:
            values = self._codes["diffuse_albedo"].values
            for v in ("up", "down"):
                ours, theirs, mask = self._patterns(self._looked_up(values, v))
                evidence[v] = float(np.mean([_correlation(a[mask], b[mask]) for a, b in zip(ours, theirs)]))
        if not evidence:
            v = "up" if stated == AUTO else stated
            self.trials.append(Trial("v", stated, v, "assumed" if stated == AUTO else "stated", {}))
        else:
            v = self._settled("v", stated, evidence, decides=_DECIDES, contradicts=_CONTRADICTS, default="up")
        self.statement = replace(self.statement, v=v)

    def _patterns(self, values: Floats) -> tuple[list[Floats], list[Floats], NDArray[np.bool_]]:
        """Logarithms without what is slow of the map and of the photographs: luminance and red over blue, two widths."""
        picture, mask = self._image(values), self._lit()
        planes = []
        for colours in (picture, self._witness.texture):
            log = np.log(np.maximum(colours, 1e-3 * np.median(colours[mask]) + 1e-9))
            planes.append([_fast(p, mask, s) for s in _SIGMAS for p in (log.mean(-1), log[..., 0] - log[..., 2])])
        return planes[0], planes[1], mask

    def _curve(self) -> None:
        """Linear or encoded: a curve of 1 / 2.2 halves the logarithms of ratios of colours, and brightens."""
        codes, stated = self._codes["diffuse_albedo"], self.statement.maps["diffuse_albedo"]
        default = decoding.curve_of(stated, colour=True, exact=codes.exact)
        looked_up = self._looked_up(codes.values, self.statement.v)
        evidence = {}
        for curve in dict.fromkeys(("linear", "srgb", default)):
            redness, factor = self._beside_photographs(decoding.linear(looked_up, curve) * np.float32(stated.scale))
            evidence[curve] = -_excess(redness, _REDNESS) - _excess(factor, _FACTOR)
        curve = self._settled(
            "diffuse_albedo.curve", stated.curve, evidence, decides=0.15, contradicts=0.4, default=default
        )
        self.statement = self.statement.with_map("diffuse_albedo", curve=curve)

    def _beside_photographs(self, values: Floats) -> tuple[float, float]:
        """The map's ln(red / blue) over that of the photographs, and its brightness over theirs, where they are lit."""
        picture, mask = self._image(values), self._lit()
        ours, theirs = picture[mask].astype(np.float64) + 1e-6, self._witness.texture[mask].astype(np.float64) + 1e-6
        red, photographed = (float(np.median(np.log(c[:, 0] / c[:, 2].clip(1e-6)))) for c in (ours, theirs))
        # Photographs without colour are uninformative here.
        redness = max(red, 1e-3) / photographed if photographed > 0.1 else 1.0
        return redness, float(np.median(ours.mean(-1) / theirs.mean(-1)))

    def _lit(self) -> NDArray[np.bool_]:
        """Texels with a counterpart that photographs show, and not in the dark."""
        mask = self._witness.seen & self._image(self._counterparts.found).astype(bool)
        bright = self._witness.texture.mean(-1)
        return mask & (bright > 0.1 * np.quantile(bright[mask], 0.9)) if mask.any() else mask

    def _normals(self, name: str) -> None:
        """Object or tangent space: which lies nearer to the mesh. Green up or down: which relief has no curl."""
        codes, stated = self._codes[name], self.statement.maps[name]
        values = decoding.vectors(codes)
        layout = self._layouts[self.statement.v]
        at = self._looked_up(values, self.statement.v)
        found = self._counterparts.found
        evidence = {}
        for kind in ("object", "tangent"):
            normals = decoding.normals(at, kind, "up", layout, self._counterparts, self._witness.turn)
            evidence[kind] = float(np.nanmean((normals * self._witness.normals).sum(1)[found]))
        kind = self._settled(
            f"{name}.as",
            stated.kind,
            evidence,
            decides=0.02,
            contradicts=0.1,
            default="object" if codes.exact else "tangent",
        )
        green = stated.green
        if kind == "tangent":
            curl = curl_sign(values, layout.chart(codes.size).inside)
            evidence = {"up": curl, "down": -curl}
            green = self._settled(f"{name}.green", green, evidence, decides=0.1, contradicts=0.4, default="up")
        self.statement = self.statement.with_map(name, kind=kind, green=green)

    def _lobes(self) -> None:
        """An EXR with alpha1, alpha2, share1 is a map of lobes by its channels."""
        codes, stated = self._codes.get("roughness"), self.statement.maps.get("roughness", Texture()).kind
        if codes is None or codes.lobes == (stated == "lobes"):
            return
        if stated != AUTO:
            held = "alpha1, alpha2, share1" if codes.lobes else "other channels than alpha1, alpha2, share1"
            by = self.statement.stated_by("roughness.as")
            raise MapsError(f"{codes.path}: holds {held}, but {by} says roughness.as = {stated}; state what it holds")
        self.statement = self.statement.with_map("roughness", kind="lobes")

    def _range(
        self, name: str, kinds: tuple[str, ...], decoded: Callable[[Floats, str], Floats], skin: tuple[float, float]
    ) -> None:
        """The kind whose median lies in the range of skin, the first of several; the stated kind, unless only another one fits."""
        stated = self.statement.maps.get(name, Texture())
        if name not in self._codes or stated.kind in ("metalness", "lobes"):
            return
        values = self._looked_up(decoding.scalar(self._codes[name], stated), self.statement.v)
        middle = np.float32(np.median(values[self._counterparts.found]))
        low, high = skin
        evidence = {}
        for place, kind in enumerate(kinds):
            # No index of refraction is below 1, but what it would mean is a reflectance.
            value = 0.0 if kind == "ior" and middle < 1 else float(decoded(middle, kind))
            # How far it is outside of skin's, in factors.
            evidence[kind] = -float(np.log(max(low / max(value, 1e-6), value / high, 1.0))) - 0.01 * place
        kind = self._settled(f"{name}.as", stated.kind, evidence, decides=0.1, contradicts=0.4)
        self.statement = self.statement.with_map(name, kind=kind)


def curl_sign(normals: Floats, inside: NDArray[np.bool_]) -> float:
    """Correlation, -1 to 1, of d nx / dy and d ny / dx of tangent-space normals (N,N,3), y up the picture: above 0
    where green points up. A relief's slopes are a gradient, and a gradient has no curl."""
    z = np.maximum(np.abs(normals[..., 2]), 0.1)
    across, up = (gaussian_filter(normals[..., axis] / z, 1.0) for axis in range(2))
    dy = -np.gradient(across, axis=0)
    dx = np.gradient(up, axis=1)
    mask = binary_erosion(inside, iterations=4)
    return _correlation(dy[mask], dx[mask]) if mask.sum() > 50 else 0.0


def _fast(plane: Floats, mask: NDArray[np.bool_], sigma: float) -> Floats:
    """A plane without what a Gaussian of ``sigma`` texels keeps of it inside the mask."""
    weight = gaussian_filter(mask.astype(np.float64), sigma)
    mean = gaussian_filter(np.where(mask, plane, 0.0).astype(np.float64), sigma) / np.maximum(weight, 1e-6)
    return np.asarray(np.where(mask, plane - mean, 0.0), np.float32)


def _correlation(a: Floats, b: Floats) -> float:
    if len(a) < 10:
        return 0.0
    a, b = a - a.mean(), b - b.mean()
    scale = float(np.sqrt((a * a).sum() * (b * b).sum()))
    return float((a * b).sum()) / scale if scale > 1e-12 else 0.0


def _excess(value: float, usual: tuple[float, float]) -> float:
    """How far a ratio is outside of what is usual, in logarithms; a little of how far it is from the middle of it."""
    low, high = np.log(usual)
    log = float(np.log(max(value, 1e-6)))
    return max(low - log, log - high, 0.0) + 0.25 * abs(log - (low + high) / 2)

"""The `[face]` table of a scene as checked data."""

from __future__ import annotations

import dataclasses
import difflib
import math
import zlib
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..errors import SceneError
from ..tables import Table
from .expression import UNITS, Expression

YOUNGEST, OLDEST = 20.0, 70.0
"""Years at `age` 0 and 1."""

FITZPATRICK = ("I", "II", "III", "IV", "V", "VI")
ETHNICITIES = ("african", "asian", "caucasian")

DETAILS = ("smooth", "natural")
"""How much a face shows: even skin and painted hair, or what photographed faces have (`natural`)."""


CHARTS = ("face", "wide")
"""How far the chart reaches: the face to behind the ears, or head, neck and shoulders, as scans have them."""

_SCALES = ("specular_scale", "roughness_scale")


class FaceError(SceneError):
    """A face that cannot be built."""


def stream(seed: int, *names: str) -> np.random.Generator:
    """Independent generator for one purpose of one face.

    Every purpose has its own stream, so fixing one field (or painting one more
    layer) leaves all other draws of the same seed as they were.
    """
    return np.random.default_rng([seed, *(zlib.crc32(name.encode()) for name in names)])


@dataclasses.dataclass(frozen=True)
class FaceSpec:
    """One identity, complete: nothing is left to be drawn but shape and paint details.

    `gender` runs from 0 (female) to 1 (male), `age` from 0 (20 years) to 1 (70 years, see
    `years`), `weight` from 0 (thin) to 1 (heavy); `ethnicity` holds the shares (african,
    asian, caucasian) of the shape and sums to 1; `fitzpatrick` is the skin type I to VI,
    independent of the shape; `texture_size` is the side of the truth maps in texels;
    `expression` is what the face does, nothing by default: it moves the surface and leaves
    the identity, the chart's UV and the colours alone; `detail` one of `DETAILS`: the same person
    with even or with natural skin, hair and sheen; `specular_scale` and `roughness_scale` multiply
    the specular albedo (at most 0.05 in all) and the lobes' alphas on top of all that is painted; with
    `displacement` the relief is geometry too, which shadows itself, and solvers still get the smooth mesh; `chart` is
    one of `CHARTS`.
    """

    name: str
    seed: int
    fitzpatrick: str
    gender: float
    age: float
    ethnicity: tuple[float, float, float]
    weight: float
    texture_size: int = 512
    expression: Expression = ()
    detail: str = "smooth"
    specular_scale: float = 1.0
    roughness_scale: float = 1.0
    displacement: bool = False
    chart: str = "face"

    @property
    def years(self) -> float:
        """Age in years: linear from 20 to 70 over `age` 0 to 1."""
        return YOUNGEST + (OLDEST - YOUNGEST) * self.age

    @classmethod
    def sample(cls, seed: int, **fixed: Any) -> FaceSpec:
        """The identity of a seed: shares of ethnicity (Dirichlet 0.6), gender, age and weight,
        and a skin type that is independent of them; shape and asymmetry follow the same seed.

        `fixed` are fields as a `[face]` table writes them, in place of drawn ones.
        """
        return cls.from_table({"name": f"face{seed:04d}", "seed": seed} | fixed)

    @classmethod
    def from_table(cls, table: Mapping[str, Any], *, place: str = "[face]") -> FaceSpec:
        """Read a `[face]` table; absent fields are drawn from the seed.

        Raises `FaceError` naming the key and the fix.
        """
        read = Table(table, place, FaceError)
        read.require_known([field.name for field in dataclasses.fields(cls)])
        name, seed = read.text("name"), read.whole("seed", 0, 2**63 - 1)

        def fraction(key: str, draw: Any) -> float:
            return read.number(key, 0.0, 1.0) if key in read else float(draw(stream(seed, key)))

        drawn = str(stream(seed, "fitzpatrick").choice(FITZPATRICK))
        return cls(
            name=name,
            seed=seed,
            fitzpatrick=read.choice("fitzpatrick", FITZPATRICK, drawn),
            gender=fraction("gender", lambda rng: rng.uniform()),
            age=fraction("age", lambda rng: rng.beta(1.0, 1.3)),
            ethnicity=_ethnicity(read, seed),
            weight=fraction("weight", lambda rng: np.clip(rng.normal(0.5, 0.18), 0.1, 0.95)),
            texture_size=read.whole("texture_size", 64, 8192, cls.texture_size),
            expression=_expression(read),
            detail=read.choice("detail", DETAILS, cls.detail),
            chart=read.choice("chart", CHARTS, cls.chart),
            displacement=read.flag("displacement"),
            **{key: read.number(key, 0.25, 4.0) for key in _SCALES if key in read},
        )

    def to_table(self) -> dict[str, Any]:
        """The complete table: `from_table(spec.to_table()) == spec`."""
        table = dataclasses.asdict(self)
        table["ethnicity"] = dict(zip(ETHNICITIES, self.ethnicity))
        table["expression"] = dict(self.expression)
        if not self.expression:
            del table["expression"]
        # A default is not written, so that scenes from before there was a choice stay as they were.
        for key in ("detail", "displacement", "chart", *_SCALES):
            if table[key] == getattr(type(self), key):
                del table[key]
        return table


def _expression(table: Table) -> Expression:
    units = table.values.get("expression", {})
    if not isinstance(units, Mapping):
        raise table.wrong("expression", "is not a table; use expression = { jawOpen = 0.2, mouthSmileLeft = 0.6 }")
    for unit in units:
        if unit not in UNITS:
            # Case and underscores are the usual slips.
            names = {name.lower(): name for name in UNITS}
            near = names[difflib.get_close_matches(str(unit).replace("_", "").lower(), names, 1, 0.0)[0]]
            raise FaceError(f"unknown key '{unit}' in expression of {table.place}; did you mean '{near}'?", key=unit)
    read = Table(units, f"expression of {table.place}", FaceError)
    weights = {unit: read.number(unit, 0.0, 1.0) for unit in sorted(units)}
    return tuple((unit, weight) for unit, weight in weights.items() if weight > 0)


def _ethnicity(table: Table, seed: int) -> tuple[float, float, float]:
    if "ethnicity" not in table:
        return tuple(map(float, stream(seed, "ethnicity").dirichlet([0.6] * 3)))
    fractions = table.values["ethnicity"]
    if not isinstance(fractions, Mapping):
        example = "ethnicity = { african = 0.2, asian = 0.3, caucasian = 0.5 }"
        raise table.wrong("ethnicity", f"is not a table; use {example}")
    read = Table(fractions, f"ethnicity of {table.place}", FaceError)
    for key in fractions:
        if key not in ETHNICITIES:
            raise FaceError(f"unknown key '{key}' in {read.place}; use {', '.join(ETHNICITIES)}", key=key)
    values = [read.number(key, 0.0, 1.0, 0.0) for key in ETHNICITIES]
    total = math.fsum(values)
    if abs(total - 1.0) > 1e-3:
        raise FaceError(f"ethnicity in {table.place} sums to {total:g}; make the shares sum to 1", key="ethnicity")
    # The identity of shares read back from a written table survives: they sum to 1 within rounding.
    return tuple(values) if abs(total - 1.0) < 1e-9 else tuple(v / total for v in values)

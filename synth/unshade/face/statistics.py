"""Statistics of a face's maps: spectra of log albedo and of relief, spread and contrast of regions.

Made to compare generated faces with scanned ones. Spectra are of windows laid over a region
(Welch's method with Hann windows; what lies outside the region has no weight), over cycles
per millimetre of the surface, which the mesh gives for every texel.
"""

from __future__ import annotations

import dataclasses

import numpy as np
from scipy.ndimage import binary_erosion

from ..srgb import encoded
from ..vectors import unit
from .geometry import Chart
from .normals import tangents
from .pigment import BLOOD, MELANOSOMES, exact_colour
from .texels import rasterise

BANDS = 2.0 ** np.arange(-5, 1)
"""Lower ends of the octaves, cycles per mm: wavelengths of 32 to 16 mm down to 1 to 0.5 mm."""

_WINDOWS_MM = (40.0, 24.0)
"""Sides of the windows: one for wavelengths over 4 mm, one for the rest."""

_FILLED = 0.6
"""Share of a window's weight that must lie in the region."""

_REC709 = np.array([0.2126, 0.7152, 0.0722])


@dataclasses.dataclass(frozen=True)
class Surface:
    """The texels of a chart on its surface (N,N,...), texel row 0 at v = 1; 0 outside the chart.

    `points` (N,N,3) world metres; `across`, `down` (N,N,3) millimetres of surface from a texel
    to the next one in its row and in its column; `normal` (N,N,3) of the smooth mesh; `inside` (N,N) bool.
    """

    points: np.ndarray
    across: np.ndarray
    down: np.ndarray
    normal: np.ndarray
    inside: np.ndarray

    @classmethod
    def of(cls, chart: Chart, size: int) -> Surface:
        """The surface of a chart whose maps have `size` texels along each edge."""
        triangles = chart.triangles.astype(np.int64)
        texels = rasterise(chart.uv, triangles, size)
        u, v = tangents(chart.vertices.astype(np.float64), chart.uv.astype(np.float64), triangles)
        points, across, down, normal = (
            texels.image(texels.sample(values))
            for values in (chart.vertices, 1e3 * u / size, -1e3 * v / size, chart.normals)
        )
        return cls(points, across, down, unit(normal), texels.inside)

    def front(self) -> np.ndarray:
        """The face's front (N,N) bool: what looks ahead between chin and hairline, ears and neck left out."""
        x, y, z = 1e3 * np.moveaxis(self.points, -1, 0)
        return self.inside & (np.abs(x) < 62) & (y > -95) & (y < 70) & (z > 20)


def log_colour(albedo: np.ndarray) -> np.ndarray:
    """Natural logarithm (...,3) of a linear albedo; nothing is darker than 0.002."""
    return np.log(np.maximum(albedo, 0.002))


def luminance(albedo: np.ndarray) -> np.ndarray:
    """Log (...) of the luminance of a linear Rec.709 albedo."""
    return np.log(np.maximum(albedo @ _REC709, 0.002))


def pigment_amounts(albedo: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Melanin and haemoglobin (...) of an albedo, each in units of the log luminance that it takes away.

    Log colours are split along the directions in which the two pigments move the colour of
    skin of type III, and along grey, which takes shading and hair (Tsumura et al. 1999, with the
    axes of `pigment` in place of independent components). Melanin moves the colour of dark skin almost
    along grey, where much of it then counts.
    """
    base, less = np.array([MELANOSOMES["III"], BLOOD["III"]]), []
    for more in (np.array([1.02, 1.0]), np.array([1.0, 1.02])):
        before, after = (exact_colour(*amounts) for amounts in (base, base * more))
        less.append((log_colour(after) - log_colour(before)) / (luminance(before) - luminance(after)))
    axes = np.stack([*less, np.ones(3)])
    amounts = log_colour(albedo) @ np.linalg.inv(axes)
    return amounts[..., 0], amounts[..., 1]


def spectrum(values: np.ndarray, region: np.ndarray, surface: Surface) -> np.ndarray:
    """Root mean square (B,) of `values` (N,N) within `region` in each octave of `BANDS`; NaN where no window fits.

    A sine of amplitude a and of a frequency inside an octave gives a / sqrt 2 there.
    """
    result = np.full(len(BANDS), np.nan)
    step = float(np.median(_texel_mm(surface)[region])) if region.any() else np.nan
    for side, bands in zip(_WINDOWS_MM, (slice(0, 3), slice(3, len(BANDS)))):
        count = max(8, round(side / step)) if np.isfinite(step) else 0
        if count and count <= len(region):
            result[bands] = _welch(values, region, surface, count)[bands]
    return result


def _texel_mm(surface: Surface) -> np.ndarray:
    return np.sqrt(np.linalg.norm(np.cross(surface.across, surface.down), axis=-1))


def _welch(values: np.ndarray, region: np.ndarray, surface: Surface, count: int) -> np.ndarray:
    hann = np.hanning(count + 2)[1:-1]
    window = np.outer(hann, hann)
    cycles = np.fft.fftfreq(count)
    power, weight = np.zeros(len(BANDS)), 0.0
    rows, columns = np.mgrid[0:count, 0:count] / count - 0.5
    places = np.stack([np.ones_like(rows), rows, columns], axis=-1).reshape(-1, 3)
    for top in range(0, len(region) - count + 1, max(1, count // 3)):
        for left in range(0, len(region) - count + 1, max(1, count // 3)):
            part = np.s_[top : top + count, left : left + count]
            weights = window * region[part]
            if weights.sum() < _FILLED * window.sum():
                continue
            # The plane that fits best is not detail.
            root = np.sqrt(weights).ravel()
            fit = np.linalg.lstsq(places * root[:, None], values[part].ravel() * root, rcond=None)[0]
            rest = (values[part].ravel() - places @ fit).reshape(count, count) * weights
            # Cycles per texel along rows and columns become cycles per mm through the mean of the metric.
            normalised = weights / weights.sum()
            across, down = (np.tensordot(normalised, t[part], 2) for t in (surface.across, surface.down))
            metric = np.linalg.inv([[down @ down, down @ across], [down @ across, across @ across]])
            fy, fx = cycles[:, None], cycles[None, :]
            frequency = np.sqrt(metric[0, 0] * fy**2 + 2 * metric[0, 1] * fy * fx + metric[1, 1] * fx**2)
            energy = np.abs(np.fft.fft2(rest)) ** 2 / count**2
            band = np.digitize(frequency, [*BANDS, 2 * BANDS[-1]]) - 1
            known = (band >= 0) & (band < len(BANDS))
            power += np.bincount(band[known], energy[known], minlength=len(BANDS))
            # Octaves finer than two texels hold nothing that a map can show.
            weight += float((weights**2).sum())
    nyquist = 0.5 / float(np.median(_texel_mm(surface)[region]))
    power[nyquist * 1.01 < 2 * BANDS] = np.nan
    return np.sqrt(power / weight) if weight else np.full(len(BANDS), np.nan)


def slope_spectrum(normal: np.ndarray, region: np.ndarray, surface: Surface) -> np.ndarray:
    """Root mean square tilt (B,) in degrees of `normal` (N,N,3) against the smooth mesh in each octave of `BANDS`."""
    first = unit(surface.across - (surface.across * surface.normal).sum(-1, keepdims=True) * surface.normal)
    second = np.cross(surface.normal, first)
    tilts = [spectrum((normal * axis).sum(-1), region, surface) for axis in (first, second)]
    return np.degrees(np.hypot(*tilts))


@dataclasses.dataclass(frozen=True)
class Spread:
    """Colour within one region: `contrast`, its median log luminance less that of the skin; `deviation`, the standard
    deviation of log luminance; `low`, `high`, the 1st and 99th percentile less the median."""

    contrast: float
    deviation: float
    low: float
    high: float


def spread(albedo: np.ndarray, region: np.ndarray, skin: np.ndarray) -> Spread:
    """The colour of `albedo` (N,N,3) within `region` (N,N) bool, beside that of `skin` (N,N) bool."""
    here, there = luminance(albedo[region]), luminance(albedo[skin])
    low, median, high = np.percentile(here, [1, 50, 99])
    return Spread(float(median - np.median(there)), float(here.std()), float(low - median), float(high - median))


def inner(region: np.ndarray, texels: int) -> np.ndarray:
    """`region` (N,N) bool without what lies within `texels` of its edge."""
    return binary_erosion(region, iterations=texels) if texels else region


def label_mean_psnr(albedo: np.ndarray, labels: np.ndarray, inside: np.ndarray) -> float:
    """PSNR in dB (sRGB values) of the flat map that has the true mean colour of every label."""
    flat = np.zeros_like(albedo)
    for label in np.unique(labels[inside]):
        here = inside & (labels == label)
        flat[here] = albedo[here].mean(axis=0)
    return float(-10 * np.log10(np.mean((encoded(flat[inside]) - encoded(albedo[inside])) ** 2)))


def bare_skin(albedo: np.ndarray, skin: np.ndarray, surface: Surface) -> np.ndarray:
    """The front's skin (N,N) bool at least 3 mm from other labels (`skin` (N,N): those of skin and nose), without what is
    darker than a third of its median: nostrils, and hair that labels leave out."""
    region = surface.front() & skin
    step = float(np.median(_texel_mm(surface)[region]))
    region = inner(region, max(1, round(3.0 / step)))
    light = luminance(albedo)
    return region & (light > np.median(light[region]) - np.log(3.0))

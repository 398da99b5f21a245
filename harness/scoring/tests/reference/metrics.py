"""Reference values of the metrics, by independent implementations.

    python harness/scoring/tests/reference/metrics.py        writes metrics.json beside this file

The pictures are closed formulas of integers and IEEE divisions, so that the Rust test makes
the same bits (`tests/metric_references.rs`). Nothing of this project is imported here.
"""

import json
from pathlib import Path

import colour
import flip_evaluator
import numpy as np
from scipy import ndimage, optimize, stats
from skimage.metrics import peak_signal_noise_ratio, structural_similarity

WIDTH, HEIGHT = 96, 64
WHOLE = ("owl_psnr", "nerfactor_albedo_psnr")
"""Scored on the mask as it is."""
STORED = Path(__file__).with_suffix(".json")


def triangle(position, period):
    """A triangle wave of integers, 0 to 1."""
    return np.abs((position % period) / period * 2.0 - 1.0)


def noise(x, y, seed):
    """Integer noise, 0 to 1, different in every pixel and channel."""
    state = (x * 7919 + y * 104729 + seed * 15485863) % 65521
    return (state * state % 65521) / 65521.0


def pictures():
    """Truth, prediction, leaking layer (linear RGB, float32), mask and labels (uint8), confidence (float32)."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH].astype(np.int64)
    truth, prediction, cause = (np.zeros((HEIGHT, WIDTH, 3), np.float32) for _ in range(3))
    for c in range(3):
        base = 0.06 + 0.5 * triangle(x * (c + 2) + 3 * y, 67) * triangle(y * 2 + c * 11, 53)
        shade = 0.3 + 0.9 * triangle(x + 2 * y + 5 * c, 101)
        true = base + 0.02 * noise(x, y, c)
        truth[..., c] = true
        prediction[..., c] = 0.9 * true * (0.8 + 0.2 * shade) + 0.05 * noise(x, y, c + 7) - 0.01
        cause[..., c] = shade
    # A highlight beyond one and a dark spot below zero: the clipping is part of the definitions.
    truth[30:33, 40:44] += 1.0
    mask = np.where((x - 48) ** 2 * 4 + (y - 32) ** 2 * 9 < 8000, 255, 0).astype(np.uint8)
    labels = (1 + (x // 32) + 3 * (y // 40)).astype(np.uint8)
    # Higher where the baked shading is near one, so that it follows the error loosely.
    confidence = (triangle(x + 2 * y, 101) + 0.3 * noise(x, y, 11)).astype(np.float32)
    return truth, prediction, cause, mask, labels, confidence


def normals():
    """True and predicted vectors, not of unit length, float32."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH].astype(np.int64)
    truth = np.stack([triangle(x, 37) - 0.5, triangle(y, 29) - 0.5, 1.0 + 0.0 * x], axis=-1).astype(np.float32)
    deviation = np.stack([noise(x, y, c) - 0.5 for c in (1, 2, 3)], axis=-1)
    return truth, (truth * 2.0 + 1.8 * deviation).astype(np.float32)


def halves(prediction, truth):
    """Means of half of the samples: the pictures with noise of one size, opposite in the other half; float32."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH].astype(np.int64)
    shake = lambda seed: np.stack([0.02 * (noise(x, y, seed + c) - 0.5) for c in range(3)], -1)
    return (prediction + shake(21)).astype(np.float32), (truth + shake(31)).astype(np.float32)


def mesh_normals():
    """The true normals in every other pixel, +Z in the others, float32."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH].astype(np.int64)
    return np.where(((x + y) % 2 == 0)[..., None], normals()[0], np.array([0.0, 0.0, 1.0], np.float32))


def deviations(cause):
    """Stated standard deviations, float32."""
    return (cause * np.float32(0.0625)).astype(np.float32)


def given(made, name, needs):
    """Prediction, truth, and what the metric ``name`` needs beside them.

    ``made``: results of `pictures`, `normals`, `mesh_normals` and `halves`.
    """
    (truth, prediction, cause, _, labels, confidence), (true_normal, normal), mesh, half = made
    beside = {"labels": labels, "shading": cause, "specular": cause, "confidence": confidence}
    beside |= {"area": confidence, "mesh_normal": mesh, "halves": half, "deviation": deviations(cause)}
    pair = prediction, truth
    if name in ("rmse", "pearson", "spearman", "log_ratio_rms"):
        pair = prediction[..., 1], truth[..., 0]
    if name.startswith("normal") or name in ("relief_invented", "direction_mean_deg"):
        pair = normal, true_normal
    return *pair, {needs: beside[needs]} if needs else {}


def references():
    truth, prediction, cause, mask, labels, confidence = pictures()
    inside = ndimage.binary_erosion(mask > 127, np.ones((5, 5)), border_value=0)
    t, p = truth.astype(np.float64), prediction.astype(np.float64)
    tm, pm = t[inside], p[inside]
    srgb = lambda v: colour.cctf_encoding(np.clip(v, 0, 1), function="sRGB")
    lab = lambda v: colour.XYZ_to_Lab(
        np.clip(v, 0, 1) @ colour.RGB_COLOURSPACES["sRGB"].matrix_RGB_to_XYZ.T,
        np.array([0.3127, 0.3290]),
    )
    luminance = lambda v: v @ np.array([0.2126, 0.7152, 0.0722])
    log = lambda v: np.log(np.maximum(luminance(v), 1e-3))

    black = lambda v: np.where(mask[..., None] > 127, v, 0.0)
    _, similarity = structural_similarity(
        srgb(black(t)),
        srgb(black(p)),
        channel_axis=-1,
        data_range=1.0,
        full=True,
        gaussian_weights=True,
        sigma=1.5,
        use_sample_covariance=False,
    )
    eight = lambda v: (np.floor(srgb(black(v)) * 255 + 0.5) / 255).astype(np.float32)
    flip = flip_evaluator.evaluate(eight(t), eight(p), "LDR", inputsRGB=True, applyMagma=False)[0]
    flip = np.squeeze(flip)[inside].astype(np.float64)

    def low_pass(values):
        picture, weight = np.zeros(inside.shape), inside.astype(np.float64)
        picture[inside] = values
        sigma = WIDTH / 64
        blur = lambda v: ndimage.gaussian_filter(v, sigma, radius=int(np.ceil(3 * sigma)))
        return blur(picture)[inside] / blur(weight)[inside]

    def within(values):
        centred = values.copy()
        for label in np.unique(labels[inside]):
            here = labels[inside] == label
            centred[here] -= values[here].mean()
        return centred

    lab_t, lab_p = lab(tm), lab(pm)
    angle = lambda v: np.degrees(np.arctan2(v[:, 0] - 50, v[:, 2]))
    n, m = (v.astype(np.float64)[inside] for v in normals())
    cosine = (n * m).sum(-1) / np.linalg.norm(n, axis=-1) / np.linalg.norm(m, axis=-1)
    degrees = np.degrees(np.arccos(cosine))
    specular_t, specular_p = t[..., 0][inside], p[..., 1][inside]
    correlation = lambda a, b: stats.pearsonr(a, b).statistic
    trust, error = confidence[inside].astype(np.float64), np.abs(log(pm) - log(tm))
    trusted = np.heaviside(trust - np.median(trust), 0.5)

    values = {
        "psnr_srgb": peak_signal_noise_ratio(srgb(tm), srgb(pm), data_range=1.0),
        "psnr_lin": peak_signal_noise_ratio(tm, pm, data_range=1.0),
        "relmse": np.mean(((pm - tm) / (tm + 0.01)) ** 2),
        "ssim": similarity[inside].mean(),
        "flip_mean": flip.mean(),
        "flip_p95": np.percentile(flip, 95),
        "ciede2000_mean": colour.delta_E(lab_t, lab_p, method="CIE 2000").mean(),
        "ita_error": abs(angle(lab_p).mean() - angle(lab_t).mean()),
        "scale_global": np.linalg.lstsq(pm.reshape(-1, 1), tm.ravel(), rcond=None)[0][0],
        "rmse": np.sqrt(np.mean((specular_p - specular_t) ** 2)),
        "pearson": correlation(specular_p, specular_t),
        "spearman": stats.spearmanr(specular_p, specular_t).statistic,
        "energy_ratio": luminance(pm).sum() / luminance(tm).sum(),
        "normal_mean_deg": degrees.mean(),
        "normal_median_deg": np.median(degrees),
        **{f"normal_below_{limit}".replace(".", "_"): np.mean(degrees < limit) for limit in (5, 11.25, 22.5, 30)},
        "hc": correlation(log(pm) - low_pass(log(pm)), log(tm) - low_pass(log(tm))),
        "wcorr": correlation(within(log(pm)), within(log(tm))),
        "lp": np.std(low_pass(log(pm) - log(tm))),
        "leakage_shading": stats.linregress(log(cause[inside].astype(np.float64)), log(pm) - log(tm)).rvalue ** 2,
        "leakage_specular": stats.linregress(
            luminance(cause[inside].astype(np.float64)), luminance(pm) - luminance(tm)
        ).rvalue
        ** 2,
        "confidence_rank": stats.spearmanr(trust, error).statistic,
        "sparsification": np.average(error, weights=trusted) / error.mean(),
    }
    over = np.sqrt(np.mean(((pm - tm) / deviations(cause)[inside].astype(np.float64)) ** 2, axis=-1))
    values |= {"deviation_68": np.quantile(over, 0.6827), "deviation_95": np.quantile(over / 2, 0.9545)}
    half_p, half_t = (half.astype(np.float64) for half in halves(prediction, truth))
    crossed = lambda f: np.mean(((f(half_p) - f(half_t)) * (f(2 * p - half_p) - f(2 * t - half_t)))[inside])
    dot = (pm * tm).sum(-1) / np.linalg.norm(pm, axis=-1) / np.linalg.norm(tm, axis=-1)

    def band(values, sigma):
        picture, weight = np.zeros(inside.shape), inside.astype(np.float64)
        picture[inside] = values
        blur = lambda v, s: ndimage.gaussian_filter(v, s, truncate=3.0)
        mean = lambda s: blur(picture, s)[inside] / blur(weight, s)[inside]
        return mean(sigma) - mean(2 * sigma)

    slope = lambda sigma: stats.linregress(band(log(tm), sigma), band(log(pm), sigma)).slope
    mesh = mesh_normals().astype(np.float64)[inside]
    tilt = lambda v: np.degrees(np.arctan2(np.linalg.norm(np.cross(v, mesh), axis=-1), (v * mesh).sum(-1)))
    flat = tilt(n) < 0.5
    ratio = np.log(np.maximum(specular_p, 1e-3) / np.maximum(specular_t, 1e-3))
    values |= {
        "psnr_lin_unbiased": -10 * np.log10(crossed(lambda v: v)),
        "psnr_srgb_unbiased": -10 * np.log10(crossed(srgb)),
        "chromaticity_deg": np.degrees(np.arccos(np.minimum(dot, 1))).mean(),
        "log_rmse": np.std(log(pm) - log(tm)),
        "log_ratio_rms": np.sqrt(np.mean(ratio**2)),
        "detail_slope_1_2": slope(1),
        "detail_slope_2_4": slope(2),
        "relief_invented": tilt(m)[flat].mean(),
        "psnr_srgb_area": -10 * np.log10(np.average(((srgb(pm) - srgb(tm)) ** 2).mean(-1), weights=trust)),
        "normal_mean_deg_area": np.average(degrees, weights=trust),
        "direction_mean_deg": degrees.mean(),
    }
    values |= compatible(truth, prediction, mask > 127, inside, srgb)
    channel = [np.linalg.lstsq(pm[:, [c]], tm[:, c], rcond=None)[0][0] for c in range(3)]
    median = [np.median((tm[:, c] / pm[:, c])[pm[:, c] > 0]) for c in range(3)]
    return {
        "pixels": int(inside.sum()),
        "values": {name: float(value) for name, value in values.items()},
        "scale": {"channel": [float(k) for k in channel], "median": [float(k) for k in median]},
    }


def compatible(truth, prediction, mask, eroded, srgb):
    """Scores by the protocols of other benchmarks, written from their published definitions."""
    decibels = lambda mse: -10 * np.log10(mse)

    def orb(maximum, expose, curve):
        p, g = (np.where(eroded[..., None], v.astype(np.float64), 0) for v in (prediction, truth))
        g = np.maximum(g, 0)
        if expose:
            p, g = (v * srgb(g.clip(0, 1)).mean() / g.clip(0, 1).mean() for v in (p, g))
        p = p * (p * g).sum((0, 1)) / (p * p).sum((0, 1))
        p, g = curve(p.clip(0, maximum)), curve(g.clip(0, maximum))
        grey = np.where(eroded[..., None], 0.5, 0)
        return max(decibels(((p - g) ** 2).mean()), decibels(((grey - g) ** 2).mean()))

    def objects_with_lighting():
        curve = lambda v: np.clip(np.clip(v, 0, None) ** (1 / 2.2), 0, 1)
        g, p = np.round(255 * curve(truth[mask].astype(np.float64))) / 255, prediction[mask].astype(np.float64)
        fitted = g.max(-1) < 1
        darkest = p[fitted].min(-1)
        top = np.log2(0.95**2.2 / darkest[darkest > 0].min())
        off = lambda q: np.abs(curve(q[fitted]) - g[fitted]).mean()
        p = p * 2 ** optimize.minimize_scalar(lambda x: off(p * 2**x), (-10, top)).x
        start = np.ones(3)
        p = p * optimize.minimize(lambda x: off(p * x), start, bounds=3 * [(0.5, 2.0)], method="Nelder-Mead",
                                  options={"xatol": 1e-9, "fatol": 1e-12, "maxiter": 4000}).x  # fmt: skip
        return peak_signal_noise_ratio(g, curve(p), data_range=1.0)

    def nerfactor():
        g, p = (np.where(mask[..., None], v.astype(np.float64), 1) for v in (truth, prediction))
        factor = [np.linalg.lstsq(p[mask][:, [c]], g[mask][:, c], rcond=None)[0][0] for c in range(3)]
        p = np.where(mask[..., None], p * factor, g).clip(g.min(), g.max())
        luma = lambda v: np.maximum(v, 0) ** (1 / 2.2) @ np.array([0.2126, 0.7152, 0.0722])
        return decibels(((luma(p) - luma(g)) ** 2).mean())

    same = lambda v: v
    return {
        "orb_psnr_h": orb(4, True, same),
        "orb_psnr_l": orb(1, False, srgb),
        "orb_albedo_psnr": orb(1, False, same),
        "owl_psnr": objects_with_lighting(),
        "nerfactor_albedo_psnr": nerfactor(),
    }


if __name__ == "__main__":
    STORED.write_text(json.dumps(references(), indent=1) + "\n")

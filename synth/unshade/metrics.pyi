# Written by tests/metric_stub.py.
from collections.abc import Iterable
from typing import Literal, NamedTuple

from numpy.typing import ArrayLike

_Scale = Literal["none", "global", "channel", "median"]

class Definition(NamedTuple):
    """Id, words, unit and direction of a metric; ``needs`` names an argument beside the mask, or is empty."""

    id: str
    name: str
    unit: str
    direction: str
    definition: str
    link: str
    needs: str

DEFINITIONS: dict[str, Definition]

__all__ = [
    "DEFINITIONS",
    "Definition",
    "evaluate",
    "psnr_srgb",
    "psnr_lin",
    "relmse",
    "ssim",
    "flip_mean",
    "flip_p95",
    "ciede2000_mean",
    "ita_error",
    "scale_global",
    "rmse",
    "pearson",
    "spearman",
    "energy_ratio",
    "normal_mean_deg",
    "normal_median_deg",
    "normal_below_5",
    "normal_below_11_25",
    "normal_below_22_5",
    "normal_below_30",
    "hc",
    "wcorr",
    "lp",
    "leakage_shading",
    "leakage_specular",
    "confidence_rank",
    "sparsification",
    "psnr_lin_unbiased",
    "psnr_srgb_unbiased",
    "chromaticity_deg",
    "log_rmse",
    "log_ratio_rms",
    "detail_slope_1_2",
    "detail_slope_2_4",
    "relief_invented",
    "psnr_srgb_area",
    "normal_mean_deg_area",
    "direction_mean_deg",
    "orb_psnr_h",
    "orb_psnr_l",
    "orb_albedo_psnr",
    "owl_psnr",
    "nerfactor_albedo_psnr",
    "lpips_alex_0_1",
    "lpips_vgg_0_1",
]

def evaluate(
    names: Iterable[str],
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
    **beside: ArrayLike,
) -> dict[str, float | None]:
    """The metrics ``names`` of one pair, by name; arguments as those of each, which get what they need of ``beside``.

    On all cores, and what several need is computed once: much faster than a call for each. The values are the same.
    """

def psnr_srgb(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """PSNR [dB]: -10 log10 of the mean over pixels and channels of (p-g)² of sRGB values (IEC
    61966-2-1) clipped to [0, 1]; peak 1; at most 100"""

def psnr_lin(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """PSNR, linear [dB]: -10 log10 of the mean over pixels and channels of (p-g)² of linear values,
    not clipped; peak 1; at most 100"""

def relmse(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Relative MSE: mean over pixels and channels of (p-g)² / (g+.01)² of linear values"""

def ssim(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """SSIM: mean of the structural similarity map of sRGB values: Gaussian window 11x11 with sigma
    1.5, K1 .01, K2 .03, range 1, population covariance, per channel; black outside the mask"""

def flip_mean(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """FLIP: mean of the LDR-FLIP map of 8-bit sRGB pictures at 67.02 pixels per degree; black outside
    the mask"""

def flip_p95(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """FLIP, 95th percentile: 95th percentile of the LDR-FLIP map of 8-bit sRGB pictures at 67.02
    pixels per degree; black outside the mask"""

def ciede2000_mean(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """CIEDE2000: mean CIEDE2000 of linear colours clipped to [0, 1] (D65, kL = kC = kH = 1)"""

def ita_error(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Typology angle error [°]: |mean over p - mean over g| of the individual typology angle
    atan2(L*-50, b*)"""

def scale_global(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Aligning factor: the one factor k = <p,g> / <p,p> that aligns p with g in linear values"""

def rmse(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """RMSE: square root of the mean of (p-g)² of linear values"""

def pearson(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Correlation: Pearson correlation of p and g (colours: of their luminances); none if one is
    constant"""

def spearman(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Rank correlation: Pearson correlation of the ranks of p and g (colours: of their luminances),
    ties sharing their mean rank; none if one is constant; its interval keeps the ranks fixed"""

def energy_ratio(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Energy: sum of the luminance of p / sum of the luminance of g"""

def normal_mean_deg(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Mean angle [°]: mean angle between p and g in object space; 90 where p has no length"""

def normal_median_deg(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Median angle [°]: median angle between p and g in object space"""

def normal_below_5(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Below 5°: share of pixels whose angle is below 5°"""

def normal_below_11_25(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Below 11.25°: share of pixels whose angle is below 11.25°"""

def normal_below_22_5(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Below 22.5°: share of pixels whose angle is below 22.5°"""

def normal_below_30(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Below 30°: share of pixels whose angle is below 30°"""

def hc(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Detail correlation: Pearson correlation of the high-pass log luminances: each less its Gaussian
    mean over the region (sigma = width/64, cut off at 3 sigma), luminances below .001 raised to it"""

def wcorr(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    labels: ArrayLike,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Correlation within labels: Pearson correlation of the log luminances, each less its mean within
    the label; luminances below .001 raised to it"""

def lp(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Residual shading: standard deviation of the low-pass difference of the log luminances: Gaussian
    mean over the region, sigma = width/64, cut off at 3 sigma"""

def leakage_shading(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    shading: ArrayLike,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Baked shading: share of the variance of the log luminance error that a line in the log luminance
    of the true diffuse shading explains (squared correlation)"""

def leakage_specular(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    specular: ArrayLike,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Baked highlights: share of the variance of the luminance error that a line in the luminance of
    the true specular layer explains (squared correlation)"""

def confidence_rank(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    confidence: ArrayLike,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Confidence against error: Pearson correlation of the ranks of the confidence and of |difference
    of the log luminances|, ties sharing their mean rank, luminances below .001 raised to it: -1 if
    confidence falls wherever the error grows, 0 if it says nothing; none if one is constant; its
    interval keeps the ranks fixed"""

def sparsification(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    confidence: ArrayLike,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Error of the trusted half: mean |difference of the log luminances| of the half with the highest
    confidence / that of all, luminances below .001 raised to it; equal confidences share the half's
    last places: 1 if confidence says nothing"""

def psnr_lin_unbiased(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    halves: ArrayLike,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """PSNR without noise, linear [dB]: -10 log10 of the mean over pixels and channels of (a-b)(a'-b')
    of linear values, a and b being the means of independent halves of the samples of p and g, a'
    and b' those of the others: what noise adds to (p-g)² has the mean 0 in it; peak 1; 100 where
    nothing is left"""

def psnr_srgb_unbiased(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    halves: ArrayLike,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """PSNR without noise [dB]: -10 log10 of the mean over pixels and channels of (a-b)(a'-b') of sRGB
    values clipped to [0, 1], a and b being the means of independent halves of the samples of p and
    g, a' and b' those of the others; the curve of noisy values is bent, and unequal noise of p and
    g leaves a bias; peak 1; 100 where nothing is left"""

def chromaticity_deg(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Chromaticity error [°]: mean angle between the linear colours p and g, whatever their intensity;
    90 where one is black"""

def log_rmse(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Log error after one factor: standard deviation of the difference of the log luminances, which is
    their RMSE after the one factor that makes it least; luminances below .001 raised to it"""

def log_ratio_rms(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Log ratio: square root of the mean of ln(p/g)²; values below .001 raised to it"""

def detail_slope_1_2(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Detail at 1 to 2 texels: slope of the regression of p on g, both log luminances between Gaussian
    means over the region of sigma 1 and 2 texels, cut off at 3 sigma; luminances below .001 raised
    to it"""

def detail_slope_2_4(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Detail at 2 to 4 texels: slope of the regression of p on g, both log luminances between Gaussian
    means over the region of sigma 2 and 4 texels, cut off at 3 sigma; luminances below .001 raised
    to it"""

def relief_invented(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    mesh_normal: ArrayLike,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Invented relief [°]: mean angle between p and the mesh's normal where g is within .5° of it;
    none where g is so nowhere"""

def psnr_srgb_area(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    area: ArrayLike,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """PSNR over the surface [dB]: -10 log10 of the mean over the surface, every texel by its area, and
    over channels of (p-g)² of sRGB values clipped to [0, 1]; peak 1; at most 100"""

def normal_mean_deg_area(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    area: ArrayLike,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Mean angle over the surface [°]: mean angle between p and g over the surface, every texel by its
    area; 90 where p has no length"""

def direction_mean_deg(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Direction error [°]: mean angle between two directions"""

def orb_psnr_h(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """PSNR-H of Stanford-ORB [dB]: as in Stanford-ORB: p after one factor per channel, both times
    mean(sRGB of g) / mean(g), clipped to [0, 4], linear; the squared error is divided by the whole
    frame, background included; no less than the PSNR of a picture of .5; mean over pictures"""

def orb_psnr_l(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """PSNR-L of Stanford-ORB [dB]: as in Stanford-ORB: p after one factor per channel, sRGB values in
    [0, 1]; the squared error is divided by the whole frame, background included; no less than the
    PSNR of a picture of .5; mean over pictures"""

def orb_albedo_psnr(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Albedo PSNR of Stanford-ORB [dB]: as in Stanford-ORB, the frame being the texture: p after one
    factor per channel, linear values in [0, 1]; the squared error is divided by the whole frame; no
    less than the PSNR of a picture of .5"""

def owl_psnr(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """PSNR of objects-with-lighting [dB]: as in objects-with-lighting: values to the power 1/2.2 in
    [0, 1], g of 8 bits; the exposure of p, then a factor from .5 to 2 for each channel, with the
    least mean absolute error where g is not overexposed; mean over pictures"""

def nerfactor_albedo_psnr(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """Albedo PSNR of NeRFactor [dB]: as in NeRFactor, the frame being the texture: p after one factor
    per channel, clipped to the range of g on white, luma of values to the power 1/2.2; the squared
    error is divided by the whole frame"""

def lpips_alex_0_1(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """LPIPS (AlexNet, 0.1): learned perceptual distance, weights of version 0.1, on AlexNet: sRGB
    values clipped to [0, 1], black outside the mask, the whole frame; mean over pictures"""

def lpips_vgg_0_1(
    prediction: ArrayLike,
    truth: ArrayLike,
    mask: ArrayLike | None = None,
    *,
    erode: bool = False,
    scale: _Scale = "none",
) -> float | None:
    """LPIPS (VGG-16, 0.1): learned perceptual distance, weights of version 0.1, on VGG-16: sRGB values
    clipped to [0, 1], black outside the mask, the whole frame; mean over pictures"""

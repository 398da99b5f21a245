//! Every metric, stated once: the scores, the report, the comparison and Python read this list.

use std::sync::{PoisonError, RwLock};

use formats::cancel;

use super::compatible::Protocol as P;
use super::quantity::Quantity as Q;
use super::statistic::Statistic as S;
use super::{MetricError, Pair};

/// The direction in which values improve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Higher ones.
    Higher,
    /// Lower ones.
    Lower,
    /// Values near one are better.
    One,
}

impl Direction {
    /// The gain of `new` over `old` in the metric's unit; negative if worse.
    pub fn gain(self, old: f64, new: f64) -> f64 {
        match self {
            Self::Higher => new - old,
            Self::Lower => old - new,
            Self::One => (old - 1.0).abs() - (new - 1.0).abs(),
        }
    }

    /// `↑`, `↓` or `→1`.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Higher => "↑",
            Self::Lower => "↓",
            Self::One => "→1",
        }
    }
}

/// A metric: a quantity of every pixel, summarised by a statistic.
#[derive(Debug)]
pub struct Metric {
    /// As in row ids.
    pub id: &'static str,
    /// As in tables.
    pub name: &'static str,
    /// Empty for a pure number.
    pub unit: &'static str,
    /// The direction in which values improve.
    pub direction: Direction,
    /// Formula in full; p is the prediction, g the truth.
    pub definition: &'static str,
    /// A link to its definition.
    pub link: &'static str,
    /// Per pixel.
    pub quantity: Q,
    /// Over the region.
    pub statistic: S,
}

/// Metrics that users write, once scores have stated them. Never freed: a metric is looked up for as long as the
/// program runs.
pub(super) static REGISTERED: RwLock<Vec<&'static Metric>> = RwLock::new(Vec::new());

impl Metric {
    /// The metric with an id.
    pub fn find(id: &str) -> Result<&'static Self, MetricError> {
        let registered = || {
            let known = REGISTERED.read().unwrap_or_else(PoisonError::into_inner);
            known.iter().find(|metric| metric.id == id).copied()
        };
        METRICS.iter().find(|metric| metric.id == id).or_else(registered).ok_or_else(|| {
            let known: Vec<_> = METRICS.iter().map(|metric| metric.id).collect();
            MetricError::Unknown { id: id.to_owned(), known: known.join(", ") }
        })
    }

    /// The quantity at every pixel of the region, in its order, `statistic.arity()` numbers each.
    pub fn measure(&self, pair: &Pair) -> Result<Vec<f64>, MetricError> {
        cancel::check();
        self.quantity.measure(pair, self.id)
    }

    /// The metric over the region; `None` where it is not defined (a correlation with a constant).
    pub fn value(&self, pair: &Pair) -> Result<Option<f64>, MetricError> {
        Ok(self.statistic.value([self.measure(pair)?.as_slice()]))
    }
}

macro_rules! metrics {
    ($($id:literal, $name:literal, $unit:literal, $direction:ident, $quantity:expr, $statistic:expr,
       $definition:literal, $link:literal;)*) => {
        &[$(Metric {
            id: $id, name: $name, unit: $unit, direction: Direction::$direction,
            quantity: $quantity, statistic: $statistic, definition: $definition, link: $link,
        }),*]
    };
}

/// Every metric, in the order of tables.
pub static METRICS: &[Metric] = metrics! {
    "psnr_srgb", "PSNR", "dB", Higher, Q::SquaredErrorSrgb, S::Psnr,
        "-10 log10 of the mean over pixels and channels of (p-g)² of sRGB values (IEC 61966-2-1) clipped to [0, 1]; peak 1; at most 100",
        "https://webstore.iec.ch/en/publication/6169";
    "psnr_lin", "PSNR, linear", "dB", Higher, Q::SquaredError, S::Psnr,
        "-10 log10 of the mean over pixels and channels of (p-g)² of linear values, not clipped; peak 1; at most 100",
        "https://en.wikipedia.org/wiki/Peak_signal-to-noise_ratio";
    "relmse", "Relative MSE", "", Lower, Q::RelativeSquaredError, S::Mean,
        "mean over pixels and channels of (p-g)² / (g+.01)² of linear values",
        "https://en.wikipedia.org/wiki/Mean_squared_error";
    "ssim", "SSIM", "", Higher, Q::Ssim, S::Mean,
        "mean of the structural similarity map of sRGB values: Gaussian window 11x11 with sigma 1.5, K1 .01, K2 .03, range 1, population covariance, per channel; black outside the mask",
        "https://doi.org/10.1109/TIP.2003.819861";
    "flip_mean", "FLIP", "", Lower, Q::Flip, S::Mean,
        "mean of the LDR-FLIP map of 8-bit sRGB pictures at 67.02 pixels per degree; black outside the mask",
        "https://github.com/NVlabs/flip";
    "flip_p95", "FLIP, 95th percentile", "", Lower, Q::Flip, S::Quantile(0.95),
        "95th percentile of the LDR-FLIP map of 8-bit sRGB pictures at 67.02 pixels per degree; black outside the mask",
        "https://github.com/NVlabs/flip";
    "ciede2000_mean", "CIEDE2000", "", Lower, Q::ColourDifference, S::Mean,
        "mean CIEDE2000 of linear colours clipped to [0, 1] (D65, kL = kC = kH = 1)",
        "https://doi.org/10.1002/col.20070";
    "ita_error", "Typology angle error", "°", Lower, Q::Typology, S::MeanDifference,
        "|mean over p - mean over g| of the individual typology angle atan2(L*-50, b*)",
        "https://trust.is.tue.mpg.de";
    "scale_global", "Aligning factor", "", One, Q::Projection, S::Ratio,
        "the one factor k = <p,g> / <p,p> that aligns p with g in linear values",
        "https://arxiv.org/abs/2310.16044";
    "rmse", "RMSE", "", Lower, Q::SquaredError, S::RootMean,
        "square root of the mean of (p-g)² of linear values",
        "https://en.wikipedia.org/wiki/Root_mean_square_deviation";
    "pearson", "Correlation", "", Higher, Q::Luminance, S::Correlation,
        "Pearson correlation of p and g (colours: of their luminances); none if one is constant",
        "https://en.wikipedia.org/wiki/Pearson_correlation_coefficient";
    "spearman", "Rank correlation", "", Higher, Q::Ranks, S::Correlation,
        "Pearson correlation of the ranks of p and g (colours: of their luminances), ties sharing their mean rank; none if one is constant; its interval keeps the ranks fixed",
        "https://en.wikipedia.org/wiki/Spearman%27s_rank_correlation_coefficient";
    "energy_ratio", "Energy", "", One, Q::Luminance, S::Ratio,
        "sum of the luminance of p / sum of the luminance of g",
        "https://en.wikipedia.org/wiki/Relative_luminance";
    "normal_mean_deg", "Mean angle", "°", Lower, Q::Angle, S::Mean,
        "mean angle between p and g in object space; 90 where p has no length",
        "https://arxiv.org/abs/1411.4734";
    "normal_median_deg", "Median angle", "°", Lower, Q::Angle, S::Quantile(0.5),
        "median angle between p and g in object space",
        "https://arxiv.org/abs/1411.4734";
    "normal_below_5", "Below 5°", "", Higher, Q::Angle, S::Below(5.0),
        "share of pixels whose angle is below 5°", "https://arxiv.org/abs/1411.4734";
    "normal_below_11_25", "Below 11.25°", "", Higher, Q::Angle, S::Below(11.25),
        "share of pixels whose angle is below 11.25°", "https://arxiv.org/abs/1411.4734";
    "normal_below_22_5", "Below 22.5°", "", Higher, Q::Angle, S::Below(22.5),
        "share of pixels whose angle is below 22.5°", "https://arxiv.org/abs/1411.4734";
    "normal_below_30", "Below 30°", "", Higher, Q::Angle, S::Below(30.0),
        "share of pixels whose angle is below 30°", "https://arxiv.org/abs/1411.4734";
    "hc", "Detail correlation", "", Higher, Q::HighPass, S::Correlation,
        "Pearson correlation of the high-pass log luminances: each less its Gaussian mean over the region (sigma = width/64, cut off at 3 sigma), luminances below .001 raised to it",
        "https://en.wikipedia.org/wiki/High-pass_filter";
    "wcorr", "Correlation within labels", "", Higher, Q::WithinLabel, S::Correlation,
        "Pearson correlation of the log luminances, each less its mean within the label; luminances below .001 raised to it",
        "https://en.wikipedia.org/wiki/Pearson_correlation_coefficient";
    "lp", "Residual shading", "", Lower, Q::LowPassError, S::Spread,
        "standard deviation of the low-pass difference of the log luminances: Gaussian mean over the region, sigma = width/64, cut off at 3 sigma",
        "https://en.wikipedia.org/wiki/Low-pass_filter";
    "leakage_shading", "Baked shading", "", Lower, Q::LogErrorAndCause, S::Explained,
        "share of the variance of the log luminance error that a line in the log luminance of the true diffuse shading explains (squared correlation)",
        "https://en.wikipedia.org/wiki/Coefficient_of_determination";
    "leakage_specular", "Baked highlights", "", Lower, Q::ErrorAndCause, S::Explained,
        "share of the variance of the luminance error that a line in the luminance of the true specular layer explains (squared correlation)",
        "https://en.wikipedia.org/wiki/Coefficient_of_determination";
    "confidence_rank", "Confidence against error", "", Lower, Q::TrustAndErrorRanks, S::Correlation,
        "Pearson correlation of the ranks of the confidence and of |difference of the log luminances|, ties sharing their mean rank, luminances below .001 raised to it: -1 if confidence falls wherever the error grows, 0 if it says nothing; none if one is constant; its interval keeps the ranks fixed",
        "https://en.wikipedia.org/wiki/Spearman%27s_rank_correlation_coefficient";
    "sparsification", "Error of the trusted half", "", Lower, Q::TrustedAndWholeError, S::Ratio,
        "mean |difference of the log luminances| of the half with the highest confidence / that of all, luminances below .001 raised to it; equal confidences share the half's last places: 1 if confidence says nothing",
        "https://arxiv.org/abs/1802.07095";
    "deviation_68", "Error over stated deviation, 68 %", "", One, Q::ErrorOverDeviation(1), S::Quantile(0.6827),
        "68.27 % quantile of |p-g| over the stated standard deviation, root mean square over channels: 1 if the deviations are right, more if they are too small",
        "https://en.wikipedia.org/wiki/68%E2%80%9395%E2%80%9399.7_rule";
    "deviation_95", "Error over two stated deviations, 95 %", "", One, Q::ErrorOverDeviation(2), S::Quantile(0.9545),
        "95.45 % quantile of |p-g| over two stated standard deviations, root mean square over channels: 1 if the deviations are right, more if they are too small",
        "https://en.wikipedia.org/wiki/68%E2%80%9395%E2%80%9399.7_rule";
    "psnr_lin_unbiased", "PSNR without noise, linear", "dB", Higher, Q::CrossProduct, S::UnbiasedPsnr,
        "-10 log10 of the mean over pixels and channels of (a-b)(a'-b') of linear values, a and b being the means of independent halves of the samples of p and g, a' and b' those of the others: what noise adds to (p-g)² has the mean 0 in it; peak 1; 100 where nothing is left",
        "https://en.wikipedia.org/wiki/Mean_squared_error";
    "psnr_srgb_unbiased", "PSNR without noise", "dB", Higher, Q::CrossProductSrgb, S::UnbiasedPsnr,
        "-10 log10 of the mean over pixels and channels of (a-b)(a'-b') of sRGB values clipped to [0, 1], a and b being the means of independent halves of the samples of p and g, a' and b' those of the others; the curve of noisy values is bent, and unequal noise of p and g leaves a bias; peak 1; 100 where nothing is left",
        "https://en.wikipedia.org/wiki/Mean_squared_error";
    "chromaticity_deg", "Chromaticity error", "°", Lower, Q::ColourAngle, S::Mean,
        "mean angle between the linear colours p and g, whatever their intensity; 90 where one is black",
        "https://en.wikipedia.org/wiki/Color_constancy";
    "log_rmse", "Log error after one factor", "", Lower, Q::LogError, S::Spread,
        "standard deviation of the difference of the log luminances, which is their RMSE after the one factor that makes it least; luminances below .001 raised to it",
        "https://arxiv.org/abs/1406.2283";
    "log_ratio_rms", "Log ratio", "", Lower, Q::SquaredLogError, S::RootMean,
        "square root of the mean of ln(p/g)²; values below .001 raised to it",
        "https://en.wikipedia.org/wiki/Root_mean_square_deviation";
    "detail_slope_1_2", "Detail at 1 to 2 texels", "", One, Q::Band(1), S::Slope,
        "slope of the regression of p on g, both log luminances between Gaussian means over the region of sigma 1 and 2 texels, cut off at 3 sigma; luminances below .001 raised to it",
        "https://en.wikipedia.org/wiki/Difference_of_Gaussians";
    "detail_slope_2_4", "Detail at 2 to 4 texels", "", One, Q::Band(2), S::Slope,
        "slope of the regression of p on g, both log luminances between Gaussian means over the region of sigma 2 and 4 texels, cut off at 3 sigma; luminances below .001 raised to it",
        "https://en.wikipedia.org/wiki/Difference_of_Gaussians";
    "relief_invented", "Invented relief", "°", Lower, Q::InventedRelief, S::Ratio,
        "mean angle between p and the mesh's normal where g is within .5° of it; none where g is so nowhere",
        "https://arxiv.org/abs/1411.4734";
    "psnr_srgb_area", "PSNR over the surface", "dB", Higher, Q::AreaSquaredErrorSrgb, S::PsnrOfRatio,
        "-10 log10 of the mean over the surface, every texel by its area, and over channels of (p-g)² of sRGB values clipped to [0, 1]; peak 1; at most 100",
        "https://en.wikipedia.org/wiki/Peak_signal-to-noise_ratio";
    "normal_mean_deg_area", "Mean angle over the surface", "°", Lower, Q::AreaAngle, S::Ratio,
        "mean angle between p and g over the surface, every texel by its area; 90 where p has no length",
        "https://arxiv.org/abs/1411.4734";
    "direction_mean_deg", "Direction error", "°", Lower, Q::Angle, S::Mean,
        "mean angle between two directions",
        "https://arxiv.org/abs/1411.4734";
    "orb_psnr_h", "PSNR-H of Stanford-ORB", "dB", Higher, Q::Compatible(P::OrbHdr), S::PsnrOfPictures,
        "as in Stanford-ORB: p after one factor per channel, both times mean(sRGB of g) / mean(g), clipped to [0, 4], linear; the squared error is divided by the whole frame, background included; no less than the PSNR of a picture of .5; mean over pictures",
        "https://github.com/StanfordORB/Stanford-ORB";
    "orb_psnr_l", "PSNR-L of Stanford-ORB", "dB", Higher, Q::Compatible(P::OrbLdr), S::PsnrOfPictures,
        "as in Stanford-ORB: p after one factor per channel, sRGB values in [0, 1]; the squared error is divided by the whole frame, background included; no less than the PSNR of a picture of .5; mean over pictures",
        "https://github.com/StanfordORB/Stanford-ORB";
    "orb_albedo_psnr", "Albedo PSNR of Stanford-ORB", "dB", Higher, Q::Compatible(P::OrbAlbedo), S::PsnrOfPictures,
        "as in Stanford-ORB, the frame being the texture: p after one factor per channel, linear values in [0, 1]; the squared error is divided by the whole frame; no less than the PSNR of a picture of .5",
        "https://github.com/StanfordORB/Stanford-ORB";
    "owl_psnr", "PSNR of objects-with-lighting", "dB", Higher, Q::Compatible(P::ObjectsWithLighting), S::PsnrOfPictures,
        "as in objects-with-lighting: values to the power 1/2.2 in [0, 1], g of 8 bits; the exposure of p, then a factor from .5 to 2 for each channel, with the least mean absolute error where g is not overexposed; mean over pictures",
        "https://github.com/isl-org/objects-with-lighting";
    "nerfactor_albedo_psnr", "Albedo PSNR of NeRFactor", "dB", Higher, Q::Compatible(P::NerfactorAlbedo), S::PsnrOfPictures,
        "as in NeRFactor, the frame being the texture: p after one factor per channel, clipped to the range of g on white, luma of values to the power 1/2.2; the squared error is divided by the whole frame",
        "https://github.com/google/nerfactor";
    "lpips_alex_0_1", "LPIPS (AlexNet, 0.1)", "", Lower, Q::Perceptual, S::Mean,
        "learned perceptual distance, weights of version 0.1, on AlexNet: sRGB values clipped to [0, 1], black outside the mask, the whole frame; mean over pictures",
        "https://github.com/richzhang/PerceptualSimilarity";
    "lpips_vgg_0_1", "LPIPS (VGG-16, 0.1)", "", Lower, Q::Perceptual, S::Mean,
        "learned perceptual distance, weights of version 0.1, on VGG-16: sRGB values clipped to [0, 1], black outside the mask, the whole frame; mean over pictures",
        "https://github.com/richzhang/PerceptualSimilarity";
};

/// Metrics of each subject, in the order of the rows. A metric in none of these has no row, which
/// `harness/scoring/tests/scores.rs` notices.
pub(crate) mod scored {
    /// Metrics of the diffuse albedo; after the median ratio the first five alone.
    pub(crate) const ALBEDO: [&str; 8] = [
        "psnr_srgb",
        "psnr_lin",
        "relmse",
        "ciede2000_mean",
        "ita_error",
        "ssim",
        "flip_mean",
        "flip_p95",
    ];
    /// Metrics of the diffuse albedo that are blind to its scale.
    pub(crate) const ALBEDO_UNSCALED: [&str; 6] =
        ["scale_global", "hc", "wcorr", "lp", "chromaticity_deg", "log_rmse"];
    /// Metrics of the diffuse albedo's skin that are blind to its scale.
    pub(crate) const DETAIL: [&str; 2] = ["detail_slope_1_2", "detail_slope_2_4"];
    /// Metrics of the diffuse albedo and of a normal map by the area of the texels.
    pub(crate) const ALBEDO_AREA: [&str; 1] = ["psnr_srgb_area"];
    pub(crate) const NORMAL_AREA: [&str; 1] = ["normal_mean_deg_area"];
    /// Metrics of a view or a relit picture along its silhouette, which erosion takes away.
    pub(crate) const SILHOUETTE: [&str; 1] = ["psnr_srgb"];
    /// Metrics of a normal map beside the mesh's.
    pub(crate) const RELIEF: [&str; 1] = ["relief_invented"];
    /// Metrics of the roughness.
    pub(crate) const ROUGHNESS: [&str; 1] = ["log_ratio_rms"];
    /// Metrics of a view or a relit picture by independent halves of its samples.
    pub(crate) const UNBIASED: [&str; 2] = ["psnr_lin_unbiased", "psnr_srgb_unbiased"];
    /// Other benchmarks' metrics of a view or a relit picture as it is, on the eroded and the whole mask.
    pub(crate) const COMPATIBLE: [&str; 2] = ["orb_psnr_h", "orb_psnr_l"];
    pub(crate) const COMPATIBLE_WHOLE: [&str; 1] = ["owl_psnr"];
    /// Other benchmarks' metrics of the diffuse albedo, on the eroded and on the whole coverage.
    pub(crate) const COMPATIBLE_ALBEDO: [&str; 1] = ["orb_albedo_psnr"];
    pub(crate) const COMPATIBLE_ALBEDO_WHOLE: [&str; 1] = ["nerfactor_albedo_psnr"];
    /// Metrics of the light's brightest directions.
    pub(crate) const PEAKS: [&str; 1] = ["direction_mean_deg"];
    /// Metrics of the light in equal solid angles.
    pub(crate) const LIGHT: [&str; 1] = ["log_rmse"];
    /// Metrics of a sphere in the light; the last of a sphere without black places alone.
    pub(crate) const SPHERE: [&str; 3] = ["psnr_srgb", "log_rmse", "chromaticity_deg"];
    /// Metrics of the diffuse albedo against the true diffuse shading and the true specular layer.
    pub(crate) const LEAKAGE: [&str; 2] = ["leakage_shading", "leakage_specular"];
    /// Metrics of the diffuse albedo in one label region; the last of skin alone.
    pub(crate) const PART: [&str; 3] = ["psnr_srgb", "ciede2000_mean", "ita_error"];
    /// Metrics of a normal map.
    pub(crate) const NORMAL: [&str; 6] = [
        "normal_mean_deg",
        "normal_median_deg",
        "normal_below_5",
        "normal_below_11_25",
        "normal_below_22_5",
        "normal_below_30",
    ];
    /// Metrics of the specular albedo; of its best constant the first alone.
    pub(crate) const SPECULAR: [&str; 3] = ["rmse", "pearson", "spearman"];
    /// Metrics of the confidence against the error of the diffuse albedo.
    pub(crate) const CONFIDENCE: [&str; 2] = ["confidence_rank", "sparsification"];
    /// Metrics of the stated deviations of the diffuse albedo.
    pub(crate) const DEVIATION: [&str; 2] = ["deviation_68", "deviation_95"];
    /// Metrics of a view or a relit picture.
    pub(crate) const PICTURE: [&str; 6] =
        ["psnr_srgb", "psnr_lin", "relmse", "ssim", "flip_mean", "flip_p95"];
    /// Metrics of a layer of it.
    pub(crate) const LAYER: [&str; 4] = ["psnr_srgb", "psnr_lin", "pearson", "energy_ratio"];
    /// The metrics of a specular layer whose true specular albedo is constant.
    pub(crate) const LAYER_OF_ONE_ALBEDO: [&str; 3] = ["psnr_srgb", "psnr_lin", "pearson"];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_unique_and_found() {
        for metric in METRICS {
            assert!(std::ptr::eq(Metric::find(metric.id).unwrap(), metric), "{}", metric.id);
        }
        let error = Metric::find("psnr").unwrap_err().to_string();
        assert!(error.contains("\"psnr\"") && error.contains("psnr_srgb"), "{error}");
    }

    #[test]
    fn a_gain_is_positive_towards_the_better() {
        assert!(Direction::Higher.gain(1.0, 2.0) > 0.0 && Direction::Lower.gain(1.0, 2.0) < 0.0);
        assert!(Direction::One.gain(1.2, 0.9) > 0.0 && Direction::One.gain(0.9, 1.2) < 0.0);
    }
}

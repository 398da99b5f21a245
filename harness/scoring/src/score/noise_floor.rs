//! Effect of rendering noise alone on a metric: two pictures of the same scene differ by the
//! Monte Carlo error of both.

use formats::picture::Picture;

use super::rows::Floors;
use crate::metrics::{Quantity, RELATIVE_OFFSET, Region, srgb};

/// Nodes (standard deviations) and weights of the five-point Gauss-Hermite rule for a normal
/// distribution; the sRGB curve and its clipping bend too much for a derivative at one point.
const NODES: [(f64, f64); 5] = [
    (-2.856_970_013_872_806, 0.011_257_411_327_720_69),
    (-1.355_626_179_974_266, 0.222_075_922_005_612_6),
    (0.0, 0.533_333_333_333_333_3),
    (1.355_626_179_974_266, 0.222_075_922_005_612_6),
    (2.856_970_013_872_806, 0.011_257_411_327_720_69),
];

/// Adds a frame's expected squared errors to `floors`. `truth` stands for the mean of both
/// pictures; variances are those of the pixel means (`None`: a picture without noise).
pub(super) fn add_frame(
    floors: &mut Floors,
    truth: &Picture,
    variance: &Picture,
    other_variance: Option<&Picture>,
    region: &Region,
) {
    let channels = truth.channels;
    let per_pixel = |expected: &dyn Fn(f64, f64, f64) -> f64| -> Vec<f64> {
        let of = |picture: &Picture, i: usize| f64::from(picture.data[i]);
        let pixels = region.pixels().iter().map(|pixel| {
            let values = (pixel * channels)..(pixel + 1) * channels;
            let expected = values.map(|i| {
                let other = other_variance.map_or(0.0, |variance| of(variance, i));
                expected(of(truth, i), of(variance, i).max(0.0), other.max(0.0))
            });
            expected.sum::<f64>() / channels as f64
        });
        pixels.collect()
    };
    let srgb_error = per_pixel(&|mean, a, b| {
        let (mean_a, spread_a) = through_curve(mean, a);
        let (mean_b, spread_b) = through_curve(mean, b);
        spread_a + spread_b + (mean_a - mean_b).powi(2)
    });
    let relative = per_pixel(&|mean, a, b| (a + b) / (mean + RELATIVE_OFFSET).powi(2));
    for (quantity, values) in [
        (Quantity::SquaredErrorSrgb, srgb_error),
        (Quantity::SquaredError, per_pixel(&|_, a, b| a + b)),
        (Quantity::RelativeSquaredError, relative),
    ] {
        floors.entry(quantity).or_default().extend(values);
    }
}

/// Mean and variance of the sRGB value of a normally distributed linear one.
fn through_curve(mean: f64, variance: f64) -> (f64, f64) {
    let sigma = variance.sqrt();
    let values = NODES.map(|(node, weight)| (srgb(mean + sigma * node), weight));
    let expected: f64 = values.iter().map(|(value, weight)| weight * value).sum();
    let spread = values.iter().map(|(value, weight)| weight * (value - expected).powi(2)).sum();
    (expected, spread)
}

//! Errors over the standard deviations that a method states.

use super::Pair;

/// The least standard deviation by which an error is divided.
const LEAST: f64 = 1e-6;

/// The root mean square over the channels of |p - g| over the stated standard deviation, at every pixel of the region;
/// `None` without deviations.
pub(super) fn over_deviation(pair: &Pair) -> Option<Vec<f64>> {
    let stated = pair.deviation?;
    let error = |i: &usize| {
        let both = pair.predicted(*i).zip(pair.true_values(*i)).zip(pair.factor);
        let ratios = both.enumerate().map(|(channel, ((p, g), factor))| {
            let stated = stated.data[i * stated.channels + channel % stated.channels];
            (p - g) / (factor * f64::from(stated)).max(LEAST)
        });
        let squares: f64 = ratios.map(|ratio| ratio * ratio).sum();
        (squares / pair.truth.channels as f64).sqrt()
    };
    Some(pair.region().pixels().iter().map(error).collect())
}

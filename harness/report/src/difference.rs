//! Error of one picture or map against its truth, per pixel: the quantities behind the scores.

use formats::picture::{GrayImage, Picture};
use scoring::metrics::{Metric, Pair, Region};

use super::tone::Field;

/// The comparison of two pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Measure {
    /// Root mean square over the channels of the difference of sRGB values in [0, 1].
    Display,
    /// CIEDE2000 of two linear colours (D65).
    ColourDifference,
    /// Absolute difference of a single channel.
    Value,
    /// Angle between two vectors, degrees.
    Angle,
    /// LDR-FLIP of two linear pictures that are black outside the mask, 0 to 1.
    Flip,
}

impl Measure {
    /// The error at the right end of the colour bar, the same for every suite.
    pub fn top(self) -> f32 {
        match self {
            Measure::Display => 0.1,
            Measure::ColourDifference => 6.0,
            Measure::Value => 0.01,
            Measure::Angle => 5.0,
            Measure::Flip => 0.2,
        }
    }

    /// The quantity, as the colour bar names it.
    pub fn label(self) -> &'static str {
        match self {
            Measure::Display => "RMS Δ of sRGB",
            Measure::ColourDifference => "CIEDE2000",
            Measure::Value => "|Δ|",
            Measure::Angle => "angle",
            Measure::Flip => "FLIP",
        }
    }

    /// The unit of the colour bar's numbers.
    pub fn unit(self) -> &'static str {
        if self == Measure::Angle { "°" } else { "" }
    }

    /// The metric whose per-pixel quantity it is, and whether that is the square of the error.
    fn metric(self) -> (&'static str, bool) {
        match self {
            Measure::Display => ("psnr_srgb", true),
            Measure::ColourDifference => ("ciede2000_mean", false),
            Measure::Value => ("rmse", true),
            Measure::Angle => ("normal_mean_deg", false),
            Measure::Flip => ("flip_mean", false),
        }
    }
}

/// The error of `picture` times `factor` inside `mask`, NaN outside.
///
/// `None` if they cannot be compared: the sizes differ, or the mask is empty.
pub(super) fn field(
    picture: &Picture,
    truth: &Picture,
    mask: Option<&GrayImage>,
    measure: Measure,
    factor: f64,
) -> Option<Field> {
    let scaled = |pair: Pair| {
        let (metric, squared) = measure.metric();
        let errors = Metric::find(metric).ok()?.measure(&pair.scaled([factor; 3])).ok()?;
        Some(if squared { errors.iter().map(|square| square.sqrt()).collect() } else { errors })
    };
    compared(picture, truth, mask, scaled)
}

/// The error of `picture` times `factor` over its `stated` standard deviations, as [`field`].
pub(super) fn over_deviation(
    picture: &Picture,
    truth: &Picture,
    stated: &Picture,
    mask: Option<&GrayImage>,
    factor: f64,
) -> Option<Field> {
    compared(picture, truth, mask, |pair| {
        let pair = pair.scaled([factor; 3]).with_deviation(stated).ok()?;
        Metric::find("deviation_68").ok()?.measure(&pair).ok()
    })
}

fn compared<'a>(
    picture: &'a Picture,
    truth: &'a Picture,
    mask: Option<&GrayImage>,
    errors: impl FnOnce(Pair) -> Option<Vec<f64>>,
) -> Option<Field> {
    let (width, height) = (truth.width, truth.height);
    let region = match mask {
        Some(mask) => Region::of_mask("mask", mask),
        None => Region::whole(width, height),
    };
    let region = region.ok()?;
    let errors = errors(Pair::new(picture, truth, &region).ok()?)?;
    let mut values = vec![f32::NAN; width * height];
    for (index, error) in region.pixels().iter().zip(errors) {
        values[*index] = error as f32;
    }
    Some(Field { width, height, values })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(pixel: &[f32]) -> Picture {
        Picture { width: 1, height: 1, channels: pixel.len(), data: pixel.to_vec() }
    }

    fn error(a: &[f32], b: &[f32], measure: Measure) -> f32 {
        field(&one(a), &one(b), None, measure, 1.0).unwrap().values[0]
    }

    #[test]
    fn each_measure_is_the_error_itself_and_not_its_square() {
        let pairs: [(&[f32], &[f32], Measure, f32); 4] = [
            (&[0.0, 1.0, 0.0], &[0.0; 3], Measure::Display, (1.0_f32 / 3.0).sqrt()),
            // Black and white are 100 lightness units apart.
            (&[1.0; 3], &[0.0; 3], Measure::ColourDifference, 100.0),
            (&[0.03], &[0.01], Measure::Value, 0.02),
            (&[3.0, 3.0, 0.0], &[1.0, 0.0, 0.0], Measure::Angle, 45.0),
        ];
        for (a, b, measure, expected) in pairs {
            let found = error(a, b, measure);
            assert!((found / expected - 1.0).abs() < 1e-4, "{measure:?}: {found}");
        }
    }

    #[test]
    fn an_error_of_two_deviations_is_two() {
        let (dark, light, stated) = (one(&[0.1; 3]), one(&[0.28; 3]), one(&[0.02; 3]));
        // Prediction and deviation are scaled together: 0.28 - 0.2 over 0.04.
        let found = over_deviation(&dark, &light, &stated, None, 2.0).unwrap().values[0];
        assert!((found - 2.0).abs() < 1e-4, "{found}");
    }

    #[test]
    fn a_factor_that_undoes_the_difference_leaves_no_error() {
        let (dark, light) = (one(&[0.1, 0.2, 0.3]), one(&[0.2, 0.4, 0.6]));
        for measure in [Measure::Display, Measure::ColourDifference] {
            assert!(field(&dark, &light, None, measure, 1.0).unwrap().values[0] > 0.05);
            assert!(field(&dark, &light, None, measure, 2.0).unwrap().values[0] < 1e-3);
        }
    }

    #[test]
    fn sizes_that_differ_are_not_compared_and_masked_pixels_are_nan() {
        let wide = Picture::new(2, 1, 3);
        assert!(field(&wide, &one(&[0.0; 3]), None, Measure::Display, 1.0).is_none());
        let mask = GrayImage { width: 2, height: 1, data: vec![255, 0] };
        let values = field(&wide, &wide, Some(&mask), Measure::Display, 1.0).unwrap().values;
        assert!(values[0] == 0.0 && values[1].is_nan());
    }
}

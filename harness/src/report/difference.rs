//! Error of one picture or map against its truth, per pixel.

use solver::picture::{GrayImage, Picture};

use super::tone::{Field, srgb};

/// How two pixels are compared, and the error that takes the last colour of the bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Measure {
    /// Mean over the channels of the absolute difference of sRGB values in [0, 1].
    Display,
    /// CIEDE2000 of two linear colours (D65).
    ColourDifference,
    /// Absolute difference of the first channel.
    Value,
    /// Angle between two vectors.
    Angle,
}

impl Measure {
    /// The error at the right end of the colour bar, the same for every suite.
    pub fn top(self) -> f32 {
        match self {
            Measure::Display => 0.15,
            Measure::ColourDifference => 12.0,
            Measure::Value => 0.015,
            Measure::Angle => 20.0,
        }
    }

    /// The quantity, as the colour bar names it.
    pub fn label(self) -> &'static str {
        match self {
            Measure::Display => "mean |Δ| of sRGB",
            Measure::ColourDifference => "CIEDE2000",
            Measure::Value => "|Δ|",
            Measure::Angle => "angle",
        }
    }

    /// The unit of the colour bar's numbers.
    pub fn unit(self) -> &'static str {
        if self == Measure::Angle { "°" } else { "" }
    }

    fn error(self, a: &[f32], b: &[f32]) -> f32 {
        match self {
            Measure::Display => {
                let sum: f32 = a.iter().zip(b).map(|(a, b)| (srgb(*a) - srgb(*b)).abs()).sum();
                sum / a.len() as f32
            }
            Measure::ColourDifference => colour_difference(a, b),
            Measure::Value => (a[0] - b[0]).abs(),
            Measure::Angle => angle_degrees(a, b),
        }
    }
}

fn colour_difference(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(a, b)| (srgb(*a) - srgb(*b)).abs()).sum::<f32>() * 100.0
}

/// From the chord and not the cosine, which is flat where the angle is small.
fn angle_degrees(a: &[f32], b: &[f32]) -> f32 {
    let unit = |v: &[f32]| -> [f64; 3] {
        let length = v.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>().sqrt();
        std::array::from_fn(|c| f64::from(v[c]) / length)
    };
    let (a, b) = (unit(a), unit(b));
    let chord: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    (2.0 * (chord / 2.0).min(1.0).asin()).to_degrees() as f32
}

/// The error of `picture` times `scale` inside `mask`, NaN outside.
///
/// `None` if the sizes differ: photographs are never resampled to be compared.
pub(super) fn field(
    picture: &Picture,
    truth: &Picture,
    mask: Option<&GrayImage>,
    measure: Measure,
    scale: f32,
) -> Option<Field> {
    let (width, height) = (truth.width, truth.height);
    if (picture.width, picture.height, picture.channels) != (width, height, truth.channels)
        || mask.is_some_and(|mask| (mask.width, mask.height) != (width, height))
    {
        return None;
    }
    let mut scaled = vec![0.0; picture.channels];
    let values = (0..width * height)
        .map(|i| {
            if mask.is_some_and(|mask| mask.data[i] == 0) {
                return f32::NAN;
            }
            for (target, value) in scaled.iter_mut().zip(picture.pixel(i % width, i / width)) {
                *target = value * scale;
            }
            measure.error(&scaled, truth.pixel(i % width, i / width))
        })
        .collect();
    Some(Field { width, height, values })
}

/// Samples a map bilinearly at the texel centres of another size, clamped at the border.
pub(super) fn resample(map: &Picture, width: usize, height: usize) -> Picture {
    if (map.width, map.height) == (width, height) {
        return map.clone();
    }
    let mut target = Picture::new(width, height, map.channels);
    let place = |i: usize, from: usize, to: usize| {
        let x = ((i as f32 + 0.5) * from as f32 / to as f32 - 0.5).clamp(0.0, (from - 1) as f32);
        let low = x as usize;
        (low, (low + 1).min(from - 1), x - low as f32)
    };
    for y in 0..height {
        let (top, bottom, down) = place(y, map.height, height);
        for x in 0..width {
            let (left, right, along) = place(x, map.width, width);
            for c in 0..map.channels {
                let mix = |y| {
                    let (a, b) = (map.pixel(left, y)[c], map.pixel(right, y)[c]);
                    a + (b - a) * along
                };
                target.pixel_mut(x, y)[c] = mix(top) + (mix(bottom) - mix(top)) * down;
            }
        }
    }
    target
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
    fn angles_are_right_from_thousandths_of_a_degree_to_a_half_turn() {
        for degrees in [0.001_f64, 1.0, 60.0, 179.0] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let turned = [2.0 * cos as f32, 2.0 * sin as f32, 0.0];
            let found = error(&turned, &[1.0, 0.0, 0.0], Measure::Angle);
            assert!((f64::from(found) / degrees - 1.0).abs() < 1e-3, "{degrees}: {found}");
        }
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

    #[test]
    fn resampling_a_ramp_keeps_it_a_ramp_inside() {
        let ramp = Picture { width: 4, height: 1, channels: 1, data: vec![0.0, 1.0, 2.0, 3.0] };
        let fine = resample(&ramp, 8, 1);
        let expected = [0.0, 0.25, 0.75, 1.25, 1.75, 2.25, 2.75, 3.0];
        assert!(fine.data.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{fine:?}");
    }
}

//! Octave bands of a quantity over a part of a map.

use std::f64::consts::PI;

/// The narrower blur of the finest band, texels (standard deviation). Finer detail is less than two texels wide.
const FINEST: f64 = 0.5;
/// Bands, each an octave, at most.
const COUNT: usize = 6;
/// A wider blur than this share of the side compares no detail but one end of the face with the other.
const WIDEST: f64 = 1.0 / 24.0;

/// The difference of two blurs.
pub(super) struct Band {
    /// Standard deviation of the narrower blur, texels; the wider one has twice as much.
    pub blur: f64,
    pub values: Vec<f64>,
}

impl Band {
    /// Where the band passes most: of exp(-2 π² σ² f²) - exp(-8 π² σ² f²) the maximum lies at
    /// f² = ln 4 / (6 π² σ²).
    pub fn cycles_per_texel(&self) -> f64 {
        (4f64.ln() / 6.0).sqrt() / (PI * self.blur)
    }
}

/// Bands from fine to coarse, of the part of a map that is `inside`; what lies outside has no weight.
pub(super) fn bands(values: &[f64], inside: &[bool], width: usize) -> Vec<Band> {
    let weights: Vec<f64> = inside.iter().map(|inside| f64::from(u8::from(*inside))).collect();
    let masked: Vec<f64> =
        values.iter().zip(inside).map(|(v, inside)| if *inside { *v } else { 0.0 }).collect();
    let blurred = |sigma: f64| -> Vec<f64> {
        let (sum, weight) = (blur(&masked, width, sigma), blur(&weights, width, sigma));
        sum.iter().zip(&weight).map(|(s, w)| if *w > 0.0 { s / w } else { 0.0 }).collect()
    };
    let mut narrow = blurred(FINEST);
    (0..COUNT)
        .map(|at| FINEST * 2f64.powi(at as i32))
        .take_while(|sigma| *sigma <= WIDEST * width as f64)
        .map(|sigma| {
            let wide = blurred(2.0 * sigma);
            let values = narrow.iter().zip(&wide).map(|(narrow, wide)| narrow - wide).collect();
            narrow = wide;
            Band { blur: sigma, values }
        })
        .collect()
}

/// A Gaussian blur, cut at four standard deviations; nothing lies beyond the border.
fn blur(values: &[f64], width: usize, sigma: f64) -> Vec<f64> {
    let reach = (4.0 * sigma).ceil() as isize;
    let kernel: Vec<f64> =
        (-reach..=reach).map(|i| (-0.5 * (i as f64 / sigma).powi(2)).exp()).collect();
    let total: f64 = kernel.iter().sum();
    let height = values.len() / width.max(1);
    let along =
        |values: &[f64], count: usize, place: &dyn Fn(usize, usize) -> usize, lines: usize| {
            let mut out = vec![0.0; values.len()];
            for line in 0..lines {
                for i in 0..count {
                    let mut sum = 0.0;
                    for (weight, step) in kernel.iter().zip(-reach..=reach) {
                        let from = i as isize + step;
                        if (0..count as isize).contains(&from) {
                            sum += weight * values[place(line, from as usize)];
                        }
                    }
                    out[place(line, i)] = sum / total;
                }
            }
            out
        };
    let rows = along(values, width, &|line, i| line * width + i, height);
    along(&rows, height, &|line, i| i * width + line, width)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: usize = 128;

    fn wave(cycles_per_texel: f64) -> Vec<f64> {
        let value = |i: usize| (2.0 * PI * cycles_per_texel * (i % SIDE) as f64).sin();
        (0..SIDE * SIDE).map(value).collect()
    }

    fn energy(band: &Band) -> f64 {
        band.values.iter().map(|value| value * value).sum::<f64>() / (SIDE * SIDE) as f64
    }

    #[test]
    fn a_wave_is_strongest_in_the_band_of_its_frequency_and_has_the_gain_of_the_formula() {
        let everywhere = vec![true; SIDE * SIDE];
        for at in 1..4 {
            let frequency = bands(&wave(0.1), &everywhere, SIDE)[at].cycles_per_texel();
            let found = bands(&wave(frequency), &everywhere, SIDE);
            let strongest =
                (0..found.len()).max_by(|a, b| energy(&found[*a]).total_cmp(&energy(&found[*b])));
            assert_eq!(strongest, Some(at));
            let sigma = found[at].blur;
            let pass = |sigma: f64| (-2.0 * (PI * sigma * frequency).powi(2)).exp();
            let expected = 0.5 * (pass(sigma) - pass(2.0 * sigma)).powi(2);
            assert!((energy(&found[at]) / expected - 1.0).abs() < 0.08, "{at}");
        }
    }

    #[test]
    fn what_lies_outside_changes_nothing_and_a_constant_has_no_bands() {
        let inside: Vec<bool> = (0..SIDE * SIDE).map(|i| i % SIDE < 70).collect();
        let mut values = vec![0.4; SIDE * SIDE];
        for (value, inside) in values.iter_mut().zip(&inside) {
            if !inside {
                *value = f64::NAN;
            }
        }
        for band in bands(&values, &inside, SIDE) {
            let within = band.values.iter().zip(&inside).filter(|(_, inside)| **inside);
            assert!(within.into_iter().all(|(value, _)| value.abs() < 1e-12));
        }
    }
}

//! Octave bands of a quantity over a part of a map.

use std::f64::consts::PI;

use scoring::metrics::gaussian;

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
    /// The peak of the band: the maximum of exp(-2 π² σ² f²) - exp(-8 π² σ² f²) lies at
    /// f² = ln 4 / (6 π² σ²).
    pub fn cycles_per_texel(&self) -> f64 {
        (4f64.ln() / 6.0).sqrt() / (PI * self.blur)
    }
}

/// The bands of quantities over the part of a map that is inside; what lies outside has no weight.
pub(super) struct Bands<'a> {
    inside: &'a [bool],
    width: usize,
    /// Standard deviations, each twice the one before, and how much of the blur lies inside.
    blurs: Vec<(f64, Vec<f64>)>,
}

impl<'a> Bands<'a> {
    pub fn new(inside: &'a [bool], width: usize) -> Bands<'a> {
        let weights: Vec<f64> = inside.iter().map(|inside| f64::from(u8::from(*inside))).collect();
        let narrower = |sigma: &f64| *sigma <= WIDEST * width as f64;
        let blurs = (0..COUNT).map(|at| FINEST * 2f64.powi(at as i32)).take_while(narrower);
        let blurs = std::iter::once(FINEST).chain(blurs.map(|sigma| 2.0 * sigma));
        let blurs = blurs.map(|sigma| (sigma, blur(&weights, width, sigma))).collect();
        Bands { inside, width, blurs }
    }

    /// From fine to coarse.
    pub fn of(&self, values: &[f64]) -> Vec<Band> {
        let inside = values.iter().zip(self.inside);
        let masked: Vec<f64> = inside.map(|(v, inside)| if *inside { *v } else { 0.0 }).collect();
        let blurred = |(sigma, weights): &(f64, Vec<f64>)| -> Vec<f64> {
            let sums = blur(&masked, self.width, *sigma);
            sums.iter().zip(weights).map(|(s, w)| if *w > 0.0 { s / w } else { 0.0 }).collect()
        };
        let mut narrow = blurred(&self.blurs[0]);
        let band = |pair: &[(f64, Vec<f64>)]| {
            let wide = blurred(&pair[1]);
            let values = narrow.iter().zip(&wide).map(|(narrow, wide)| narrow - wide).collect();
            narrow = wide;
            Band { blur: pair[0].0, values }
        };
        self.blurs.windows(2).map(band).collect()
    }
}

/// A Gaussian blur, cut at four standard deviations.
fn blur(values: &[f64], width: usize, sigma: f64) -> Vec<f64> {
    gaussian(values, width, values.len() / width.max(1), sigma, (4.0 * sigma).ceil() as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: usize = 128;

    /// Whole half periods, which the mirror at the border continues.
    fn wave(half_periods: usize) -> Vec<f64> {
        let phase = |i: usize| PI * half_periods as f64 * ((i % SIDE) as f64 + 0.5) / SIDE as f64;
        (0..SIDE * SIDE).map(|i| phase(i).cos()).collect()
    }

    fn energy(band: &Band) -> f64 {
        band.values.iter().map(|value| value * value).sum::<f64>() / (SIDE * SIDE) as f64
    }

    #[test]
    fn a_wave_is_strongest_in_the_band_of_its_frequency_and_has_the_gain_of_the_formula() {
        let everywhere = vec![true; SIDE * SIDE];
        let bands = Bands::new(&everywhere, SIDE);
        for at in 1..4 {
            let centre = bands.of(&wave(10))[at].cycles_per_texel();
            let half_periods = (centre * 2.0 * SIDE as f64).round() as usize;
            let frequency = half_periods as f64 / (2.0 * SIDE as f64);
            let found = bands.of(&wave(half_periods));
            let strongest =
                (0..found.len()).max_by(|a, b| energy(&found[*a]).total_cmp(&energy(&found[*b])));
            assert_eq!(strongest, Some(at));
            let sigma = found[at].blur;
            let pass = |sigma: f64| (-2.0 * (PI * sigma * frequency).powi(2)).exp();
            let expected = 0.5 * (pass(sigma) - pass(2.0 * sigma)).powi(2);
            assert!((energy(&found[at]) / expected - 1.0).abs() < 0.02, "{at}");
        }
    }

    #[test]
    fn texels_outside_change_nothing_and_a_constant_has_no_bands() {
        let inside: Vec<bool> = (0..SIDE * SIDE).map(|i| i % SIDE < 70).collect();
        let mut values = vec![0.4; SIDE * SIDE];
        for (value, inside) in values.iter_mut().zip(&inside) {
            if !inside {
                *value = f64::NAN;
            }
        }
        for band in Bands::new(&inside, SIDE).of(&values) {
            let within = band.values.iter().zip(&inside).filter(|(_, inside)| **inside);
            assert!(within.into_iter().all(|(value, _)| value.abs() < 1e-12));
        }
    }
}

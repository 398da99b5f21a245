//! What pictures show, on the highlights that are predicted and on how these change with what is solved for: a step
//! of Gauss and Newton for the specular term of every region.
//!
//! Within a texel, what varies from view to view is hardly diffuse, so that what all its samples share is left out.

use std::ops::Range;

use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::transport::{CHANNELS, SpecularTerm};

/// Predicted highlights, R, G, B: by reflectance, and their derivatives by the logarithms of the other parts of a
/// [`SpecularTerm`].
pub(super) type Predicted = [[f32; CHANNELS]; SpecularTerm::ROWS];

/// Sums over the samples of a texel.
#[derive(Clone, Copy, Default)]
struct Sums {
    count: f64,
    weight: f64,
    /// Moments of predicted and shown highlights, channel by channel.
    moments: [Moments; CHANNELS],
    view: u32,
    /// Whether more than one view sees it.
    shared: bool,
}

#[derive(Clone, Copy, Default)]
struct Moments {
    predicted: [f64; SpecularTerm::ROWS],
    shown: f64,
    products: [[f64; SpecularTerm::ROWS]; SpecularTerm::ROWS],
    both: [f64; SpecularTerm::ROWS],
    shown_squared: f64,
}

/// The regression, within the texels that several views see, without the samples where the sensor was full. What is
/// shown may hold what is the same all over a texel.
pub(super) struct Regression {
    /// In the order of the texels; those without samples are left out.
    texels: Vec<(usize, Sums)>,
}

impl Regression {
    /// Both in linear radiance; the samples count by `weight`.
    pub fn new(
        samples: &Samples,
        weight: &Planes,
        predicted: impl Fn(usize) -> Predicted,
        shown: impl Fn(usize) -> [f32; CHANNELS],
    ) -> Self {
        let full = full(samples);
        let is_used = |i: &usize| {
            let target: [f32; CHANNELS] = samples.target.sample(*i, 0);
            weight.get(0, *i) != 0.0 && target.iter().all(|t| *t < full)
        };
        let mut order: Vec<usize> = (0..samples.len()).filter(is_used).collect();
        order.sort_by_key(|i| samples.taps.nearest(*i));
        let mut texels: Vec<(usize, Sums)> = vec![];
        for i in order {
            let (weight, view) = (f64::from(weight.get(0, i)), samples.view_index[i]);
            let at = samples.taps.nearest(i);
            if texels.last().is_none_or(|(last, _)| *last != at) {
                texels.push((at, Sums::default()));
            }
            let Some((_, sums)) = texels.last_mut() else { continue };
            sums.shared |= sums.count > 0.0 && sums.view != view;
            sums.view = view;
            sums.count += 1.0;
            sums.weight += weight;
            let (predicted, shown) = (predicted(i), shown(i));
            for (c, moments) in sums.moments.iter_mut().enumerate() {
                let s = f64::from(shown[c]);
                let p = predicted.map(|row| f64::from(row[c]));
                for k in 0..SpecularTerm::ROWS {
                    moments.predicted[k] += weight * p[k];
                    moments.both[k] += weight * (p[k] * s);
                    (0..SpecularTerm::ROWS)
                        .for_each(|l| moments.products[k][l] += weight * (p[k] * p[l]));
                }
                moments.shown += weight * s;
                moments.shown_squared += weight * (s * s);
            }
        }
        Self { texels }
    }

    /// Over the texels `within` and some channels.
    pub fn fit(&self, within: impl Fn(usize) -> bool, channels: Range<usize>) -> Fit {
        let mut fit = Fit { freedom: -1.0, ..Fit::default() };
        let shared = self.texels.iter().filter(|(at, sums)| sums.shared && within(*at));
        for (_, Sums { count, weight, moments, .. }) in shared {
            fit.freedom += count - 1.0;
            for m in &moments[channels.clone()] {
                for k in 0..SpecularTerm::ROWS {
                    fit.both[k] += m.both[k] - m.predicted[k] * m.shown / weight;
                    for l in 0..SpecularTerm::ROWS {
                        fit.products[k][l] +=
                            m.products[k][l] - m.predicted[k] * m.predicted[l] / weight;
                    }
                }
                fit.shown += m.shown_squared - m.shown * m.shown / weight;
            }
        }
        fit
    }
}

/// Sums of squares and products around the means of the texels.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Fit {
    products: [[f64; SpecularTerm::ROWS]; SpecularTerm::ROWS],
    both: [f64; SpecularTerm::ROWS],
    shown: f64,
    freedom: f64,
}

impl Fit {
    /// Slope on the highlights themselves and its standard error; `None` of too little.
    pub fn slope(&self) -> Option<(f64, f64)> {
        let (both, predicted) = (self.both[0], self.products[0][0]);
        let slope = both / predicted;
        let error = ((self.shown - slope * both).max(0.0) / (self.freedom * predicted)).sqrt();
        (slope.is_finite() && error.is_finite()).then_some((slope, error))
    }

    /// What the logarithm of the roughness is to be moved by and its standard error, with the reflectance free;
    /// `None` of too little. Far from the true roughness the derivative explains nearly all that is shown, and the
    /// highlights themselves nothing: they count as a tenth of what they explain alone, so that the step is long.
    pub fn rougher(&self) -> Option<(f64, f64)> {
        let [[hh, hr], [_, rr]] = self.products;
        let [h, r] = self.both;
        let determinant = hh * rr - hr * hr;
        let (by_h, by_r) = ((rr * h - hr * r) / determinant, (hh * r - hr * h) / determinant);
        let left = (self.shown - by_h * h - by_r * r).max(0.0) / self.freedom;
        let strength = by_h.max(0.1 * h / hh);
        let (step, error) = (by_r / strength, (left * hh / determinant).sqrt() / strength);
        (strength > 0.0 && step.is_finite() && error.is_finite()).then_some((step, error))
    }
}

/// The value of a full sensor in the pictures: their largest one, if it occurs more than once.
fn full(samples: &Samples) -> f32 {
    let values = || (0..samples.len()).flat_map(|i| samples.target.sample::<CHANNELS>(i, 0));
    let largest = values().fold(f32::MIN, f32::max);
    let more = values().filter(|value| *value == largest).nth(1);
    more.unwrap_or(f32::INFINITY)
}

//! Regression of the observed on the predicted highlights and on their derivatives: a Gauss-Newton step for the
//! specular term of every region.
//!
//! Diffuse radiance does not depend on the view, so the mean over the samples of a texel is subtracted. Under several
//! illuminations it is an albedo times the shading, so the projection onto the shading is subtracted.

use std::ops::Range;

use crate::model::planes::Planes;
use crate::model::samples::Samples;
use crate::transport::{CHANNELS, SpecularTerm};

/// Predicted highlights, R, G, B, and their derivatives with respect to the logarithms of the other parts of a
/// [`SpecularTerm`].
pub(super) type Predicted = [[f32; CHANNELS]; SpecularTerm::ROWS];

/// Sums over the samples of a texel.
#[derive(Clone, Copy, Default)]
struct TexelSums {
    count: f64,
    /// Moments of predicted and observed highlights, channel by channel.
    moments: [Moments; CHANNELS],
    view: u32,
    has_several_views: bool,
}

#[derive(Clone, Copy, Default)]
struct Moments {
    /// The squared basis of the diffuse radiance, and its products with predicted and observed highlights.
    basis: f64,
    predicted: [f64; SpecularTerm::ROWS],
    observed: f64,
    products: [[f64; SpecularTerm::ROWS]; SpecularTerm::ROWS],
    cross: [f64; SpecularTerm::ROWS],
    observed_squared: f64,
}

/// The regression within the texels that several views see, without saturated samples. A constant within a texel, such
/// as its diffuse radiance, does not change it.
pub(super) struct Regression {
    /// Texels with samples, ascending.
    texels: Vec<(usize, TexelSums)>,
}

impl Regression {
    /// Predicted and observed radiance of every sample, linear, with the weight of every sample. The diffuse radiance
    /// of a texel is a multiple of `basis`, R, G, B of every sample; `None` is a constant.
    pub fn new(
        samples: &Samples,
        weight: &Planes,
        basis: Option<&Planes>,
        predicted: impl Fn(usize) -> Predicted,
        observed: impl Fn(usize) -> [f32; CHANNELS],
    ) -> Self {
        let saturation = saturation_level(samples);
        let is_used = |i: &usize| {
            let target: [f32; CHANNELS] = samples.target.sample(*i, 0);
            weight.get(0, *i) != 0.0 && target.iter().all(|t| *t < saturation)
        };
        let mut order: Vec<usize> = (0..samples.len()).filter(is_used).collect();
        order.sort_by_key(|i| samples.taps.nearest(*i));
        let mut texels: Vec<(usize, TexelSums)> = vec![];
        for i in order {
            let (weight, view) = (f64::from(weight.get(0, i)), samples.view_index[i]);
            let at = samples.taps.nearest(i);
            if texels.last().is_none_or(|(last, _)| *last != at) {
                texels.push((at, TexelSums::default()));
            }
            let Some((_, sums)) = texels.last_mut() else { continue };
            sums.has_several_views |= sums.count > 0.0 && sums.view != view;
            sums.view = view;
            sums.count += 1.0;
            let (predicted, observed) = (predicted(i), observed(i));
            for (c, moments) in sums.moments.iter_mut().enumerate() {
                let basis = basis.map_or(1.0, |basis| f64::from(basis.get(c, i)));
                let o = f64::from(observed[c]);
                moments.basis += weight * (basis * basis);
                let p = predicted.map(|row| f64::from(row[c]));
                for k in 0..SpecularTerm::ROWS {
                    moments.predicted[k] += weight * (basis * p[k]);
                    moments.cross[k] += weight * (p[k] * o);
                    (0..SpecularTerm::ROWS)
                        .for_each(|l| moments.products[k][l] += weight * (p[k] * p[l]));
                }
                moments.observed += weight * (basis * o);
                moments.observed_squared += weight * (o * o);
            }
        }
        Self { texels }
    }

    /// Sums over the texels `within`, in some channels.
    pub fn sums(&self, within: impl Fn(usize) -> bool, channels: Range<usize>) -> RegressionSums {
        let mut sums = RegressionSums { degrees_of_freedom: -1.0, ..RegressionSums::default() };
        let texels = self.texels.iter().filter(|(at, t)| t.has_several_views && within(*at));
        for (_, TexelSums { count, moments, .. }) in texels {
            sums.degrees_of_freedom += count - 1.0;
            for m in moments[channels.clone()].iter().filter(|m| m.basis > 0.0) {
                for k in 0..SpecularTerm::ROWS {
                    sums.cross[k] += m.cross[k] - m.predicted[k] * m.observed / m.basis;
                    for l in 0..SpecularTerm::ROWS {
                        sums.products[k][l] +=
                            m.products[k][l] - m.predicted[k] * m.predicted[l] / m.basis;
                    }
                }
                sums.observed += m.observed_squared - m.observed * m.observed / m.basis;
            }
        }
        sums
    }
}

/// Sums of squares and products of the differences to the means of the texels.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RegressionSums {
    products: [[f64; SpecularTerm::ROWS]; SpecularTerm::ROWS],
    cross: [f64; SpecularTerm::ROWS],
    observed: f64,
    degrees_of_freedom: f64,
}

impl RegressionSums {
    /// The slope on the predicted highlights and its standard error; `None` without enough data.
    pub fn slope(&self) -> Option<(f64, f64)> {
        let (cross, predicted) = (self.cross[0], self.products[0][0]);
        let slope = cross / predicted;
        let residual = (self.observed - slope * cross).max(0.0);
        let error = (residual / (self.degrees_of_freedom * predicted)).sqrt();
        (slope.is_finite() && error.is_finite()).then_some((slope, error))
    }

    /// The step of the logarithm of the roughness and its standard error, for any reflectance; `None` without enough
    /// data. Far from the true roughness, the derivative explains nearly all variation and the slope on the highlights
    /// is close to 0. The slope is then a tenth of its value without the derivative, which gives a long step.
    pub fn log_roughness_step(&self) -> Option<(f64, f64)> {
        let [[hh, hr], [_, rr]] = self.products;
        let [h, r] = self.cross;
        let determinant = hh * rr - hr * hr;
        let (by_h, by_r) = ((rr * h - hr * r) / determinant, (hh * r - hr * h) / determinant);
        let residual_variance =
            (self.observed - by_h * h - by_r * r).max(0.0) / self.degrees_of_freedom;
        let strength = by_h.max(0.1 * h / hh);
        let error = (residual_variance * hh / determinant).sqrt() / strength;
        let step = by_r / strength;
        (strength > 0.0 && step.is_finite() && error.is_finite()).then_some((step, error))
    }
}

/// The value of saturated pixels: the largest value of the pictures, if it occurs more than once.
fn saturation_level(samples: &Samples) -> f32 {
    let values = || (0..samples.len()).flat_map(|i| samples.target.sample::<CHANNELS>(i, 0));
    let largest = values().fold(f32::MIN, f32::max);
    let second = values().filter(|value| *value == largest).nth(1);
    second.unwrap_or(f32::INFINITY)
}

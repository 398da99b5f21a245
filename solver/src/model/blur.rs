//! A separable Gaussian blur and its exact adjoint.

use crate::convolution::{Shape, convolve, gaussian};
use crate::simd::widened;

/// A Gaussian blur of square interleaved textures; near the border the remaining weights are scaled to sum to one.
#[derive(Clone, Debug)]
pub struct Blur {
    size: usize,
    channels: usize,
    /// Weights from the centre outwards; they reach three standard deviations.
    kernel: Vec<f32>,
    /// One over the sum of the weights inside the texture, by column (and by row).
    norms: Vec<f32>,
    /// `norms`, repeated for every value of a row.
    scales: Vec<f32>,
}

impl Blur {
    /// `sigma` is the standard deviation in texels; zero leaves textures as they are.
    pub fn new(size: usize, channels: usize, sigma: f32) -> Self {
        let kernel = gaussian(sigma);
        let reach = kernel.len() - 1;
        let inside = |at: usize| {
            let (first, last) = (at.saturating_sub(reach), (at + reach).min(size - 1));
            (first..=last).map(|other| kernel[other.abs_diff(at)]).sum::<f32>()
        };
        let norms: Vec<f32> = (0..size).map(|at| 1.0 / inside(at)).collect();
        let scales = norms.iter().flat_map(|norm| vec![*norm; channels]).collect();
        Self { size, channels, kernel, norms, scales }
    }

    /// Weights from the centre outwards, before they are scaled.
    pub(crate) fn kernel(&self) -> &[f32] {
        &self.kernel
    }

    /// One over the sum of the weights inside the texture, for every column (and row).
    pub(crate) fn norms(&self) -> &[f32] {
        &self.norms
    }

    /// Texels to which a weight reaches, in a row or column.
    pub fn reach(&self) -> usize {
        self.kernel.len() - 1
    }

    /// The blurred texture.
    pub fn apply(&self, texture: &[f32]) -> Vec<f32> {
        let line = self.size * self.channels;
        let read =
            |row: usize, out: &mut [f32]| out.copy_from_slice(&texture[row * line..][..line]);
        convolve(&self.kernel, self.shape(), read, |row, values| self.scale(row, values))
    }

    /// The transpose of [`Blur::apply`]: carries a gradient from the blurred texture to the texture.
    pub fn adjoint(&self, gradient: &[f32]) -> Vec<f32> {
        // apply = N K with K symmetric and N diagonal, so the transpose is K N.
        let line = self.size * self.channels;
        let read = |row: usize, out: &mut [f32]| {
            out.copy_from_slice(&gradient[row * line..][..line]);
            self.scale(row, out);
        };
        convolve(&self.kernel, self.shape(), read, |_, _| {})
    }

    fn shape(&self) -> Shape {
        Shape { width: self.size, height: self.size, channels: self.channels }
    }

    fn scale(&self, row: usize, values: &mut [f32]) {
        scale(values, &self.scales, self.norms[row]);
    }
}

widened! {
    fn scale(values: &mut [f32], columns: &[f32], row: f32) {
        for (value, column) in values.iter_mut().zip(columns) {
            *value *= row * column;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_stay_and_zero_sigma_is_the_identity() {
        let constant = vec![0.7; 9 * 9 * 2];
        let blurred = Blur::new(9, 2, 1.5).apply(&constant);
        assert!(blurred.iter().all(|v| (v - 0.7).abs() < 1e-6));
        let ramp: Vec<f32> = (0..16).map(|v| v as f32).collect();
        assert_eq!(Blur::new(4, 1, 0.0).apply(&ramp), ramp);
    }

    #[test]
    fn an_impulse_becomes_the_gaussian() {
        let mut impulse = vec![0.0; 21 * 21];
        impulse[10 * 21 + 10] = 1.0;
        let blurred = Blur::new(21, 1, 2.0).apply(&impulse);
        let expected = |d: f64| (-0.5 * d * d / 4.0).exp();
        let sum: f64 = (-6..=6).map(|d| expected(f64::from(d))).sum();
        for (d, at) in [(0.0, 10 * 21 + 10), (3.0, 10 * 21 + 13), (2.0, 8 * 21 + 10)] {
            let want = expected(d) * expected(0.0) / (sum * sum);
            assert!((f64::from(blurred[at]) - want).abs() < 1e-6, "{} {want}", blurred[at]);
        }
    }

    #[test]
    fn the_adjoint_is_the_transpose() {
        let (size, channels) = (7, 3);
        let blur = Blur::new(size, channels, 1.3);
        let noise = |seed: f32| -> Vec<f32> {
            (0..size * size * channels).map(|i| ((i as f32 + seed) * 12.9898).sin()).collect()
        };
        let (x, y) = (noise(0.0), noise(100.0));
        let dot = |a: &[f32], b: &[f32]| -> f64 {
            a.iter().zip(b).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum()
        };
        let (left, right) = (dot(&blur.apply(&x), &y), dot(&x, &blur.adjoint(&y)));
        assert!((left - right).abs() < 1e-5, "{left} {right}");
    }
}

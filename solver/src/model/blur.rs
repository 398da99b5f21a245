//! A separable Gaussian blur and its exact adjoint.

use rayon::prelude::*;

/// Gaussian blur of square interleaved textures; near the border the weights that remain are
/// scaled to sum to one.
#[derive(Clone, Debug)]
pub struct Blur {
    size: usize,
    channels: usize,
    /// Weights from the centre outwards; they reach three standard deviations.
    kernel: Vec<f32>,
    /// One over the sum of the weights inside the texture, by column (and by row).
    norms: Vec<f32>,
}

impl Blur {
    /// `sigma` is the standard deviation in texels; zero leaves textures as they are.
    pub fn new(size: usize, channels: usize, sigma: f32) -> Self {
        let reach = (3.0 * sigma).ceil() as usize;
        let weight =
            |d: usize| if d == 0 { 1.0 } else { (-0.5 * (d as f32 / sigma).powi(2)).exp() };
        let kernel: Vec<f32> = (0..=reach).map(weight).collect();
        let inside = |at: usize| {
            let (first, last) = (at.saturating_sub(reach), (at + reach).min(size - 1));
            (first..=last).map(|other| kernel[other.abs_diff(at)]).sum::<f32>()
        };
        let norms = (0..size).map(|at| 1.0 / inside(at)).collect();
        Self { size, channels, kernel, norms }
    }

    /// Weights from the centre outwards, before they are scaled.
    pub(crate) fn kernel(&self) -> &[f32] {
        &self.kernel
    }

    /// Of every column (and row), one over the sum of the weights inside the texture.
    pub(crate) fn norms(&self) -> &[f32] {
        &self.norms
    }

    /// The blurred texture.
    pub fn apply(&self, texture: &[f32]) -> Vec<f32> {
        let mut out = self.vertical(&self.horizontal(texture));
        self.scale(&mut out);
        out
    }

    /// The transpose of [`Blur::apply`]: carries a gradient from the blurred texture to the texture.
    pub fn adjoint(&self, gradient: &[f32]) -> Vec<f32> {
        // apply = N K with K symmetric and N diagonal, so the transpose is K N.
        let mut scaled = gradient.to_vec();
        self.scale(&mut scaled);
        self.horizontal(&self.vertical(&scaled))
    }

    fn scale(&self, texture: &mut [f32]) {
        let lines = texture.par_chunks_mut(self.size * self.channels);
        lines.zip(&self.norms).for_each(|(line, row)| {
            for (texel, column) in line.chunks_exact_mut(self.channels).zip(&self.norms) {
                texel.iter_mut().for_each(|value| *value *= row * column);
            }
        });
    }

    fn horizontal(&self, texture: &[f32]) -> Vec<f32> {
        let length = self.size * self.channels;
        let mut out = vec![0.0; texture.len()];
        out.par_chunks_mut(length).zip(texture.par_chunks(length)).for_each(|(out, line)| {
            for (distance, weight) in self.kernel.iter().enumerate() {
                let shift = (distance * self.channels).min(length);
                add_scaled(&mut out[..length - shift], &line[shift..], *weight);
                if distance > 0 {
                    add_scaled(&mut out[shift..], &line[..length - shift], *weight);
                }
            }
        });
        out
    }

    fn vertical(&self, texture: &[f32]) -> Vec<f32> {
        let length = self.size * self.channels;
        let line = |row: usize| &texture[row * length..][..length];
        let mut out = vec![0.0; texture.len()];
        out.par_chunks_mut(length).enumerate().for_each(|(row, out)| {
            for (distance, weight) in self.kernel.iter().enumerate() {
                if row + distance < self.size {
                    add_scaled(out, line(row + distance), *weight);
                }
                if distance > 0 && row >= distance {
                    add_scaled(out, line(row - distance), *weight);
                }
            }
        });
        out
    }
}

/// sum += factor x values; as wide as the machine allows, with the same result everywhere, since
/// products and sums are rounded one by one.
fn add_scaled(sum: &mut [f32], values: &[f32], factor: f32) {
    #[inline(always)]
    fn body(sum: &mut [f32], values: &[f32], factor: f32) {
        for (sum, value) in sum.iter_mut().zip(values) {
            *sum += factor * value;
        }
    }
    #[cfg(target_arch = "x86_64")]
    {
        #[target_feature(enable = "avx2")]
        fn avx2(sum: &mut [f32], values: &[f32], factor: f32) {
            body(sum, values, factor);
        }
        if is_x86_feature_detected!("avx2") {
            // SAFETY: AVX2 was just found.
            return unsafe { avx2(sum, values, factor) };
        }
    }
    body(sum, values, factor);
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

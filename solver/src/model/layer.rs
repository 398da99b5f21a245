//! A layer that is linear in one texture: its loss, and the gradient with respect to the texture, in one pass.

use glam::{Vec4, Vec4Swizzles};
use rayon::prelude::*;

use super::planes::Planes;
use super::samples::Samples;
use super::strips::Strip;
use crate::simd::{prefetch, widened};

/// Distance of the prefetch, samples: the prefetchers of some processors are too late.
const AHEAD: usize = 64;

/// The constants of every sample, 32 bytes: the factors on the texture's R, G, B and the addend; the target's R, G, B
/// and the weight.
pub struct Layer(Vec<[Vec4; 2]>);

impl Layer {
    /// `shading` has the rows of the factors and of the addend.
    pub fn new(samples: &Samples, shading: &Planes) -> Self {
        let known = |i: usize| {
            let [r, g, b, added]: [f32; 4] = shading.sample(i, 0);
            let [red, green, blue]: [f32; 3] = samples.target.sample(i, 0);
            let weight = samples.weight.get(0, i);
            [Vec4::new(r, g, b, added), Vec4::new(red, green, blue, weight)]
        };
        Self((0..samples.len()).into_par_iter().map(known).collect())
    }

    /// The constants of a sample.
    pub fn known(&self, sample: usize) -> [Vec4; 2] {
        self.0[sample]
    }

    /// The weighted mean absolute residual, and its gradient with respect to the texture (R, G, B). A residual is
    /// carried back to the four texels that the sample blends, with the same weights.
    pub fn gradient(&self, samples: &Samples, texture: &[f32]) -> (f64, Vec<f32>) {
        let taps = &samples.taps;
        let scale = 1.0 / (3.0 * samples.len() as f32);
        let (gradient, sums) =
            taps.by_strip(|strip| strip_gradient(strip, texture.as_chunks().0, &self.0, scale));
        (sums.iter().sum::<f64>() * f64::from(scale), gradient)
    }
}

/// Two adjacent texels; the fourth value belongs to neither.
#[inline(always)]
fn pair(texels: &[[f32; 3]], at: usize) -> [Vec4; 2] {
    let both = texels[at..at + 2].as_flattened();
    [Vec4::from_slice(both), Vec4::from_slice(&both[2..]).yzwx()]
}

#[inline(always)]
fn add(texels: &mut [[f32; 3]], at: usize, sums: [Vec4; 2]) {
    for (texel, sum) in texels[at..at + 2].iter_mut().zip(sums) {
        for (value, more) in texel.iter_mut().zip(sum.to_array()) {
            *value += more;
        }
    }
}

widened! {
    /// Adds the gradients of a strip's samples to its texels, and returns the sum of the loss. The four texels of a
    /// cell and their sums stay in registers during its samples.
    fn strip_gradient(
        strip: &mut Strip<3>,
        texels: &[[f32; 3]],
        known: &[[Vec4; 2]],
        scale: f32,
    ) -> f64 {
        let size = strip.taps.size();
        let samples = strip.samples.clone();
        let cells = &strip.taps.cells()[samples.clone()];
        let fractions = &strip.taps.fractions()[samples.clone()];
        let known = &known[samples];
        assert!(fractions.len() == cells.len() && known.len() == cells.len());
        let mut sum = 0.0;
        let mut sample = 0;
        while sample < cells.len() {
            let cell = cells[sample];
            let [left, right] = pair(texels, cell as usize);
            let [below_left, below_right] = pair(texels, cell as usize + size);
            let (down_left, down_right) = (below_left - left, below_right - right);
            let (mut upper, mut lower, mut loss) = ([Vec4::ZERO; 2], [Vec4::ZERO; 2], Vec4::ZERO);
            while sample < cells.len() && cells[sample] == cell {
                prefetch(known.as_ptr().wrapping_add(sample + AHEAD));
                prefetch(fractions.as_ptr().wrapping_add(sample + AHEAD));
                let [fx, fy] = fractions[sample];
                let [factor, target] = known[sample];
                let (left, right) = (left + fy * down_left, right + fy * down_right);
                let value = left + fx * (right - left);
                let residual = value * factor + factor.w - target;
                let weight = target.w;
                loss += weight * residual.abs();
                let by_value = weight * scale * factor;
                let by_value = Vec4::select(
                    residual.cmpeq(Vec4::ZERO),
                    Vec4::ZERO,
                    by_value * Vec4::ONE.copysign(residual),
                );
                let by_side = [(1.0 - fx) * by_value, fx * by_value];
                for side in 0..2 {
                    upper[side] += (1.0 - fy) * by_side[side];
                    lower[side] += fy * by_side[side];
                }
                sample += 1;
            }
            sum += f64::from(loss.x + loss.y + loss.z);
            let at = cell as usize - strip.first * size;
            add(strip.texels, at, upper);
            match (at + size).checked_sub(strip.texels.len()) {
                None => add(strip.texels, at + size, lower),
                Some(at) => add(strip.below, at, lower),
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::model::taps::Taps;

    const COUNT: usize = 20000;

    fn noise(i: usize, from: f32) -> f32 {
        ((i as f32 + 1.0) * from).sin().abs().fract()
    }

    fn noises<const R: usize>(from: f32) -> Planes {
        Planes::from_fn(COUNT, |i| std::array::from_fn::<f32, R, _>(|row| noise(i + row, from)))
    }

    /// More samples than a block, and cells with many of them, few and none, on more rows than a strip has.
    #[test]
    fn the_gradient_is_the_sum_over_independent_samples() {
        const SIDE: usize = 300;
        let uv = |i: usize| Vec2::new(noise(i, 12.9898).powi(3), noise(i, 78.233));
        let taps = Taps::sorted(SIDE, &(0..COUNT).map(uv).collect::<Vec<_>>()).0;
        let (target, weight, shading) = (noises::<3>(3.7), noises::<1>(5.1), noises::<4>(7.3));
        let pixel = vec![0; COUNT];
        let samples = Samples { target, weight, taps, pixel, ..Samples::none(SIDE) };
        let texture: Vec<f32> = (0..3 * SIDE * SIDE).map(|i| noise(i, 0.37)).collect();

        let values = samples.taps.sample::<3>(&texture);
        let left = Planes::from_fn(COUNT, |i| {
            let (target, value): ([f32; 3], [f32; 3]) =
                (samples.target.sample(i, 0), values.sample(i, 0));
            let [r, g, b, added]: [f32; 4] = shading.sample(i, 0);
            let factor = [r, g, b];
            std::array::from_fn::<f32, 3, _>(|c| value[c] * factor[c] + added - target[c])
        });
        let weight = |i: usize| samples.weight.get(0, i) / (3.0 * COUNT as f32);
        let by_value = Planes::from_fn(COUNT, |i| {
            std::array::from_fn::<f32, 3, _>(|c| {
                weight(i) * left.get(c, i).signum() * shading.get(c, i)
            })
        });
        let expected = samples.taps.gather::<3>(&by_value, 0);
        let sum =
            |i: usize| (0..3).map(|c| f64::from(weight(i) * left.get(c, i).abs())).sum::<f64>();
        let sum: f64 = (0..COUNT).map(sum).sum();

        let (loss, gradient) = Layer::new(&samples, &shading).gradient(&samples, &texture);
        assert!((loss - sum).abs() < 1e-5 * sum, "{loss} {sum}");
        let largest = expected.iter().fold(0.0, |a: f32, b| a.max(b.abs()));
        for (found, expected) in gradient.iter().zip(&expected) {
            assert!((found - expected).abs() < 1e-5 * largest, "{found} {expected}");
        }
    }
}

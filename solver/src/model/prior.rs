//! The prior on the diffuse albedo, equation (2): piecewise constancy.

use rayon::prelude::*;

use crate::simd::widened;
use crate::transport::CHANNELS;

/// Rows that one task works through.
const ROWS: usize = 16;
/// Independent sums, which a compiler turns into vectors.
const LANES: usize = 8;

/// `weight` times the average over texels and channels of sqrt(1 + |du A|) - 1 + sqrt(1 + |dv A|)
/// - 1 with differences to the next texel; its gradient is added to `gradient`.
pub fn albedo_prior(albedo: &[f32], size: usize, weight: f32, gradient: &mut [f32]) -> f64 {
    if weight == 0.0 {
        return 0.0;
    }
    let line = size * CHANNELS;
    let scale = weight / albedo.len() as f32;
    let task = |(task, gradient): (usize, &mut [f32])| {
        // Slopes to the texel on the right, to the row below and from the row above.
        let mut across = vec![0.0; line];
        let [mut below, mut above] = [vec![0.0; line], vec![0.0; line]];
        let first = task * ROWS;
        let row = |y: usize| &albedo[y * line..][..line];
        if first > 0 {
            slopes(row(first - 1), row(first), &mut above);
        }
        let mut sum = 0.0;
        for (y, gradient) in (first..).zip(gradient.chunks_exact_mut(line)) {
            sum += slopes(row(y), &row(y)[CHANNELS..], &mut across);
            match y + 1 < size {
                true => sum += slopes(row(y), row(y + 1), &mut below),
                false => below.fill(0.0),
            }
            pull(gradient, &across, &above, &below, scale);
            std::mem::swap(&mut above, &mut below);
        }
        sum
    };
    let sums: Vec<f64> = gradient.par_chunks_mut(ROWS * line).enumerate().map(task).collect();
    f64::from(weight) * sums.iter().sum::<f64>() / albedo.len() as f64
}

widened! {
    /// Writes the derivatives of the penalty with respect to the differences `b` - `a`, and returns the sum of the
    /// penalties.
    fn slopes(a: &[f32], b: &[f32], slopes: &mut [f32]) -> f64 {
        let mut sums = [0.0f64; LANES];
        let ((a, a_rest), (b, b_rest)) = (a[..b.len()].as_chunks::<LANES>(), b.as_chunks::<LANES>());
        let (out, out_rest) = slopes[..a.len() * LANES + a_rest.len()].as_chunks_mut::<LANES>();
        for ((a, b), out) in a.iter().zip(b).zip(out) {
            for lane in 0..LANES {
                let (penalty, slope) = penalty(b[lane] - a[lane]);
                out[lane] = slope;
                sums[lane] += f64::from(penalty);
            }
        }
        let mut sum: f64 = sums.iter().sum();
        for ((a, b), out) in a_rest.iter().zip(b_rest).zip(out_rest) {
            let (penalty, slope) = penalty(b - a);
            *out = slope;
            sum += f64::from(penalty);
        }
        sum
    }
}

widened! {
    /// Adds what a row's texels gain from their four differences.
    fn pull(gradient: &mut [f32], across: &[f32], above: &[f32], below: &[f32], scale: f32) {
        let line = gradient.len();
        let (across, above, below) = (&across[..line], &above[..line], &below[..line]);
        for x in 0..CHANNELS.min(line) {
            gradient[x] += scale * (above[x] - below[x] - across[x]);
        }
        let before = across.iter();
        let rest = gradient.iter_mut().zip(above).zip(below).zip(across).skip(CHANNELS);
        for ((((gradient, above), below), after), before) in rest.zip(before) {
            *gradient += scale * (above - below + (before - after));
        }
    }
}

/// sqrt(1 + |d|) - 1 and its derivative, zero where it has none.
#[inline(always)]
fn penalty(difference: f32) -> (f32, f32) {
    let root = (1.0 + difference.abs()).sqrt();
    let slope = (0.5 / root).copysign(difference);
    (root - 1.0, if difference == 0.0 { 0.0 } else { slope })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texture() -> Vec<f32> {
        (0..5 * 5 * 3).map(|i| (i as f32 * 1.7).sin()).collect()
    }

    #[test]
    fn the_value_is_the_formula_written_out() {
        let albedo = texture();
        let at = |x: usize, y: usize, c: usize| f64::from(albedo[(y * 5 + x) * 3 + c]);
        let mut sum = 0.0;
        for y in 0..5 {
            for x in 0..5 {
                for c in 0..3 {
                    let mut add = |d: f64| sum += (1.0 + d.abs()).sqrt() - 1.0;
                    if x < 4 {
                        add(at(x + 1, y, c) - at(x, y, c));
                    }
                    if y < 4 {
                        add(at(x, y + 1, c) - at(x, y, c));
                    }
                }
            }
        }
        let value = albedo_prior(&albedo, 5, 0.3, &mut vec![0.0; albedo.len()]);
        assert!((value - 0.3 * sum / 75.0).abs() < 1e-8, "{value}");
    }

    #[test]
    fn the_gradient_matches_central_differences() {
        let albedo = texture();
        let mut gradient = vec![0.0; albedo.len()];
        albedo_prior(&albedo, 5, 10.0, &mut gradient);
        for at in [0, 17, 36, 74] {
            let value = |step: f32| {
                let mut moved = albedo.clone();
                moved[at] += step;
                albedo_prior(&moved, 5, 10.0, &mut vec![0.0; albedo.len()])
            };
            let numeric = (value(1e-2) - value(-1e-2)) / 2e-2;
            // The step is far from every kink of this texture; f32 leaves about 1e-4.
            assert!((numeric - f64::from(gradient[at])).abs() < 5e-4, "{numeric} {}", gradient[at]);
        }
    }
}

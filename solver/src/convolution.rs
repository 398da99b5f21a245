//! Separable convolution with a symmetric kernel; what lies outside the picture is zero.
//!
//! Columns are convolved into one row's buffer, which is convolved in its turn: a value is read from
//! memory about once and written once, everything between stays in the cache.

use rayon::prelude::*;

use crate::simd::widened;

/// Rows that one task works through.
const ROWS: usize = 8;
/// Values that are summed up together, in registers.
const TILE: usize = 32;

/// Columns, rows and interleaved channels.
#[derive(Clone, Copy)]
pub struct Shape {
    pub width: usize,
    pub height: usize,
    pub channels: usize,
}

/// A Gaussian's weights from the centre outwards, to three standard deviations; 1 at the centre.
pub fn gaussian(sigma: f32) -> Vec<f32> {
    let weight = |d: usize| if d == 0 { 1.0 } else { (-0.5 * (d as f32 / sigma).powi(2)).exp() };
    (0..=(3.0 * sigma).ceil() as usize).map(weight).collect()
}

/// Convolves with `kernel`, the weights from the centre outwards. Rows are weighted by `weight`; what
/// lies between the two passes and what comes out of a row is passed to `between` and `after`.
pub fn convolve(
    picture: &[f32],
    kernel: &[f32],
    shape: Shape,
    weight: impl Fn(usize) -> f32 + Sync,
    between: impl Fn(usize, &mut [f32]) + Sync,
    after: impl Fn(usize, &mut [f32]) + Sync,
) -> Vec<f32> {
    if kernel.len() == 1 {
        return picture.to_vec();
    }
    let Shape { width, height, channels } = shape;
    let (line, reach) = (width * channels, kernel.len() - 1);
    let margin = reach * channels;
    let mut out = vec![0.0; picture.len()];
    out.par_chunks_mut(ROWS * line).enumerate().for_each(|(task, out)| {
        let mut padded = vec![0.0; line + 2 * margin];
        for (row, out) in (task * ROWS..).zip(out.chunks_exact_mut(line)) {
            let rows = row.saturating_sub(reach)..(row + reach + 1).min(height);
            let tap = |other: usize| {
                let tap = kernel[other.abs_diff(row)] * weight(other);
                (&picture[other * line..][..line], tap)
            };
            let lines: Vec<(&[f32], f32)> = rows.map(tap).collect();
            let middle = &mut padded[margin..margin + line];
            weighted_sum(middle, &lines);
            between(row, middle);
            horizontal(out, &padded, kernel, channels);
            after(row, out);
        }
    });
    out
}

widened! {
    /// out = sum of weight x line, a few vectors at a time.
    fn weighted_sum(out: &mut [f32], lines: &[(&[f32], f32)]) {
        let (whole, rest) = out.as_chunks_mut::<TILE>();
        let done = whole.len() * TILE;
        for (tile, out) in whole.iter_mut().enumerate() {
            let mut sum = [0.0f32; TILE];
            for (line, weight) in lines {
                let line = &line[tile * TILE..][..TILE];
                for lane in 0..TILE {
                    sum[lane] += weight * line[lane];
                }
            }
            *out = sum;
        }
        rest.fill(0.0);
        for (line, weight) in lines {
            for (sum, value) in rest.iter_mut().zip(&line[done..]) {
                *sum += weight * value;
            }
        }
    }
}

widened! {
    /// Convolves a line with zeros on either side.
    fn horizontal(out: &mut [f32], padded: &[f32], kernel: &[f32], channels: usize) {
        let middle = (kernel.len() - 1) * channels;
        for (tile, out) in out.chunks_mut(TILE).enumerate() {
            let at = middle + tile * TILE;
            let mut sum = [0.0f32; TILE];
            for (sum, value) in sum.iter_mut().zip(&padded[at..at + out.len()]) {
                *sum = kernel[0] * value;
            }
            for (distance, weight) in kernel.iter().enumerate().skip(1) {
                let shift = distance * channels;
                let left = &padded[at - shift..][..out.len()];
                let right = &padded[at + shift..][..out.len()];
                if out.len() == TILE {
                    // A known length keeps the sums in registers.
                    let (left, right) = (&left[..TILE], &right[..TILE]);
                    for lane in 0..TILE {
                        sum[lane] += weight * (left[lane] + right[lane]);
                    }
                } else {
                    for ((sum, left), right) in sum.iter_mut().zip(left).zip(right) {
                        *sum += weight * (left + right);
                    }
                }
            }
            out.copy_from_slice(&sum[..out.len()]);
        }
    }
}

//! Separable convolution with a symmetric kernel; what lies outside the picture is zero.
//!
//! Columns are convolved into one row's buffer, which is convolved in its turn: a value is read from
//! memory about once and written once, everything between stays in the cache.

use rayon::prelude::*;

use crate::simd::widened;

/// Rows that are summed up together, and that one task works through.
const ROWS: usize = 4;
/// Values of a row that are summed up together.
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
    let stride = line + 2 * margin;
    out.par_chunks_mut(ROWS * line).enumerate().for_each(|(task, out)| {
        // Zeros on either side stand for what lies outside the picture.
        let mut padded = vec![0.0; ROWS * stride];
        let first = task * ROWS;
        let rows = first.saturating_sub(reach)..(first + ROWS + reach).min(height);
        let lines: Vec<(&[f32], [f32; ROWS])> = rows
            .map(|row| {
                let tap = |to: usize| kernel.get(row.abs_diff(first + to)).unwrap_or(&0.0);
                let taps = std::array::from_fn(|to| tap(to) * weight(row));
                (&picture[row * line..][..line], taps)
            })
            .collect();
        columns(&mut padded[margin..], stride, line, &lines);
        for (row, out) in out.chunks_exact_mut(line).enumerate() {
            let padded = &mut padded[row * stride..][..stride];
            between(first + row, &mut padded[margin..margin + line]);
            horizontal(out, padded, kernel, channels);
            after(first + row, out);
        }
    });
    out
}

/// One vector of most machines.
type Eight = [f32; 8];

#[inline(always)]
fn add_scaled(sum: &mut Eight, factor: f32, values: Eight) {
    for lane in 0..8 {
        sum[lane] += factor * values[lane];
    }
}

widened! {
    /// Rows of sums, `stride` apart in `out`: each the sum of its weight times every line. A line is
    /// read once for all rows.
    fn columns(out: &mut [f32], stride: usize, length: usize, lines: &[(&[f32], [f32; ROWS])]) {
        let whole = length / 16 * 16;
        for at in (0..whole).step_by(16) {
            let mut sums = [[[0.0f32; 8]; 2]; ROWS];
            for (line, weights) in lines {
                let (tile, _) = line[at..at + 16].as_chunks::<8>();
                for (sums, weight) in sums.iter_mut().zip(weights) {
                    add_scaled(&mut sums[0], *weight, tile[0]);
                    add_scaled(&mut sums[1], *weight, tile[1]);
                }
            }
            for (row, sums) in sums.iter().enumerate() {
                out[row * stride + at..][..16].copy_from_slice(sums.as_flattened());
            }
        }
        for row in 0..ROWS {
            for at in whole..length {
                let mut sum = 0.0;
                for (line, weights) in lines {
                    sum += weights[row] * line[at];
                }
                out[row * stride + at] = sum;
            }
        }
    }
}

widened! {
    /// Convolves a line with zeros on either side.
    fn horizontal(out: &mut [f32], padded: &[f32], kernel: &[f32], channels: usize) {
        let middle = (kernel.len() - 1) * channels;
        let (tiles, rest) = out.as_chunks_mut::<TILE>();
        let done = tiles.len() * TILE;
        for (tile, out) in tiles.iter_mut().enumerate() {
            let at = middle + tile * TILE;
            let mut sums = [[0.0f32; 8]; TILE / 8];
            let (here, _) = padded[at..at + TILE].as_chunks::<8>();
            for (sum, here) in sums.iter_mut().zip(here) {
                add_scaled(sum, kernel[0], *here);
            }
            for (distance, weight) in kernel.iter().enumerate().skip(1) {
                let shift = distance * channels;
                let (left, _) = padded[at - shift..at - shift + TILE].as_chunks::<8>();
                let (right, _) = padded[at + shift..at + shift + TILE].as_chunks::<8>();
                for (sum, (left, right)) in sums.iter_mut().zip(left.iter().zip(right)) {
                    let mut both = *left;
                    add_scaled(&mut both, 1.0, *right);
                    add_scaled(sum, *weight, both);
                }
            }
            out.copy_from_slice(sums.as_flattened());
        }
        for (x, out) in rest.iter_mut().enumerate() {
            let at = middle + done + x;
            let mut sum = kernel[0] * padded[at];
            for (distance, weight) in kernel.iter().enumerate().skip(1) {
                sum += weight * (padded[at - distance * channels] + padded[at + distance * channels]);
            }
            *out = sum;
        }
    }
}

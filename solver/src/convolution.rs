//! Separable convolution with a symmetric kernel; zero outside the picture.
//!
//! A task works downwards: every row is convolved once, into a ring of as many lines as the kernel reaches
//! over, and the columns of the ring are summed up. A value is read from memory about once, in the order in
//! which memory runs, and written once; the ring stays in the cache.

use std::ops::Range;

use crate::parallel::from_parts;
use crate::simd::widened;

/// Rows that are summed up together, in registers; and one after the other, with lines that stay in the
/// nearest cache, where they are as long as this.
const ROWS: usize = 4;
const GROUP: usize = 2 * ROWS;
const NEAR: usize = 128;
/// Values of a row that are summed up together: of a line, of the lines of the ring.
const TILE: usize = 32;
const HALF: usize = 16;
/// Tasks per thread. (They share nothing, so that their number does not matter to the result.)
const TASKS: usize = 2;

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

/// Convolves rows that `read` fills with `kernel`, the weights from the centre outwards (1 at the centre). Rows of the
/// result are passed to `after`. Both get a row's number and its values.
pub fn convolve(
    kernel: &[f32],
    shape: Shape,
    read: impl Fn(usize, &mut [f32]) + Sync,
    after: impl Fn(usize, &mut [f32]) + Sync,
) -> Vec<f32> {
    let Shape { width, height, channels } = shape;
    let line = width * channels;
    // The rows above and below a task's are convolved for its neighbours as well.
    let rows = height.div_ceil(TASKS * rayon::current_num_threads()).max(4 * kernel.len());
    let rows = rows.next_multiple_of(GROUP);
    let task = |task: usize, out: &mut [f32]| {
        let mut sums = Downwards::new(kernel, shape);
        for (row, out) in (task * rows..).zip(out.chunks_exact_mut(line)) {
            out.copy_from_slice(sums.row(row, &read));
            after(row, out);
        }
    };
    from_parts(height * line, rows * line, task).0
}

/// Rows of the result, asked for downwards.
struct Downwards<'a> {
    kernel: &'a [f32],
    shape: Shape,
    /// Values of a line in whole tiles; and from line to line: so many more that lines, which would be a power
    /// of two apart, do not compete for the same places of the cache.
    length: usize,
    stride: usize,
    /// A row, with the kernel's reach on either side; zeros stand for what lies outside the picture.
    padded: Vec<f32>,
    /// Convolved rows; row y is line y % lines.
    ring: Vec<f32>,
    lines: usize,
    /// The rows that are in the ring, or have been.
    seen: Range<usize>,
    /// [`ROWS`] rows of sums, and their rows.
    sums: Vec<f32>,
    summed: Range<usize>,
    /// For each line of a sum, the row where it begins and its weights in the rows.
    taps: [Vec<(usize, [f32; ROWS])>; GROUP / ROWS],
}

impl<'a> Downwards<'a> {
    /// Starts with the kernel of [`convolve`].
    fn new(kernel: &'a [f32], shape: Shape) -> Self {
        let reach = kernel.len() - 1;
        let length = (shape.width * shape.channels).next_multiple_of(TILE);
        let (stride, lines) = (length + HALF, 2 * reach + GROUP);
        Self {
            kernel,
            shape,
            length,
            stride,
            padded: vec![0.0; length + 2 * reach * shape.channels],
            ring: vec![0.0; lines * stride],
            lines,
            seen: 0..0,
            sums: vec![0.0; GROUP * stride],
            summed: 0..0,
            taps: std::array::from_fn(|_| Vec::with_capacity(2 * reach + ROWS)),
        }
    }

    /// A row of the result.
    fn row(&mut self, row: usize, read: impl Fn(usize, &mut [f32])) -> &[f32] {
        if !self.summed.contains(&row) {
            self.sum(row / GROUP * GROUP, read);
        }
        let sums = &self.sums[(row - self.summed.start) * self.stride..];
        &sums[..self.shape.width * self.shape.channels]
    }

    /// Sums up the rows from `first` on.
    fn sum(&mut self, first: usize, read: impl Fn(usize, &mut [f32])) {
        let Self { kernel, lines, stride, .. } = *self;
        let reach = kernel.len() - 1;
        let rows = first.saturating_sub(reach)..(first + GROUP + reach).min(self.shape.height);
        for row in rows.start.max(self.seen.end)..rows.end {
            self.convolve(row, &read);
        }
        self.seen = rows;
        self.summed = first..first + GROUP;
        for (first, taps) in self.summed.clone().step_by(ROWS).zip(&mut self.taps) {
            let rows = first.saturating_sub(reach)..(first + ROWS + reach).min(self.shape.height);
            taps.clear();
            taps.extend(rows.map(|row| {
                let tap = |to: usize| *kernel.get(row.abs_diff(first + to)).unwrap_or(&0.0);
                (row % lines * stride, std::array::from_fn(tap))
            }));
        }
        for start in (0..self.length).step_by(NEAR) {
            let values = start..self.length.min(start + NEAR);
            for (sums, taps) in self.sums.chunks_exact_mut(ROWS * stride).zip(&self.taps) {
                vertical(sums, stride, values.clone(), &self.ring, taps);
            }
        }
    }

    /// Brings a row of the picture to the ring.
    fn convolve(&mut self, row: usize, read: impl Fn(usize, &mut [f32])) {
        let Shape { width, channels, .. } = self.shape;
        let margin = (self.kernel.len() - 1) * channels;
        read(row, &mut self.padded[margin..margin + width * channels]);
        let line = &mut self.ring[row % self.lines * self.stride..][..self.length];
        horizontal(line, &self.padded, self.kernel, channels);
    }
}

/// One vector, or two or four narrower ones.
type Sixteen = [f32; HALF];

#[inline(always)]
fn add_scaled(sum: &mut Sixteen, factor: f32, values: &Sixteen) {
    for lane in 0..HALF {
        sum[lane] += factor * values[lane];
    }
}

widened! {
    /// Rows of sums, `stride` apart: each the sum of its weight times every line of the ring. A line is
    /// read once for all rows.
    fn vertical(
        sums: &mut [f32],
        stride: usize,
        values: Range<usize>,
        ring: &[f32],
        lines: &[(usize, [f32; ROWS])],
    ) {
        for at in values.step_by(HALF) {
            let mut tile = [[0.0f32; HALF]; ROWS];
            for (line, weights) in lines {
                let Some(values) = ring[line + at..].first_chunk() else { return };
                for (sums, weight) in tile.iter_mut().zip(weights) {
                    add_scaled(sums, *weight, values);
                }
            }
            for (row, tile) in tile.iter().enumerate() {
                sums[row * stride + at..][..HALF].copy_from_slice(tile);
            }
        }
    }
}

widened! {
    /// Convolves a line of whole tiles, with the kernel's reach on either side.
    fn horizontal(out: &mut [f32], padded: &[f32], kernel: &[f32], channels: usize) {
        let middle = (kernel.len() - 1) * channels;
        for (tile, out) in out.as_chunks_mut::<TILE>().0.iter_mut().enumerate() {
            let at = middle + tile * TILE;
            let mut sums = [[0.0f32; HALF]; TILE / HALF];
            let (here, _) = padded[at..at + TILE].as_chunks();
            for (sum, here) in sums.iter_mut().zip(here) {
                add_scaled(sum, kernel[0], here);
            }
            for (distance, weight) in kernel.iter().enumerate().skip(1) {
                let shift = distance * channels;
                let (left, _) = padded[at - shift..at - shift + TILE].as_chunks::<HALF>();
                let (right, _) = padded[at + shift..at + shift + TILE].as_chunks::<HALF>();
                for (sum, (left, right)) in sums.iter_mut().zip(left.iter().zip(right)) {
                    let mut both = *left;
                    for lane in 0..HALF {
                        both[lane] += right[lane];
                    }
                    add_scaled(sum, *weight, &both);
                }
            }
            out.copy_from_slice(sums.as_flattened());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture with more rows than a task and than the ring has lines.
    #[test]
    fn it_is_the_explicit_sum() {
        let (width, height, channels) = (300, 70, 2);
        let shape = Shape { width, height, channels };
        let picture: Vec<f32> = (0..width * height * 2).map(|i| (i as f32 * 0.7).sin()).collect();
        let kernel = gaussian(1.0);
        let twice = |row: usize, values: &mut [f32]| {
            let line = &picture[row * width * channels..][..width * channels];
            values.iter_mut().zip(line).for_each(|(value, read)| *value = 2.0 * read);
        };
        let mark = |row: usize, values: &mut [f32]| {
            values.iter_mut().for_each(|value| *value += row as f32);
        };
        let all = convolve(&kernel, shape, twice, mark);
        let weight = |a: usize, b: usize| kernel.get(a.abs_diff(b)).map_or(0.0, |w| f64::from(*w));
        for (x, y, c) in [(0, 0, 0), (255, 30, 1), (256, 31, 0), (299, 69, 1), (210, 35, 0)] {
            let mut sum = y as f64;
            for (v, u) in (0..height).flat_map(|v| (0..width).map(move |u| (v, u))) {
                let value = f64::from(picture[(v * width + u) * channels + c]);
                sum += 2.0 * weight(y, v) * weight(x, u) * value;
            }
            let got = f64::from(all[(y * width + x) * channels + c]);
            assert!((got - sum).abs() < 1e-5, "{x} {y}: {got} {sum}");
        }
    }
}

//! Separable convolution with a symmetric kernel; what lies outside the picture is zero.
//!
//! A task works downwards: every row is convolved once, into a ring of as many lines as the kernel reaches
//! over, and the columns of the ring are summed up. A value is read from memory about once, in the order in
//! which memory runs, and written once; the ring stays in the cache.

use std::mem::MaybeUninit;
use std::ops::Range;

use rayon::prelude::*;

use crate::region::{Place, Region};
use crate::simd::widened;

/// Rows that are summed up together, in registers; and one after the other, with lines that stay in the
/// nearest cache, where they are as long as this.
const ROWS: usize = 4;
const GROUP: usize = 2 * ROWS;
const NEAR: usize = 128;
/// Values of a row that are summed up together: of a line, of the lines of the ring. What is asked for is
/// rounded up to as many columns.
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

/// Convolves with `kernel`, the weights from the centre outwards (1 at the centre). What is read, and
/// what comes out, is passed to `before` and `after`: the row, the first column, values. What is not in
/// the region may be zero.
pub fn convolve(
    picture: &[f32],
    kernel: &[f32],
    shape: Shape,
    region: &Region,
    before: impl Fn(usize, usize, &mut [f32]) + Sync,
    after: impl Fn(usize, usize, &mut [f32]) + Sync,
) -> Vec<f32> {
    let mut out = Vec::with_capacity(picture.len());
    let read = |row: usize, column: usize, values: &mut [f32]| {
        let first = (row * shape.width + column) * shape.channels;
        values.copy_from_slice(&picture[first..first + values.len()]);
        before(row, column, values);
    };
    let write = |place: &Place, values: &mut [f32], out: &mut &mut [MaybeUninit<f32>]| {
        after(place.row, place.columns.start, values);
        let inside = place.within(shape.channels);
        out.iter_mut().for_each(|out| _ = out.write(0.0));
        out[inside].iter_mut().zip(values).for_each(|(out, value)| _ = out.write(*value));
    };
    let line = shape.width * shape.channels;
    let rows = out.spare_capacity_mut()[..picture.len()].chunks_mut(line).collect();
    convolve_into(rows, kernel, shape, region, read, write);
    // SAFETY: all rows were written.
    unsafe { out.set_len(picture.len()) };
    out
}

/// The same from what `read` fills in (the row, the first column, values) to what `write` does with it
/// for each of the `rows`, whether or not there are values.
fn convolve_into<O: Send>(
    mut rows: Vec<O>,
    kernel: &[f32],
    shape: Shape,
    region: &Region,
    read: impl Fn(usize, usize, &mut [f32]) + Sync,
    write: impl Fn(&Place, &mut [f32], &mut O) + Sync,
) {
    // The rows above and below a task's are convolved for its neighbours as well.
    let count = rows.len().div_ceil(TASKS * rayon::current_num_threads()).max(4 * kernel.len());
    let count = count.next_multiple_of(GROUP);
    rows.par_chunks_mut(count).enumerate().for_each(|(task, rows)| {
        let mut sums = Downwards::new(kernel, shape, region);
        for (row, out) in (task * count..).zip(rows) {
            let (first, values) = sums.row(row, &read);
            let columns = first..first + values.len() / shape.channels;
            write(&Place { row, columns }, values, out);
        }
    });
}

/// Rows of the result, asked for downwards.
struct Downwards<'a> {
    kernel: &'a [f32],
    shape: Shape,
    region: &'a Region,
    /// Values from line to line: with what fills up the last tile; and so many more that lines, which would
    /// be a power of two apart, do not compete for the same places of the cache.
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
    /// Of these, the values that were asked for.
    inside: Range<usize>,
    /// Of the lines of a sum: where it begins, and its weights in the rows.
    taps: [Vec<(usize, [f32; ROWS])>; GROUP / ROWS],
}

impl<'a> Downwards<'a> {
    /// With a kernel as [`convolve`] takes it.
    fn new(kernel: &'a [f32], shape: Shape, region: &'a Region) -> Self {
        let (reach, length) = (kernel.len() - 1, shape.width * shape.channels);
        let (stride, lines) = (length.next_multiple_of(TILE) + HALF, 2 * reach + GROUP);
        Self {
            kernel,
            shape,
            region,
            stride,
            padded: vec![0.0; stride + 2 * reach * shape.channels],
            ring: vec![0.0; lines * stride],
            lines,
            seen: 0..0,
            sums: vec![0.0; GROUP * stride],
            summed: 0..0,
            inside: 0..0,
            taps: std::array::from_fn(|_| Vec::with_capacity(2 * reach + ROWS)),
        }
    }

    /// What some rows have of the region, in whole tiles of `columns`: values of a line.
    fn inside(&self, rows: Range<usize>, columns: usize) -> Range<usize> {
        let Range { start, end } = self.region.columns(rows.start..rows.end.min(self.shape.height));
        if start >= end {
            return 0..0;
        }
        let tile = columns * self.shape.channels;
        start / columns * tile..(end.div_ceil(columns) * tile).min(self.stride - HALF)
    }

    /// A row of the result: the first column, and values from there on. They may be changed, once: what is
    /// asked for again is what was left.
    fn row(&mut self, row: usize, read: impl Fn(usize, usize, &mut [f32])) -> (usize, &mut [f32]) {
        if !self.summed.contains(&row) {
            self.sum(row / GROUP * GROUP, read);
        }
        let Shape { width, channels, .. } = self.shape;
        let Range { start, end } = self.inside;
        let sums = &mut self.sums[(row - self.summed.start) * self.stride..];
        (start / channels, &mut sums[start..end.min(width * channels)])
    }

    /// Sums up the rows from `first` on.
    fn sum(&mut self, first: usize, read: impl Fn(usize, usize, &mut [f32])) {
        let Self { kernel, lines, stride, .. } = *self;
        let reach = kernel.len() - 1;
        let rows = first.saturating_sub(reach)..(first + GROUP + reach).min(self.shape.height);
        for row in rows.start.max(self.seen.end)..rows.end {
            self.convolve(row, &read);
        }
        self.seen = rows;
        self.summed = first..first + GROUP;
        self.inside = self.inside(self.summed.clone(), HALF);
        for (first, taps) in self.summed.clone().step_by(ROWS).zip(&mut self.taps) {
            let rows = first.saturating_sub(reach)..(first + ROWS + reach).min(self.shape.height);
            taps.clear();
            taps.extend(rows.map(|row| {
                let tap = |to: usize| *kernel.get(row.abs_diff(first + to)).unwrap_or(&0.0);
                (row % lines * stride, std::array::from_fn(tap))
            }));
        }
        for start in self.inside.clone().step_by(NEAR) {
            let values = start..self.inside.end.min(start + NEAR);
            for (sums, taps) in self.sums.chunks_exact_mut(ROWS * stride).zip(&self.taps) {
                vertical(sums, stride, values.clone(), &self.ring, taps);
            }
        }
    }

    /// Brings a row of the picture to the ring: what will be summed up of it.
    fn convolve(&mut self, row: usize, read: impl Fn(usize, usize, &mut [f32])) {
        let Shape { width, channels, .. } = self.shape;
        let reach = self.kernel.len() - 1;
        let near = (reach + GROUP).next_multiple_of(GROUP);
        let inside = self.inside(row.saturating_sub(near)..row + near, TILE);
        if inside.is_empty() {
            return;
        }
        let from = (inside.start / channels).saturating_sub(reach);
        let to = (inside.end.div_ceil(channels) + reach).min(width);
        read(row, from, &mut self.padded[(from + reach) * channels..(to + reach) * channels]);
        let margins = inside.start..inside.end + 2 * reach * channels;
        let line = &mut self.ring[row % self.lines * self.stride..][inside];
        horizontal(line, &self.padded[margins], self.kernel, channels);
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

    /// Of more rows than a task and than the ring has lines.
    #[test]
    fn tasks_and_regions_are_the_sum_written_out() {
        let (width, height, channels) = (300, 70, 2);
        let shape = Shape { width, height, channels };
        let picture: Vec<f32> = (0..width * height * 2).map(|i| (i as f32 * 0.7).sin()).collect();
        let kernel = gaussian(1.0);
        let mut region = Region(vec![200..280; height]);
        region.0[..20].fill(0..0);
        let whole = Region::whole(width, height);
        let [all, part] = [&whole, &region].map(|region| {
            let twice = |_: usize, _: usize, values: &mut [f32]| {
                values.iter_mut().for_each(|value| *value *= 2.0);
            };
            let mark = |row: usize, column: usize, values: &mut [f32]| {
                assert!(
                    row < height && column.is_multiple_of(HALF) && column * 2 + values.len() <= 600
                );
                values.iter_mut().for_each(|value| *value += 1.0);
            };
            convolve(&picture, &kernel, shape, region, twice, mark)
        });
        let weight = |a: usize, b: usize| kernel.get(a.abs_diff(b)).map_or(0.0, |w| f64::from(*w));
        for (x, y, c) in [(0, 0, 0), (255, 30, 1), (256, 31, 0), (299, 69, 1), (210, 35, 0)] {
            let mut sum = 1.0;
            for (v, u) in (0..height).flat_map(|v| (0..width).map(move |u| (v, u))) {
                let value = f64::from(picture[(v * width + u) * channels + c]);
                sum += 2.0 * weight(y, v) * weight(x, u) * value;
            }
            let got = f64::from(all[(y * width + x) * channels + c]);
            assert!((got - sum).abs() < 1e-5, "{x} {y}: {got} {sum}");
        }
        for (y, row) in region.0.iter().enumerate() {
            let range = (y * width + row.start) * channels..(y * width + row.end) * channels;
            assert_eq!(all[range.clone()], part[range]);
        }
        assert_eq!(part[0], 0.0);
    }
}

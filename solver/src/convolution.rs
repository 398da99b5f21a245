//! Separable convolution with a symmetric kernel; what lies outside the picture is zero.
//!
//! A task works down a strip of columns: every row is convolved once, into a ring of as many lines as
//! the kernel reaches over, and the columns of the ring are summed up. A value is read from memory about
//! once and written once; the ring stays in the cache, whose lines rows of a picture would compete for
//! where they are a power of two apart.

use std::mem::MaybeUninit;
use std::ops::Range;

use rayon::prelude::*;

use crate::region::Region;
use crate::simd::widened;

/// Columns of a strip.
pub const COLUMNS: usize = 256;
/// Rows that are summed up together.
const ROWS: usize = 4;
/// Values of a row that are summed up together: of a line, of the lines of the ring. What is asked for is
/// rounded up to as many columns.
const TILE: usize = 32;
const HALF: usize = 16;
/// Tasks per thread. (They share nothing, so that their number does not matter to the result.)
const TASKS: usize = 4;

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
    let parts = parts(&mut out.spare_capacity_mut()[..picture.len()], shape.width, shape.channels);
    convolve_into(parts, kernel, shape, region, read, write);
    // SAFETY: all parts were written.
    unsafe { out.set_len(picture.len()) };
    out
}

/// Cuts a texture's rows where strips of columns end: what tasks write to.
pub fn parts<T>(texture: &mut [T], width: usize, channels: usize) -> Vec<&mut [T]> {
    let rows = texture.chunks_mut(width * channels);
    rows.flat_map(|row| row.chunks_mut(COLUMNS * channels)).collect()
}

/// Values of a row of the result.
pub struct Place {
    pub row: usize,
    pub columns: Range<usize>,
    /// The first column of the part that they belong to.
    first: usize,
}

impl Place {
    /// Where they lie in the part.
    pub fn within(&self, channels: usize) -> Range<usize> {
        (self.columns.start - self.first) * channels..(self.columns.end - self.first) * channels
    }
}

/// The same from what `read` fills in (the row, the first column, values) to what `write` does with it
/// for each of the [`parts`], whether or not there are values.
pub fn convolve_into<O: Send>(
    parts: Vec<O>,
    kernel: &[f32],
    shape: Shape,
    region: &Region,
    read: impl Fn(usize, usize, &mut [f32]) + Sync,
    write: impl Fn(&Place, &mut [f32], &mut O) + Sync,
) {
    tasks(parts, shape, kernel.len()).into_par_iter().for_each(|task| {
        let first = task.columns.start;
        let mut strip = Strip::new(kernel, shape, region, task.columns);
        for (row, mut part) in task.rows.zip(task.parts) {
            let (at, values) = strip.row(row, &read);
            let start = first + at / shape.channels;
            let columns = start..start + values.len() / shape.channels;
            write(&Place { row, columns, first }, values, &mut part);
        }
    });
}

/// Some rows of a strip of columns.
struct Task<O> {
    columns: Range<usize>,
    rows: Range<usize>,
    /// One a row.
    parts: Vec<O>,
}

fn tasks<O>(parts: Vec<O>, shape: Shape, reach: usize) -> Vec<Task<O>> {
    let Shape { width, height, .. } = shape;
    let strips = width.div_ceil(COLUMNS);
    // The rows above and below a task's are convolved for its neighbours as well.
    let rows = (strips * height).div_ceil(TASKS * rayon::current_num_threads()).max(4 * reach);
    let rows = rows.next_multiple_of(ROWS);
    let task = |first: usize, strip: usize| Task {
        columns: strip * COLUMNS..width.min((strip + 1) * COLUMNS),
        rows: first..height.min(first + rows),
        parts: vec![],
    };
    let firsts = (0..height).step_by(rows);
    let mut tasks: Vec<_> =
        firsts.flat_map(|first| (0..strips).map(move |strip| task(first, strip))).collect();
    for (at, part) in parts.into_iter().enumerate() {
        tasks[at / strips / rows * strips + at % strips].parts.push(part);
    }
    tasks
}

/// The rows of a strip, asked for downwards.
struct Strip<'a> {
    kernel: &'a [f32],
    shape: Shape,
    region: &'a Region,
    columns: Range<usize>,
    /// Values of a line, and with what fills up the last tile.
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
    /// Of these, the values that were asked for.
    inside: Range<usize>,
    /// Of the lines of a sum: where it begins, and its weights in the rows.
    taps: Vec<(usize, [f32; ROWS])>,
}

impl<'a> Strip<'a> {
    fn new(kernel: &'a [f32], shape: Shape, region: &'a Region, columns: Range<usize>) -> Self {
        let (reach, length) = (kernel.len() - 1, columns.len() * shape.channels);
        let (stride, lines) = (length.next_multiple_of(TILE), 2 * reach + ROWS);
        Self {
            kernel,
            shape,
            region,
            columns,
            length,
            stride,
            padded: vec![0.0; stride + 2 * reach * shape.channels],
            ring: vec![0.0; lines * stride],
            lines,
            seen: 0..0,
            sums: vec![0.0; ROWS * stride],
            summed: 0..0,
            inside: 0..0,
            taps: Vec::with_capacity(lines),
        }
    }

    /// What some rows have of the region, in whole tiles of `columns`: values of a line.
    fn inside(&self, rows: Range<usize>, columns: usize) -> Range<usize> {
        let hull = self.region.columns(rows.start..rows.end.min(self.shape.height));
        let (start, end) = (hull.start.max(self.columns.start), hull.end.min(self.columns.end));
        if start >= end {
            return 0..0;
        }
        let [start, end] = [start, end].map(|column| column - self.columns.start);
        let tile = columns * self.shape.channels;
        start / columns * tile..(end.div_ceil(columns) * tile).min(self.stride)
    }

    /// A row of the result: where it begins, and its values.
    fn row(&mut self, row: usize, read: impl Fn(usize, usize, &mut [f32])) -> (usize, &mut [f32]) {
        if !self.summed.contains(&row) {
            self.sum(row / ROWS * ROWS, read);
        }
        let end = self.inside.end.min(self.length);
        let sums = &mut self.sums[(row - self.summed.start) * self.stride..];
        (self.inside.start, &mut sums[self.inside.start..end])
    }

    /// Sums up the rows from `first` on.
    fn sum(&mut self, first: usize, read: impl Fn(usize, usize, &mut [f32])) {
        let Self { kernel, lines, stride, .. } = *self;
        let reach = kernel.len() - 1;
        let rows = first.saturating_sub(reach)..(first + ROWS + reach).min(self.shape.height);
        for row in rows.start.max(self.seen.end)..rows.end {
            self.convolve(row, &read);
        }
        self.seen = rows.clone();
        self.summed = first..first + ROWS;
        self.inside = self.inside(self.summed.clone(), HALF);
        self.taps.clear();
        self.taps.extend(rows.map(|row| {
            let tap = |to: usize| *kernel.get(row.abs_diff(first + to)).unwrap_or(&0.0);
            (row % lines * stride, std::array::from_fn(tap))
        }));
        vertical(&mut self.sums, stride, self.inside.clone(), &self.ring, &self.taps);
    }

    /// Brings a row of the picture to the ring: what will be summed up of it.
    fn convolve(&mut self, row: usize, read: impl Fn(usize, usize, &mut [f32])) {
        let Shape { width, channels, .. } = self.shape;
        let (first, reach) = (self.columns.start, self.kernel.len() - 1);
        let near = (reach + ROWS).next_multiple_of(ROWS);
        let inside = self.inside(row.saturating_sub(near)..row + near, TILE);
        if inside.is_empty() {
            return;
        }
        let from = (first + inside.start / channels).saturating_sub(reach);
        let to = (first + inside.end.div_ceil(channels)).min(self.columns.end) + reach;
        let count = (to.min(width) - from) * channels;
        read(row, from, &mut self.padded[(from + reach - first) * channels..][..count]);
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

    /// Wider than a strip, with more rows than a task and than the ring has lines.
    #[test]
    fn strips_tasks_and_regions_are_the_sum_written_out() {
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

//! Bilinear taps, computed once: textures are sampled per pixel, gradients are gathered per texel.
//!
//! Samples are sorted by texel. The gradient of a strip of texture rows then comes from one contiguous
//! run of samples, read in a fixed order: no atomics, and the same sums for any number of threads; the
//! sums of a cell stay in registers while its samples pass. A sample's place is 12 bytes.

use std::ops::Range;

use glam::Vec2;
use rayon::prelude::*;

use super::planes::{BLOCK, CHUNK_BLOCKS, Planes, Row};
use crate::parallel::from_parts;
use crate::region::Region;
use crate::simd::widened;

/// A gather is cut into about this many strips, whatever the number of threads.
const STRIPS: usize = 64;
/// Rows of a strip, at least.
const LEAST_ROWS: usize = 4;

/// The four texels around each sample, with bilinear weights; outside the texture it is clamped.
#[derive(Clone, Debug)]
pub struct Taps {
    size: usize,
    /// Upper left texel of each sample, row-major, ascending.
    cell: Vec<u32>,
    /// Position between that texel's centre and the next ones', right and down, 0 to 1.
    fraction: Vec<[f32; 2]>,
    /// First sample of every row of cells, and the number of samples.
    row_start: Vec<usize>,
}

impl Taps {
    /// Sorts samples by texel: returns the taps, and for each of them which `uvs` it came from.
    pub fn sorted(size: usize, uvs: &[Vec2]) -> (Self, Vec<usize>) {
        let place = |uv: &Vec2| {
            let clamp = |x: f32| (x * size as f32 - 0.5).clamp(0.0, (size - 1) as f32);
            let (x, y) = (clamp(uv.x), clamp(1.0 - uv.y));
            let (x0, y0) = ((x as usize).min(size - 2), (y as usize).min(size - 2));
            ((y0 * size + x0) as u32, [x - x0 as f32, y - y0 as f32])
        };
        let placed: Vec<_> = uvs.par_iter().map(place).collect();
        let mut order: Vec<usize> = (0..uvs.len()).collect();
        order.par_sort_by_key(|sample| (placed[*sample].0, *sample));
        let cell: Vec<u32> = order.iter().map(|sample| placed[*sample].0).collect();
        let fraction = order.iter().map(|sample| placed[*sample].1).collect();
        let row_start = (0..=size)
            .map(|row| cell.partition_point(|cell| (*cell as usize) < row * size))
            .collect();
        (Self { size, cell, fraction, row_start }, order)
    }

    /// Every `step`-th sample.
    pub fn thinned(&self, step: usize) -> Self {
        Self {
            size: self.size,
            cell: self.cell.iter().step_by(step).copied().collect(),
            fraction: self.fraction.iter().step_by(step).copied().collect(),
            row_start: self.row_start.iter().map(|start| start.div_ceil(step)).collect(),
        }
    }

    /// Texture side, texels.
    pub fn size(&self) -> usize {
        self.size
    }

    /// The texel whose centre is nearest to a sample.
    pub fn nearest(&self, sample: usize) -> usize {
        let [fx, fy] = self.fraction[sample].map(|f| usize::from(f > 0.5));
        self.cell[sample] as usize + fy * self.size + fx
    }

    /// Upper left texel of every sample, row-major, ascending.
    pub fn cells(&self) -> &[u32] {
        &self.cell
    }

    /// Of every sample, its place between that texel's centre and the next ones', right and down.
    pub fn fractions(&self) -> &[[f32; 2]] {
        &self.fraction
    }

    /// Where a sample lies: column and row, counted in texels from the first texel's centre.
    pub fn place(&self, sample: usize) -> [f32; 2] {
        let (cell, [fx, fy]) = (self.cell[sample] as usize, self.fraction[sample]);
        [(cell % self.size) as f32 + fx, (cell / self.size) as f32 + fy]
    }

    /// The texels that have part in a sample: of every row, from the first to the last.
    pub fn region(&self) -> Region {
        let cells = |row: usize| match &self.cell[self.row_start[row]..self.row_start[row + 1]] {
            [first, .., last] => first % self.size as u32..last % self.size as u32 + 2,
            [only] => only % self.size as u32..only % self.size as u32 + 2,
            [] => 0..0,
        };
        let texels = |row: usize| {
            // Those below a row of cells as well.
            let [here, above] = [cells(row), if row > 0 { cells(row - 1) } else { 0..0 }];
            let hull = match (here.is_empty(), above.is_empty()) {
                (true, _) => above,
                (_, true) => here,
                _ => here.start.min(above.start)..here.end.max(above.end),
            };
            hull.start as usize..hull.end as usize
        };
        Region((0..self.size).map(texels).collect())
    }

    /// Samples a texture of `C` interleaved channels.
    pub fn sample<const C: usize>(&self, texture: &[f32]) -> Planes {
        let (texels, _) = texture.as_chunks();
        Planes::from_blocks(C, self.cell.len(), |block, rows| {
            rows.first_chunk_mut().into_iter().for_each(|rows: &mut [Row; C]| {
                let first = block * BLOCK;
                let last = (first + BLOCK).min(self.cell.len());
                let (cell, fraction) = (&self.cell[first..last], &self.fraction[first..last]);
                sample_block(cell, fraction, texels, self.size, 0, rows);
            });
        })
    }

    /// The adjoint of [`Taps::sample`]: sums the samples' gradients (rows `first..first + C`) into
    /// the texels they were interpolated from.
    pub fn gather<const C: usize>(&self, gradient: &Planes, first: usize) -> Vec<f32> {
        let rows = |block: usize| gradient.block(block)[first..].first_chunk::<C>();
        let add = |strip: &mut Strip<C>| {
            for (block, lanes) in blocks(strip.samples.clone()) {
                rows(block).into_iter().for_each(|rows| strip.add(block, lanes.clone(), rows));
            }
        };
        self.by_strip(add).0
    }

    /// [`Taps::sample`] and [`Taps::gather`] in one pass, without planes between them. Given the number
    /// of a block and the texture values of its samples, `value` writes their gradients and their
    /// terms of the loss. Returns the texels' gradients and the sum of the terms. (Blocks at the ends
    /// of a strip are seen twice, with other samples valid.)
    pub fn exchange<const C: usize, const D: usize>(
        &self,
        texture: &[f32],
        value: impl Fn(usize, &[Row; C], &mut [Row; D], &mut Row) + Sync,
    ) -> (Vec<f32>, f64) {
        let (texels, _) = texture.as_chunks::<C>();
        let (gradient, sums) = self.by_strip(|strip| {
            let (mut values, mut gradient) = ([Row::ZERO; C], [Row::ZERO; D]);
            let mut loss = Row::ZERO;
            let mut sum = 0.0;
            for (block, lanes) in blocks(strip.samples.clone()) {
                let samples = block * BLOCK + lanes.start..block * BLOCK + lanes.end;
                let (cell, fraction) = (&self.cell[samples.clone()], &self.fraction[samples]);
                sample_block(cell, fraction, texels, self.size, lanes.start, &mut values);
                value(block, &values, &mut gradient, &mut loss);
                sum += loss.0[lanes.clone()].iter().map(|term| f64::from(*term)).sum::<f64>();
                strip.add(block, lanes, &gradient);
            }
            sum
        });
        (gradient, sums.iter().sum())
    }

    /// Rows of a strip.
    fn strip(&self) -> usize {
        self.size.div_ceil(STRIPS).max(LEAST_ROWS)
    }

    /// Texels of `D` channels that `work` adds to, strip by strip of rows, whose samples are
    /// contiguous; and its results, in order. The row below a strip's last, which the next strip begins
    /// with, is added at the end.
    pub(super) fn by_strip<const D: usize, T: Send>(
        &self,
        work: impl Fn(&mut Strip<D>) -> T + Sync,
    ) -> (Vec<f32>, Vec<T>) {
        let line = self.size * D;
        let task = |number: usize, texels: &mut [f32]| {
            let samples = self.samples_of(number, texels.len() / line);
            self.in_strip(number, texels, samples, &work)
        };
        let (mut texels, results) = from_parts(self.size * line, self.strip() * line, task);
        let results = self.join::<D, T>(&mut texels, results);
        (texels, results)
    }

    /// The same of whole blocks, a block in the strip that its first sample is in; in texels that are zero but
    /// in the samples' `region`, whatever they are there; and with scratch of the threads.
    pub fn by_strip_in<const D: usize, S, T: Send>(
        &self,
        region: &Region,
        texels: &mut [[f32; D]],
        scratch: impl Fn() -> S + Send + Sync,
        work: impl Fn(&mut S, &mut Strip<D>) -> T + Sync,
    ) -> Vec<T> {
        let texels = texels.as_flattened_mut();
        let task = |scratch: &mut S, (number, texels): (usize, &mut [f32])| {
            let rows = texels.chunks_exact_mut(self.size * D);
            for (row, columns) in rows.zip(&region.0[number * self.strip()..]) {
                row[columns.start * D..columns.end * D].fill(0.0);
            }
            let Range { start, end } = self.samples_of(number, texels.len() / (self.size * D));
            let whole = |sample: usize| sample.next_multiple_of(BLOCK).min(self.cell.len());
            self.in_strip(number, texels, whole(start)..whole(end), |strip| work(scratch, strip))
        };
        let strips = texels.par_chunks_mut(self.strip() * self.size * D).enumerate();
        let results = strips.map_init(scratch, task).collect();
        self.join::<D, T>(texels, results)
    }

    /// Texels of `D` channels that `work` adds to, chunk by chunk of whole blocks of samples; and its
    /// results, in order. Chunks have texels of their own, which are added in their order.
    pub fn by_chunk<const D: usize, S, T: Send>(
        &self,
        scratch: impl Fn() -> S + Send + Sync,
        work: impl Fn(&mut S, &mut Strip<D>) -> T + Sync,
    ) -> (Vec<f32>, Vec<T>) {
        let (count, chunk, line) = (self.cell.len(), CHUNK_BLOCKS * BLOCK, self.size * D);
        let row = |sample: usize| self.cell[sample] as usize / self.size;
        let task = |scratch: &mut S, number: usize| {
            let samples = number * chunk..((number + 1) * chunk).min(count);
            let first = row(samples.start);
            let rows = row(samples.end - 1) + 2 - first;
            let mut own = vec![0.0; rows * line];
            let (texels, below) = own.as_chunks_mut().0.split_at_mut((rows - 1) * self.size);
            let result = work(scratch, &mut Strip { taps: self, first, samples, texels, below });
            ((first * line, own), result)
        };
        let chunks = (0..count.div_ceil(chunk)).into_par_iter();
        let (parts, results): (Vec<_>, Vec<_>) = chunks.map_init(scratch, task).unzip();
        let add = |number: usize, texels: &mut [f32]| {
            add_parts(number * self.strip() * line, texels, &parts);
        };
        (from_parts(self.size * line, self.strip() * line, add).0, results)
    }

    /// The samples whose upper texels are in a strip of so many rows.
    fn samples_of(&self, strip: usize, rows: usize) -> Range<usize> {
        let first = strip * self.strip();
        self.row_start[first]..self.row_start[first + rows]
    }

    /// Work on samples that begin in a strip; the rows below that they reach, where these begin, and the
    /// result.
    fn in_strip<const D: usize, T>(
        &self,
        number: usize,
        texels: &mut [f32],
        samples: Range<usize>,
        work: impl FnOnce(&mut Strip<D>) -> T,
    ) -> ((usize, Vec<f32>), T) {
        let line = self.size * D;
        let first = number * self.strip();
        let end = first + texels.len() / line;
        // The last sample's lower texels are in the row below its cell's.
        let last =
            self.cell[samples.clone()].last().map_or(0, |cell| *cell as usize / self.size + 2);
        let mut below = vec![0.0; last.saturating_sub(end) * line];
        let texels = texels.as_chunks_mut().0;
        let below_texels = below.as_chunks_mut().0;
        let result = work(&mut Strip { taps: self, first, samples, texels, below: below_texels });
        ((end * line, below), result)
    }

    /// Adds the rows below; the results.
    fn join<const D: usize, T: Send>(
        &self,
        texels: &mut [f32],
        results: Vec<((usize, Vec<f32>), T)>,
    ) -> Vec<T> {
        let (below, results): (Vec<_>, Vec<_>) = results.into_iter().unzip();
        let strip = self.strip() * self.size * D;
        let strips = texels.par_chunks_mut(strip).enumerate();
        strips.for_each(|(number, texels)| add_parts(number * strip, texels, &below));
        results
    }
}

/// Adds to values, of which the first has number `start`, what parts have of them: the first one's number, and
/// values.
fn add_parts(start: usize, values: &mut [f32], parts: &[(usize, Vec<f32>)]) {
    let end = start + values.len();
    for (first, part) in parts {
        let (from, to) = (start.max(*first), end.min(first + part.len()));
        if from < to {
            let sums = values[from - start..to - start].iter_mut();
            sums.zip(&part[from - first..]).for_each(|(sum, value)| *sum += value);
        }
    }
}

/// The blocks that a range of samples lies in, with its lanes of each.
pub fn blocks(samples: Range<usize>) -> impl Iterator<Item = (usize, Range<usize>)> {
    let first = samples.start / BLOCK;
    let end = if samples.is_empty() { first } else { samples.end.div_ceil(BLOCK) };
    (first..end).map(move |block| {
        let start = block * BLOCK;
        (block, samples.start.max(start) - start..samples.end.min(start + BLOCK) - start)
    })
}

/// Some rows of a texture of `D` channels, and the row below them.
pub struct Strip<'a, const D: usize> {
    /// Of all samples.
    pub taps: &'a Taps,
    /// The first row.
    pub first: usize,
    /// Samples whose upper texels are in these rows, or in those below.
    pub samples: Range<usize>,
    /// The rows' texels.
    pub texels: &'a mut [[f32; D]],
    /// Those of the rows below.
    pub below: &'a mut [[f32; D]],
}

impl<const D: usize> Strip<'_, D> {
    /// Adds some lanes of a block.
    fn add(&mut self, block: usize, lanes: Range<usize>, rows: &[Row; D]) {
        let Taps { cell, fraction, .. } = self.taps;
        let samples = block * BLOCK + lanes.start..block * BLOCK + lanes.end;
        let (cell, fraction) = (&cell[samples.clone()], &fraction[samples]);
        add_lanes(self, cell, fraction, lanes.start, rows);
    }
}

widened! {
    /// Adds the gradients of samples that begin at a lane. The sums of a cell stay in registers while its
    /// samples pass.
    fn add_lanes<const D: usize>(
        strip: &mut Strip<D>,
        cell: &[u32],
        fraction: &[[f32; 2]],
        lane: usize,
        rows: &[Row; D],
    ) {
        let Strip { taps: Taps { size, .. }, first, texels, below, .. } = strip;
        assert!(lane + cell.len() <= BLOCK && fraction.len() == cell.len());
        let mut sample = 0;
        while sample < cell.len() {
            let here = cell[sample];
            let (mut upper, mut lower) = ([[0.0; D]; 2], [[0.0; D]; 2]);
            while sample < cell.len() && cell[sample] == here {
                let [fx, fy] = fraction[sample];
                for (side, share) in [1.0 - fx, fx].into_iter().enumerate() {
                    for channel in 0..D {
                        let g = share * rows[channel].0[lane + sample];
                        upper[side][channel] += (1.0 - fy) * g;
                        lower[side][channel] += fy * g;
                    }
                }
                sample += 1;
            }
            let at = here as usize - *first * size;
            for (at, sums) in [(at, upper), (at + size, lower)] {
                match at.checked_sub(texels.len()) {
                    None => add(&mut texels[at..at + 2], &sums),
                    Some(at) => add(&mut below[at..at + 2], &sums),
                }
            }
        }
    }
}

#[inline(always)]
fn add<const D: usize>(sum: &mut [[f32; D]], values: &[[f32; D]; 2]) {
    let values = values.as_flattened();
    sum.as_flattened_mut().iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
}

/// The upper two texels of a cell, and the lower two.
#[inline(always)]
fn surrounding<const C: usize>(
    texels: &[[f32; C]],
    size: usize,
    cell: usize,
) -> [&[[f32; C]; 2]; 2] {
    let pair = |at: usize| texels[at..].first_chunk().unwrap_or_else(|| unreachable!());
    [pair(cell), pair(cell + size)]
}

#[inline(always)]
fn blend<const C: usize>([upper, lower]: [&[[f32; C]; 2]; 2], [fx, fy]: [f32; 2]) -> [f32; C] {
    // Downwards first: left and right are one vector.
    let mut both = *upper;
    for (upper, lower) in both.as_flattened_mut().iter_mut().zip(lower.as_flattened()) {
        *upper += fy * (lower - *upper);
    }
    let [left, right] = both;
    std::array::from_fn(|k| left[k] + fx * (right[k] - left[k]))
}

widened! {
    /// The texture values of some samples, from lane `first` on.
    fn sample_block<const C: usize>(
        cell: &[u32],
        fraction: &[[f32; 2]],
        texels: &[[f32; C]],
        size: usize,
        first: usize,
        rows: &mut [Row; C],
    ) {
        assert!(first + cell.len() <= BLOCK);
        for (lane, (cell, fraction)) in cell.iter().zip(fraction).enumerate() {
            let value = blend(surrounding(texels, size, *cell as usize), *fraction);
            for (row, value) in rows.iter_mut().zip(value) {
                row.0[first + lane] = value;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(count: usize) -> Vec<Vec2> {
        let noise = |i: usize, k: f32| ((i as f32 + 1.0) * k).sin().abs().fract();
        (0..count).map(|i| Vec2::new(noise(i, 12.9898), noise(i, 78.233))).collect()
    }

    #[test]
    fn of_thinned_samples_every_one_is_sampled_and_gathered_where_it_was() {
        let (size, step) = (16, 3);
        let taps = Taps::sorted(size, &points(1000)).0;
        let texture: Vec<f32> = (0..size * size).map(|i| (i as f32 * 0.7).sin()).collect();
        let values = taps.sample::<1>(&texture);
        let thin = taps.thinned(step);
        assert_eq!(thin.sample::<1>(&texture), values.thinned(step));
        let kept = |i: usize| if i.is_multiple_of(step) { values.get(0, i) } else { 0.0 };
        let kept = Planes::from_fn(1000, |i| [kept(i)]);
        let sums = thin.gather::<1>(&values.thinned(step), 0).into_iter();
        for (sum, expected) in sums.zip(taps.gather::<1>(&kept, 0)) {
            assert!((sum - expected).abs() < 1e-5, "{sum} not {expected}");
        }
    }

    #[test]
    fn a_linear_texture_is_reproduced_and_clamped() {
        let size = 8;
        let ramp: Vec<f32> = (0..64).flat_map(|t| [(t % 8) as f32, (t / 8) as f32]).collect();
        let uvs = points(500);
        let (taps, order) = Taps::sorted(size, &uvs);
        let values = taps.sample::<2>(&ramp);
        for (i, source) in order.iter().enumerate() {
            let uv = uvs[*source];
            let expected = [uv.x, 1.0 - uv.y].map(|t| (t * 8.0 - 0.5).clamp(0.0, 7.0));
            for (c, expected) in expected.into_iter().enumerate() {
                assert!((values.get(c, i) - expected).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn gather_is_the_transpose_of_sample() {
        let (taps, _) = Taps::sorted(16, &points(1000));
        let texture: Vec<f32> = (0..16 * 16 * 3).map(|i| (i as f32 * 0.37).sin()).collect();
        let gradient = Planes::from_fn(1000, |i| [1.0, 2.0, 3.0].map(|k| (i as f32 * k).cos()));
        let sampled = taps.sample::<3>(&texture);
        let gathered = taps.gather::<3>(&gradient, 0);
        let left: f64 = (0..1000)
            .flat_map(|i| (0..3).map(move |c| (c, i)))
            .map(|(c, i)| f64::from(sampled.get(c, i)) * f64::from(gradient.get(c, i)))
            .sum();
        let right: f64 =
            gathered.iter().zip(&texture).map(|(g, t)| f64::from(*g) * f64::from(*t)).sum();
        assert!((left - right).abs() < 1e-3 * left.abs().max(1.0), "{left} {right}");
    }

    #[test]
    fn chunks_of_samples_add_up_to_the_strips_sums() {
        // Two chunks, the second one of less than a block, that share a row.
        let count = CHUNK_BLOCKS * BLOCK + 100;
        let (taps, _) = Taps::sorted(16, &points(count));
        let gradient = Planes::from_fn(count, |i| [(i as f32).cos(), 1.0]);
        let add = |(): &mut (), strip: &mut Strip<2>| {
            for (block, lanes) in blocks(strip.samples.clone()) {
                strip.add(block, lanes, gradient.rows_of(block));
            }
            strip.samples.len()
        };
        let (sums, lengths) = taps.by_chunk(|| (), add);
        assert_eq!(lengths, [count - 100, 100]);
        for (sum, expected) in sums.iter().zip(taps.gather::<2>(&gradient, 0)) {
            assert!((sum - expected).abs() < 1e-4 * expected.abs().max(1.0), "{sum} {expected}");
        }
        assert!(Taps::sorted(16, &[]).0.by_chunk(|| (), add).0.iter().all(|sum| *sum == 0.0));
    }

    #[test]
    fn an_exchange_is_a_sample_and_a_gather() {
        // More rows than a strip has.
        let (taps, _) = Taps::sorted(300, &points(5000));
        let texture: Vec<f32> = (0..300 * 300 * 2).map(|i| (i as f32 * 0.37).sin()).collect();
        let swap = |i: usize, [a, b]: [f32; 2]| [b, a * (i % 7) as f32, 1.0];
        let sampled = taps.sample::<2>(&texture);
        let planes = Planes::from_fn(5000, |i| swap(i, sampled.sample(i, 0)));
        let (gathered, sum) = taps.exchange::<2, 3>(&texture, |block, values, gradient, loss| {
            for lane in 0..BLOCK {
                let [a, b, c] = swap(block * BLOCK + lane, [0, 1].map(|c| values[c].0[lane]));
                (gradient[0].0[lane], gradient[1].0[lane], gradient[2].0[lane]) = (a, b, c);
                loss.0[lane] = values[0].0[lane];
            }
        });
        assert_eq!(gathered, taps.gather::<3>(&planes, 0));
        let expected: f64 = (0..5000).map(|i| f64::from(sampled.get(0, i))).sum();
        assert!((sum - expected).abs() < 1e-9, "{sum} {expected}");
    }
}

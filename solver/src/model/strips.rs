//! Sums of samples into texels, by strips of rows or by chunks of samples, in an order that does not depend on the
//! number of threads.

use std::ops::Range;

use rayon::prelude::*;

use super::planes::{BLOCK, CHUNK_BLOCKS, Row};
use super::taps::Taps;
use crate::parallel::from_parts;
use crate::simd::widened;

/// The approximate number of strips of a gather, for any number of threads.
const STRIPS: usize = 64;
/// Least number of rows of a strip.
const LEAST_ROWS: usize = 4;

impl Taps {
    /// Rows of a strip.
    pub(super) fn strip(&self) -> usize {
        self.size().div_ceil(STRIPS).max(LEAST_ROWS)
    }

    /// Runs `work` for each strip of rows, whose samples are contiguous, and returns the summed texels of `D` channels
    /// and the results in order. The row below a strip's last row, the first of the next strip, is added at the end.
    pub(super) fn by_strip<const D: usize, T: Send>(
        &self,
        work: impl Fn(&mut Strip<D>) -> T + Sync,
    ) -> (Vec<f32>, Vec<T>) {
        let line = self.size() * D;
        let task = |number: usize, texels: &mut [f32]| {
            let samples = self.samples_of(number, texels.len() / line);
            self.in_strip(number, texels, samples, &work)
        };
        let (mut texels, results) = from_parts(self.size() * line, self.strip() * line, task);
        let results = self.join::<D, T>(&mut texels, results);
        (texels, results)
    }

    /// [`Self::by_strip`] in whole blocks: a block belongs to the strip of its first sample.
    pub fn by_blocks<const D: usize, S, T: Send>(
        &self,
        scratch: impl Fn() -> S + Send + Sync,
        work: impl Fn(&mut S, &mut Strip<D>) -> T + Sync,
    ) -> (Vec<f32>, Vec<T>) {
        let line = self.size() * D;
        let mut texels = vec![0.0; self.size() * line];
        let task = |scratch: &mut S, (number, texels): (usize, &mut [f32])| {
            let first = number * self.strip();
            let samples = self.blocks_of(first..first + texels.len() / line);
            self.in_strip(number, texels, samples, |strip| work(scratch, strip))
        };
        let strips = texels.par_chunks_mut(self.strip() * line).enumerate();
        let results = strips.map_init(scratch, task).collect();
        let results = self.join::<D, T>(&mut texels, results);
        (texels, results)
    }

    /// Runs `work` for each chunk of whole blocks of samples, and returns the summed texels of `D` channels and the
    /// results in order. Each chunk has its own texels, which are added in the order of the chunks.
    pub fn by_chunk<const D: usize, S, T: Send>(
        &self,
        scratch: impl Fn() -> S + Send + Sync,
        work: impl Fn(&mut S, &mut Strip<D>) -> T + Sync,
    ) -> (Vec<f32>, Vec<T>) {
        let (count, chunk, line) = (self.cells().len(), CHUNK_BLOCKS * BLOCK, self.size() * D);
        let row = |sample: usize| self.cells()[sample] as usize / self.size();
        let task = |scratch: &mut S, number: usize| {
            let samples = number * chunk..((number + 1) * chunk).min(count);
            let first = row(samples.start);
            let rows = row(samples.end - 1) + 2 - first;
            let mut own = vec![0.0; rows * line];
            let (texels, below) = own.as_chunks_mut().0.split_at_mut((rows - 1) * self.size());
            let result = work(scratch, &mut Strip { taps: self, first, samples, texels, below });
            ((first * line, own), result)
        };
        let chunks = (0..count.div_ceil(chunk)).into_par_iter();
        let (parts, results): (Vec<_>, Vec<_>) = chunks.map_init(scratch, task).unzip();
        let add = |number: usize, texels: &mut [f32]| {
            add_parts(number * self.strip() * line, texels, slices(&parts));
        };
        (from_parts(self.size() * line, self.strip() * line, add).0, results)
    }

    /// The blocks of samples whose first sample has its upper texels in some rows.
    fn blocks_of(&self, rows: Range<usize>) -> Range<usize> {
        let Range { start, end } = self.samples_in(rows);
        let whole = |sample: usize| sample.next_multiple_of(BLOCK).min(self.cells().len());
        whole(start)..whole(end)
    }

    /// The samples with their upper texels in a strip of this number of rows.
    fn samples_of(&self, strip: usize, rows: usize) -> Range<usize> {
        let first = strip * self.strip();
        self.samples_in(first..first + rows)
    }

    /// Runs `work` on the samples of a strip; returns the rows below that it changed, their start, and the result.
    fn in_strip<const D: usize, T>(
        &self,
        number: usize,
        texels: &mut [f32],
        samples: Range<usize>,
        work: impl FnOnce(&mut Strip<D>) -> T,
    ) -> ((usize, Vec<f32>), T) {
        let line = self.size() * D;
        let first = number * self.strip();
        let end = first + texels.len() / line;
        // The last sample's lower texels are in the row below its cell's.
        let last =
            self.cells()[samples.clone()].last().map_or(0, |cell| *cell as usize / self.size() + 2);
        let mut below = vec![0.0; last.saturating_sub(end) * line];
        let texels = texels.as_chunks_mut().0;
        let below_texels = below.as_chunks_mut().0;
        let result = work(&mut Strip { taps: self, first, samples, texels, below: below_texels });
        ((end * line, below), result)
    }

    /// Adds the rows below, and returns the results.
    fn join<const D: usize, T: Send>(
        &self,
        texels: &mut [f32],
        results: Vec<((usize, Vec<f32>), T)>,
    ) -> Vec<T> {
        let (below, results): (Vec<_>, Vec<_>) = results.into_iter().unzip();
        let strip = self.strip() * self.size() * D;
        let strips = texels.par_chunks_mut(strip).enumerate();
        strips.for_each(|(number, texels)| add_parts(number * strip, texels, slices(&below)));
        results
    }
}

fn slices(parts: &[(usize, Vec<f32>)]) -> impl Iterator<Item = (usize, &[f32])> {
    parts.iter().map(|(first, part)| (*first, part.as_slice()))
}

/// Adds parts to values, which begin at index `start`. A part is the index of its first value, and its values.
fn add_parts<'a>(
    start: usize,
    values: &mut [f32],
    parts: impl IntoIterator<Item = (usize, &'a [f32])>,
) {
    let end = start + values.len();
    for (first, part) in parts {
        let (from, to) = (start.max(first), end.min(first + part.len()));
        if from < to {
            let sums = values[from - start..to - start].iter_mut();
            sums.zip(&part[from - first..]).for_each(|(sum, value)| *sum += value);
        }
    }
}

/// The blocks of a range of samples, with the lanes of the range in each.
pub fn blocks(samples: Range<usize>) -> impl Iterator<Item = (usize, Range<usize>)> {
    let first = samples.start / BLOCK;
    let end = if samples.is_empty() { first } else { samples.end.div_ceil(BLOCK) };
    (first..end).map(move |block| {
        let start = block * BLOCK;
        (block, samples.start.max(start) - start..samples.end.min(start + BLOCK) - start)
    })
}

/// Some rows of a texture of `D` channels, and the rows below that their samples reach.
pub struct Strip<'a, const D: usize> {
    /// Taps of all samples.
    pub taps: &'a Taps,
    /// The first row.
    pub first: usize,
    /// Samples whose upper texels are in these rows, or in those below.
    pub samples: Range<usize>,
    /// The rows' texels.
    pub texels: &'a mut [[f32; D]],
    /// The texels of the rows below.
    pub below: &'a mut [[f32; D]],
}

impl<const D: usize> Strip<'_, D> {
    /// Adds the values of some lanes of a block.
    pub(super) fn add(&mut self, block: usize, lanes: Range<usize>, rows: &[Row; D]) {
        let samples = block * BLOCK + lanes.start..block * BLOCK + lanes.end;
        let cells = &self.taps.cells()[samples.clone()];
        let fractions = &self.taps.fractions()[samples];
        add_lanes(self, cells, fractions, lanes.start, rows);
    }
}

widened! {
    /// Adds the gradients of samples from a lane on. The sums of a cell stay in registers during its samples.
    fn add_lanes<const D: usize>(
        strip: &mut Strip<D>,
        cell: &[u32],
        fraction: &[[f32; 2]],
        lane: usize,
        rows: &[Row; D],
    ) {
        let Strip { taps, first, texels, below, .. } = strip;
        let size = taps.size();
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

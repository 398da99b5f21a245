//! Per-sample quantities in the layout of the kernels: blocks of 256 samples, each quantity of a
//! block in one contiguous row, so that a chunk of samples is one contiguous piece of memory.

use std::mem::MaybeUninit;

use rayon::prelude::*;

use super::kept::Kept;
use super::rows::Rows;
pub use super::rows::{BLOCK, Row, first_rows, first_rows_mut};

/// Blocks per task. Sums are formed per chunk and added in chunk order, so that results do not depend on the number of
/// threads.
pub const CHUNK_BLOCKS: usize = 32;

/// `rows` quantities of `len` samples; the last block is padded with zeros.
#[derive(Clone, Debug, PartialEq)]
pub struct Planes {
    rows: usize,
    len: usize,
    data: Rows,
}

impl Planes {
    /// Planes of zeros.
    pub fn new(rows: usize, len: usize) -> Self {
        Self { rows, len, data: Rows::zeros(rows * len.div_ceil(BLOCK)) }
    }

    /// Planes with the values `value(sample)[row]`, computed in parallel.
    pub fn from_fn<const R: usize>(len: usize, value: impl Fn(usize) -> [f32; R] + Sync) -> Self {
        Self::from_blocks(R, len, |block, rows| {
            let first = block * BLOCK;
            for lane in 0..BLOCK.min(len - first) {
                for (row, value) in rows.iter_mut().zip(value(first + lane)) {
                    row.0[lane] = value;
                }
            }
        })
    }

    /// Planes whose blocks `fill` writes, in parallel; rows are zero at first.
    pub fn from_blocks(rows: usize, len: usize, fill: impl Fn(usize, &mut [Row]) + Sync) -> Self {
        Self::from_tasks(rows, len, 1, || (), |(), block, rows| fill(block, rows)).0
    }

    /// [`Self::from_blocks`] in tasks of `blocks` blocks each: `fill(scratch, first block, rows)`.
    /// Returns the planes and the results of the tasks in their order.
    pub fn from_tasks<S, T: Send>(
        rows: usize,
        len: usize,
        blocks: usize,
        scratch: impl Fn() -> S + Send + Sync,
        fill: impl Fn(&mut S, usize, &mut [Row]) -> T + Sync,
    ) -> (Self, Vec<T>) {
        let count = rows * len.div_ceil(BLOCK);
        let task = |scratch: &mut S, (task, part): (usize, &mut [MaybeUninit<Row>])| {
            // Zeroed here, so that it is in this core's cache when it is filled.
            part.iter_mut().for_each(|row| _ = row.write(Row::ZERO));
            let (start, length) = (part.as_mut_ptr().cast::<Row>(), part.len());
            // SAFETY: all of the part was just written, and nothing else refers to it meanwhile.
            let part = unsafe { std::slice::from_raw_parts_mut(start, length) };
            let first = task * blocks;
            let result = fill(scratch, first, part);
            let filled = len - first * BLOCK;
            if filled < blocks * BLOCK && !filled.is_multiple_of(BLOCK) {
                let last = &mut part[filled / BLOCK * rows..];
                last.iter_mut().for_each(|row| row.0[filled % BLOCK..].fill(0.0));
            }
            result
        };
        let write = |data: &mut [MaybeUninit<Row>]| {
            let parts = data.par_chunks_mut((rows * blocks).max(1));
            parts.enumerate().map_init(scratch, task).collect()
        };
        // SAFETY: the tasks write every one of the rows.
        let (data, results) = unsafe { Rows::new(count, write) };
        (Self { rows, len, data }, results)
    }

    /// The selected samples.
    pub fn kept(&self, kept: &Kept) -> Self {
        let len = kept.len();
        Self::from_blocks(self.rows, len, |block, rows| {
            let first = block * BLOCK;
            for (number, row) in rows.iter_mut().enumerate() {
                for (at, value) in row.0.iter_mut().enumerate().take(len - first) {
                    *value = self.get(number, kept.source(first + at));
                }
            }
        })
    }

    /// The number of quantities.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The number of samples.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The value of one quantity of one sample.
    pub fn get(&self, row: usize, sample: usize) -> f32 {
        self.data[sample / BLOCK * self.rows + row].0[sample % BLOCK]
    }

    /// The quantities `first..first + R` of one sample.
    pub fn sample<const R: usize>(&self, sample: usize, first: usize) -> [f32; R] {
        let rows = &self.data[sample / BLOCK * self.rows + first..][..R];
        std::array::from_fn(|row| rows[row].0[sample % BLOCK])
    }

    /// The rows of block number `block`.
    pub fn block(&self, block: usize) -> &[Row] {
        &self.data[block * self.rows..][..self.rows]
    }

    /// The first `R` rows of block number `block`.
    pub fn rows_of<const R: usize>(&self, block: usize) -> &[Row; R] {
        first_rows(self.block(block))
    }

    /// The rows of all blocks, one block after the other.
    pub fn data_mut(&mut self) -> &mut [Row] {
        &mut self.data
    }

    /// Copies one quantity from planes with the same number of samples.
    pub fn copy_row(&mut self, row: usize, from: &Self, from_row: usize) {
        let blocks = self.data.chunks_exact_mut(self.rows).zip(from.data.chunks_exact(from.rows));
        blocks.for_each(|(to, from)| to[row] = from[from_row]);
    }

    /// Number of blocks.
    pub fn blocks(&self) -> usize {
        self.len.div_ceil(BLOCK)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_come_back_and_the_last_block_is_padded_with_zeros() {
        let planes = Planes::from_fn(300, |i| [i as f32, -(i as f32)]);
        assert_eq!((planes.rows(), planes.len(), planes.blocks()), (2, 300, 2));
        assert_eq!(planes.sample::<2>(299, 0), [299.0, -299.0]);
        assert_eq!(planes.get(1, 257), -257.0);
        assert!(planes.block(1).iter().all(|row| row.0[44..].iter().all(|v| *v == 0.0)));
    }
}

//! Per-sample quantities in the layout of the kernels: blocks of 256 samples, each quantity of a
//! block in one contiguous row, so that a chunk of samples is one contiguous piece of memory.

use rayon::prelude::*;

/// Samples per block.
pub const BLOCK: usize = 256;
/// Blocks that one task works through; sums are formed per chunk and added in chunk order, so that
/// results do not depend on the number of threads.
pub const CHUNK_BLOCKS: usize = 32;

/// One quantity of the samples of a block.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Row(pub [f32; BLOCK]);

impl Row {
    /// All zero.
    pub const ZERO: Self = Self([0.0; BLOCK]);
}

/// `rows` quantities of `len` samples; the samples that fill up the last block are zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Planes {
    rows: usize,
    len: usize,
    data: Vec<Row>,
}

impl Planes {
    /// Zeros.
    pub fn new(rows: usize, len: usize) -> Self {
        Self { rows, len, data: vec![Row::ZERO; rows * len.div_ceil(BLOCK)] }
    }

    /// `value(sample)[row]`, computed in parallel.
    pub fn from_fn<const R: usize>(len: usize, value: impl Fn(usize) -> [f32; R] + Sync) -> Self {
        let mut planes = Self::new(R, len);
        planes.data.par_chunks_mut(R).enumerate().for_each(|(block, rows)| {
            let first = block * BLOCK;
            for lane in 0..BLOCK.min(len - first) {
                for (row, value) in rows.iter_mut().zip(value(first + lane)) {
                    row.0[lane] = value;
                }
            }
        });
        planes
    }

    /// Number of quantities.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// One value.
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

    /// The rows of all blocks, one block after the other.
    pub fn data_mut(&mut self) -> &mut [Row] {
        &mut self.data
    }

    /// Copies one quantity of other planes of as many samples.
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

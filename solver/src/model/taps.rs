//! Bilinear taps, computed once: textures are sampled per pixel, gradients are gathered per texel.
//!
//! Samples are sorted by texel. The gradient of a strip of texture rows then comes from one contiguous
//! run of samples, read in a fixed order: no atomics, and the same sums for any number of threads; the
//! sums of a cell stay in registers while its samples pass. A sample's place is 12 bytes.

use std::ops::Range;

use glam::Vec2;
use rayon::prelude::*;

use super::kept::Kept;
use super::planes::{BLOCK, Planes, Row};
use crate::simd::widened;

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
    /// Sorts samples by texel; returns the taps, and the index of each in `uvs`.
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

    /// The selected samples.
    pub fn kept(&self, kept: &Kept) -> Self {
        Self {
            size: self.size,
            cell: kept.of(&self.cell),
            fraction: kept.of(&self.fraction),
            row_start: self.row_start.iter().map(|start| kept.before(*start)).collect(),
        }
    }

    /// Side of the texture, texels.
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

    /// The place of every sample between that texel's centre and the next ones', right and down; 0 to 1.
    pub fn fractions(&self) -> &[[f32; 2]] {
        &self.fraction
    }

    /// The column and row of a sample, in texels from the centre of the first texel.
    pub fn place(&self, sample: usize) -> [f32; 2] {
        let (cell, [fx, fy]) = (self.cell[sample] as usize, self.fraction[sample]);
        [(cell % self.size) as f32 + fx, (cell / self.size) as f32 + fy]
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

    /// The samples whose cells are in some rows.
    pub(super) fn samples_in(&self, rows: Range<usize>) -> Range<usize> {
        self.row_start[rows.start]..self.row_start[rows.end]
    }
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
    pub(super) fn sample_block<const C: usize>(
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
}

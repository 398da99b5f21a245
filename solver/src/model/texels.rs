//! Textures whose texels are whole vectors, `H` of four values: the same sums as of any texture in
//! [`super::taps`], with fewer instructions.

use std::ops::Range;

use glam::{Mat4, Vec4};

use super::planes::{BLOCK, Planes, Row};
use super::strips::{Strip, blocks};
use super::taps::Taps;
use crate::simd::{prefetch, widened};

/// Samples whose texels are asked for ahead of those of the one at hand.
const AHEAD: usize = 32;
/// Values of a vector.
const FOUR: usize = 4;

impl Taps {
    /// The first `rows` values of a texture at every sample.
    pub fn sample_vectors<const H: usize>(&self, texture: &[f32], rows: usize) -> Planes {
        Planes::from_blocks(rows, self.cells().len(), |block, rows| {
            self.sample_vectors_of::<H>(texture, block, rows);
        })
    }

    /// The same at the samples of a block.
    pub fn sample_vectors_of<const H: usize>(
        &self,
        texture: &[f32],
        block: usize,
        rows: &mut [Row],
    ) {
        let first = block * BLOCK;
        let samples = first..(first + BLOCK).min(self.cells().len());
        let mut values = [[Vec4::ZERO; H]; BLOCK];
        interpolate(texture, self, samples, &mut values);
        apart(&values, rows);
    }

    /// The adjoint of [`Taps::sample_vectors`], into texels of `D` = 4 `H` values.
    pub fn gather_vectors<const H: usize, const D: usize>(&self, gradient: &Planes) -> Vec<f32> {
        let add = |strip: &mut Strip<D>| {
            for (block, lanes) in blocks(strip.samples.clone()) {
                strip.add_vectors::<H>(block, lanes, gradient.block(block));
            }
        };
        self.by_strip(add).0
    }
}

impl<const D: usize> Strip<'_, D> {
    /// Adds the gradients of some lanes of a block, by the first values of a texel of `D` = 4 `H`.
    pub fn add_vectors<const H: usize>(&mut self, block: usize, lanes: Range<usize>, rows: &[Row]) {
        assert_eq!(D, FOUR * H);
        let mut values = [[Vec4::ZERO; H]; BLOCK];
        side_by_side(rows, &mut values);
        let samples = block * BLOCK + lanes.start..block * BLOCK + lanes.end;
        let texels = (self.texels.as_flattened_mut(), self.below.as_flattened_mut());
        gather(self.taps, self.first, samples, &values[lanes], texels);
    }
}

widened! {
    /// What samples see of the texels of their cells.
    fn interpolate<const H: usize>(
        texture: &[f32],
        taps: &Taps,
        samples: Range<usize>,
        values: &mut [[Vec4; H]],
    ) {
        let (texels, size) = (texture.as_chunks::<FOUR>().0.as_chunks::<H>().0, taps.size());
        let later = taps.cells().get(samples.start + AHEAD..).unwrap_or_default();
        let (cells, fractions) = (&taps.cells()[samples.clone()], &taps.fractions()[samples]);
        assert!(values.len() >= cells.len() && fractions.len() == cells.len());
        let mut sample = 0;
        // A cell's texels stay in registers while its samples pass.
        while sample < cells.len() {
            let at = cells[sample] as usize;
            if let Some(next) = later.get(sample) {
                let next = texels.as_ptr().wrapping_add(*next as usize);
                prefetch(next);
                prefetch(next.wrapping_add(size));
            }
            let (upper, mut down) = (pair(&texels[at..at + 2]), pair(&texels[at + size..at + size + 2]));
            for side in 0..2 {
                for half in 0..H {
                    down[side][half] -= upper[side][half];
                }
            }
            let cell = cells[sample];
            while sample < cells.len() && cells[sample] == cell {
                let [fx, fy] = fractions[sample];
                for half in 0..H {
                    let left = upper[0][half] + fy * down[0][half];
                    let right = upper[1][half] + fy * down[1][half];
                    values[sample][half] = left + fx * (right - left);
                }
                sample += 1;
            }
        }
    }
}

#[inline(always)]
fn pair<const H: usize>(texels: &[[[f32; FOUR]; H]]) -> [[Vec4; H]; 2] {
    let mut pair = [[Vec4::ZERO; H]; 2];
    for (vectors, texel) in pair.iter_mut().zip(texels) {
        for (vector, values) in vectors.iter_mut().zip(texel) {
            *vector = Vec4::from_array(*values);
        }
    }
    pair
}

widened! {
    /// The samples' values, row by row.
    fn apart<const H: usize>(values: &[[Vec4; H]; BLOCK], rows: &mut [Row]) {
        for (half, rows) in rows.chunks_mut(FOUR).enumerate() {
            for (at, values) in values.as_chunks::<FOUR>().0.iter().enumerate() {
                let [a, b, c, d] = values;
                for (row, values) in rows.iter_mut().zip(turned([a[half], b[half], c[half], d[half]])) {
                    row.0[FOUR * at..FOUR * at + FOUR].copy_from_slice(&values.to_array());
                }
            }
        }
    }
}

widened! {
    /// The reverse; what the rows lack is zero.
    fn side_by_side<const H: usize>(rows: &[Row], values: &mut [[Vec4; H]; BLOCK]) {
        for (half, rows) in rows.chunks(FOUR).take(H).enumerate() {
            for at in (0..BLOCK).step_by(FOUR) {
                let mut four = [Vec4::ZERO; FOUR];
                for (four, row) in four.iter_mut().zip(rows) {
                    *four = Vec4::from_slice(&row.0[at..at + FOUR]);
                }
                for (lane, vector) in turned(four).into_iter().enumerate() {
                    values[at + lane][half] = vector;
                }
            }
        }
    }
}

#[inline(always)]
pub(super) fn turned([x, y, z, w]: [Vec4; FOUR]) -> [Vec4; FOUR] {
    let Mat4 { x_axis, y_axis, z_axis, w_axis } = Mat4::from_cols(x, y, z, w).transpose();
    [x_axis, y_axis, z_axis, w_axis]
}

widened! {
    /// Adds what samples have to the texels of their cells, in rows of a texture from `first` on and in
    /// those below. The sums of a cell stay in registers while its samples pass.
    fn gather<const H: usize>(
        taps: &Taps,
        first: usize,
        samples: Range<usize>,
        values: &[[Vec4; H]],
        texels: (&mut [f32], &mut [f32]),
    ) {
        let texels = (
            texels.0.as_chunks_mut::<FOUR>().0.as_chunks_mut::<H>().0,
            texels.1.as_chunks_mut::<FOUR>().0.as_chunks_mut::<H>().0,
        );
        let (here, below, size) = (texels.0, texels.1, taps.size());
        let (cells, fractions) = (&taps.cells()[samples.clone()], &taps.fractions()[samples]);
        assert!(fractions.len() == cells.len() && values.len() == cells.len());
        let mut sample = 0;
        while sample < cells.len() {
            let cell = cells[sample];
            let (mut upper, mut lower) = ([[Vec4::ZERO; H]; 2], [[Vec4::ZERO; H]; 2]);
            while sample < cells.len() && cells[sample] == cell {
                let [fx, fy] = fractions[sample];
                for (side, share) in [1.0 - fx, fx].into_iter().enumerate() {
                    for (half, value) in values[sample].iter().enumerate() {
                        let value = share * value;
                        upper[side][half] += (1.0 - fy) * value;
                        lower[side][half] += fy * value;
                    }
                }
                sample += 1;
            }
            let at = cell as usize - first * size;
            for (at, sums) in [(at, upper), (at + size, lower)] {
                match at.checked_sub(here.len()) {
                    None => add(&mut here[at..at + 2], &sums),
                    Some(at) => add(&mut below[at..at + 2], &sums),
                }
            }
        }
    }
}

#[inline(always)]
fn add<const H: usize>(texels: &mut [[[f32; FOUR]; H]], sums: &[[Vec4; H]; 2]) {
    for (texel, sums) in texels.iter_mut().zip(sums) {
        for (values, sum) in texel.iter_mut().zip(sums) {
            *values = (Vec4::from_array(*values) + sum).to_array();
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;

    /// Bit for bit what any texture's sums are, on more rows than a strip has.
    #[test]
    fn vectors_are_four_channels() {
        let (size, count) = (300, 5000);
        let noise = |i: usize, k: f32| ((i as f32 + 1.0) * k).sin().abs();
        let uvs: Vec<_> =
            (0..count).map(|i| Vec2::new(noise(i, 12.9898), noise(i, 78.233))).collect();
        let taps = Taps::sorted(size, &uvs).0;
        let texture: Vec<f32> = (0..size * size * 8).map(|i| noise(i, 0.37)).collect();
        let planes = taps.sample::<8>(&texture);
        assert_eq!(taps.sample_vectors::<2>(&texture, 8), planes);
        assert_eq!(taps.gather_vectors::<2, 8>(&planes), taps.gather::<8>(&planes, 0));
        let part = taps.sample_vectors::<2>(&texture, 7);
        assert!((0..count).all(|i| part.sample::<7>(i, 0) == planes.sample::<7>(i, 0)));
        let (mut sums, others) = (taps.gather::<8>(&planes, 0), taps.gather_vectors::<2, 8>(&part));
        sums.iter_mut().skip(7).step_by(8).for_each(|sum| *sum = 0.0);
        assert_eq!(sums, others);
    }
}

//! Textures of four channels, whose texels are whole vectors: the same sums as of any texture in
//! [`super::taps`], with fewer instructions.

use std::ops::Range;

use glam::{Mat4, Vec4};

use super::planes::{BLOCK, Planes, Row};
use super::strips::{Strip, blocks};
use super::taps::Taps;
use crate::simd::{prefetch, widened};

/// The number of values of a texel.
pub const TEXEL_VALUES: usize = 4;
/// The values of a texel, one vector of the processor.
pub type Texel = [f32; TEXEL_VALUES];

/// Distance of the prefetch, samples.
const AHEAD: usize = 32;

impl Taps {
    /// A texture at every sample (4 rows).
    pub fn sample_vectors(&self, texture: &[f32]) -> Planes {
        Planes::from_blocks(TEXEL_VALUES, self.cells().len(), |block, rows| {
            self.sample_vectors_of(texture, block, rows);
        })
    }

    /// A texture at the samples of a block (4 rows).
    pub fn sample_vectors_of(&self, texture: &[f32], block: usize, rows: &mut [Row]) {
        let first = block * BLOCK;
        let samples = first..(first + BLOCK).min(self.cells().len());
        let mut values = [Vec4::ZERO; BLOCK];
        interpolate(texture.as_chunks().0, self, samples, &mut values);
        deinterleave(&values, rows);
    }

    /// The adjoint of [`Taps::sample_vectors`].
    pub fn gather_vectors(&self, gradient: &Planes) -> Vec<f32> {
        let add = |strip: &mut Strip<TEXEL_VALUES>| {
            for (block, lanes) in blocks(strip.samples.clone()) {
                strip.add_vectors(block, lanes, gradient.block(block));
            }
        };
        self.by_strip(add).0
    }
}

impl<const D: usize> Strip<'_, D> {
    /// Adds the gradients of some lanes of a block, a row for each of the channels, which are one texel of four
    /// or several.
    pub fn add_vectors(&mut self, block: usize, lanes: Range<usize>, rows: &[Row]) {
        let samples = block * BLOCK + lanes.start..block * BLOCK + lanes.end;
        let here = self.texels.as_flattened_mut().as_chunks_mut().0;
        let below = self.below.as_flattened_mut().as_chunks_mut().0;
        let stride = D / TEXEL_VALUES;
        for (part, rows) in rows.chunks_exact(TEXEL_VALUES).enumerate() {
            let mut values = [Vec4::ZERO; BLOCK];
            side_by_side(rows, &mut values);
            let values = &values[lanes.clone()];
            gather(self.taps, self.first, samples.clone(), values, [part, stride], here, below);
        }
    }
}

widened! {
    /// A texture at `samples`, interpolated between the texels of their cells.
    fn interpolate(texels: &[Texel], taps: &Taps, samples: Range<usize>, values: &mut [Vec4]) {
        let size = taps.size();
        let later = taps.cells().get(samples.start + AHEAD..).unwrap_or_default();
        let (cells, fractions) = (&taps.cells()[samples.clone()], &taps.fractions()[samples]);
        assert!(values.len() >= cells.len() && fractions.len() == cells.len());
        let mut sample = 0;
        // The texels of a cell stay in registers during its samples.
        while sample < cells.len() {
            let cell = cells[sample];
            if let Some(next) = later.get(sample) {
                let next = texels.as_ptr().wrapping_add(*next as usize);
                prefetch(next);
                prefetch(next.wrapping_add(size));
            }
            let at = cell as usize;
            let (upper, mut down) = (pair(&texels[at..at + 2]), pair(&texels[at + size..at + size + 2]));
            for side in 0..2 {
                down[side] -= upper[side];
            }
            while sample < cells.len() && cells[sample] == cell {
                let [fx, fy] = fractions[sample];
                let left = upper[0] + fy * down[0];
                let right = upper[1] + fy * down[1];
                values[sample] = left + fx * (right - left);
                sample += 1;
            }
        }
    }
}

#[inline(always)]
fn pair(texels: &[Texel]) -> [Vec4; 2] {
    [Vec4::from_array(texels[0]), Vec4::from_array(texels[1])]
}

widened! {
    /// The samples' values, row by row.
    fn deinterleave(values: &[Vec4; BLOCK], rows: &mut [Row]) {
        for (at, values) in values.as_chunks::<TEXEL_VALUES>().0.iter().enumerate() {
            for (row, values) in rows.iter_mut().zip(transposed(*values)) {
                row.0[TEXEL_VALUES * at..][..TEXEL_VALUES].copy_from_slice(&values.to_array());
            }
        }
    }
}

widened! {
    /// The inverse of [`deinterleave`].
    fn side_by_side(rows: &[Row], values: &mut [Vec4; BLOCK]) {
        for (at, values) in values.as_chunks_mut::<TEXEL_VALUES>().0.iter_mut().enumerate() {
            let mut four = [Vec4::ZERO; TEXEL_VALUES];
            for (four, row) in four.iter_mut().zip(rows) {
                *four = Vec4::from_slice(&row.0[TEXEL_VALUES * at..][..TEXEL_VALUES]);
            }
            *values = transposed(four);
        }
    }
}

/// Four values of four samples.
#[inline(always)]
fn transposed([x, y, z, w]: [Vec4; TEXEL_VALUES]) -> [Vec4; TEXEL_VALUES] {
    let Mat4 { x_axis, y_axis, z_axis, w_axis } = Mat4::from_cols(x, y, z, w).transpose();
    [x_axis, y_axis, z_axis, w_axis]
}

widened! {
    /// Adds the values of samples to the texels of their cells, in rows of a texture from `first` on and in the rows
    /// below; to the texel with index `part` of each group of `stride`. The sums of a cell stay in registers during its
    /// samples.
    fn gather(
        taps: &Taps,
        first: usize,
        samples: Range<usize>,
        values: &[Vec4],
        part_of: [usize; 2],
        here: &mut [Texel],
        below: &mut [Texel],
    ) {
        let (size, [part, stride]) = (taps.size(), part_of);
        let (cells, fractions) = (&taps.cells()[samples.clone()], &taps.fractions()[samples]);
        assert!(fractions.len() == cells.len() && values.len() == cells.len());
        let mut sample = 0;
        while sample < cells.len() {
            let cell = cells[sample];
            let (mut upper, mut lower) = ([Vec4::ZERO; 2], [Vec4::ZERO; 2]);
            while sample < cells.len() && cells[sample] == cell {
                let [fx, fy] = fractions[sample];
                for (side, share) in [1.0 - fx, fx].into_iter().enumerate() {
                    let value = share * values[sample];
                    upper[side] += (1.0 - fy) * value;
                    lower[side] += fy * value;
                }
                sample += 1;
            }
            let at = cell as usize - first * size;
            for (at, sums) in [(at, upper), (at + size, lower)] {
                let at = at * stride + part;
                match at.checked_sub(here.len()) {
                    None => add(&mut here[at..], stride, sums),
                    Some(at) => add(&mut below[at..], stride, sums),
                }
            }
        }
    }
}

#[inline(always)]
fn add(texels: &mut [Texel], stride: usize, sums: [Vec4; 2]) {
    for (at, sum) in [0, stride].into_iter().zip(sums) {
        texels[at] = (Vec4::from_array(texels[at]) + sum).to_array();
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;

    /// The sums are bit for bit those of any texture, on more rows than a strip has.
    #[test]
    fn vectors_are_four_channels() {
        let (size, count) = (300, 5000);
        let noise = |i: usize, k: f32| ((i as f32 + 1.0) * k).sin().abs();
        let uvs: Vec<_> =
            (0..count).map(|i| Vec2::new(noise(i, 12.9898), noise(i, 78.233))).collect();
        let taps = Taps::sorted(size, &uvs).0;
        let texture: Vec<f32> = (0..size * size * TEXEL_VALUES).map(|i| noise(i, 0.37)).collect();
        let planes = taps.sample::<TEXEL_VALUES>(&texture);
        assert_eq!(taps.sample_vectors(&texture), planes);
        assert_eq!(taps.gather_vectors(&planes), taps.gather::<TEXEL_VALUES>(&planes, 0));
    }
}

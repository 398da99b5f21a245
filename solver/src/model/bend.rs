//! The textures that bend the normals, and the specular albedo, side by side: sampled together, and their
//! gradients gathered together.

use std::ops::Range;

use glam::{Mat4, Vec4};

use super::planes::{BLOCK, Planes, Row};
use super::taps::{Strip, Taps};
use crate::backend::BENT;
use crate::simd::widened;

/// d (3 values), its blur (3), the specular albedo, and one that fills up two vectors; or gradients by
/// them.
pub type Texel = [f32; TEXEL];
/// Values of a texel.
pub const TEXEL: usize = 8;

/// The textures d and blur(d), 3 channels each.
pub struct Bend {
    /// For the specular normal.
    pub sharp: Vec<f32>,
    /// For the diffuse normal.
    pub blurred: Vec<f32>,
}

/// d, its blur and the specular albedo at every sample.
pub fn sample(texels: &[Texel], taps: &Taps) -> Planes {
    Planes::from_blocks(BENT, taps.cells().len(), |block, rows| {
        rows.first_chunk_mut().into_iter().for_each(|rows| sample_block(texels, taps, block, rows));
    })
}

/// The same at the samples of a block.
pub fn sample_block(texels: &[Texel], taps: &Taps, block: usize, rows: &mut [Row; BENT]) {
    let first = block * BLOCK;
    let last = (first + BLOCK).min(taps.cells().len());
    let (cells, fractions) = (&taps.cells()[first..last], &taps.fractions()[first..last]);
    let mut values = [[Vec4::ZERO; 2]; BLOCK];
    interpolate(texels, taps.size(), cells, fractions, &mut values);
    apart(&values, rows);
}

impl Strip<'_, TEXEL> {
    /// Adds the gradients of some lanes of a block.
    pub fn add_bent(&mut self, block: usize, lanes: Range<usize>, rows: &[Row; BENT]) {
        let mut values = [[Vec4::ZERO; 2]; BLOCK];
        side_by_side(rows, &mut values);
        gather(self, block * BLOCK, lanes, &values);
    }
}

widened! {
    /// What samples see of the texels of their cells. A cell's stay in registers while its samples pass.
    fn interpolate(
        texels: &[Texel],
        size: usize,
        cells: &[u32],
        fractions: &[[f32; 2]],
        values: &mut [[Vec4; 2]; BLOCK],
    ) {
        assert!(cells.len() <= BLOCK && fractions.len() == cells.len());
        let mut sample = 0;
        while sample < cells.len() {
            let cell = cells[sample];
            let at = cell as usize;
            let (upper, lower) = (pair(&texels[at..at + 2]), pair(&texels[at + size..at + size + 2]));
            let mut down = lower;
            for side in 0..2 {
                for half in 0..2 {
                    down[side][half] -= upper[side][half];
                }
            }
            while sample < cells.len() && cells[sample] == cell {
                let [fx, fy] = fractions[sample];
                for half in 0..2 {
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
fn pair(texels: &[Texel]) -> [[Vec4; 2]; 2] {
    let halves = |texel: &Texel| [Vec4::from_slice(&texel[..4]), Vec4::from_slice(&texel[4..])];
    [halves(&texels[0]), halves(&texels[1])]
}

widened! {
    /// The samples' values, row by row.
    fn apart(values: &[[Vec4; 2]; BLOCK], rows: &mut [Row; BENT]) {
        for (at, values) in values.as_chunks::<4>().0.iter().enumerate() {
            for half in 0..2 {
                let [x, y, z, w] = [values[0][half], values[1][half], values[2][half], values[3][half]];
                let Mat4 { x_axis, y_axis, z_axis, w_axis } = Mat4::from_cols(x, y, z, w).transpose();
                let columns = [x_axis, y_axis, z_axis, w_axis];
                for (row, column) in rows[4 * half..].iter_mut().zip(columns) {
                    row.0[4 * at..4 * at + 4].copy_from_slice(&column.to_array());
                }
            }
        }
    }
}

widened! {
    /// The rows' values of every sample.
    fn side_by_side(rows: &[Row; BENT], values: &mut [[Vec4; 2]; BLOCK]) {
        let [a, b, c, d, e, f, g] = rows;
        for at in (0..BLOCK).step_by(4) {
            let columns = |rows: [&Row; 4]| {
                let [x, y, z, w] = rows.map(|row| Vec4::from_slice(&row.0[at..at + 4]));
                let Mat4 { x_axis, y_axis, z_axis, w_axis } = Mat4::from_cols(x, y, z, w).transpose();
                [x_axis, y_axis, z_axis, w_axis]
            };
            let (first, second) = (columns([a, b, c, d]), columns([e, f, g, &Row::ZERO]));
            for lane in 0..4 {
                values[at + lane] = [first[lane], second[lane]];
            }
        }
    }
}

widened! {
    /// Adds what samples have to the texels of their cells. The sums of a cell stay in registers while its
    /// samples pass.
    fn gather(
        strip: &mut Strip<TEXEL>,
        first: usize,
        lanes: Range<usize>,
        values: &[[Vec4; 2]; BLOCK],
    ) {
        let size = strip.taps.size();
        let samples = first + lanes.start..first + lanes.end;
        let cells = &strip.taps.cells()[samples.clone()];
        let fractions = &strip.taps.fractions()[samples];
        let values = &values[lanes];
        assert!(fractions.len() == cells.len() && values.len() == cells.len());
        let mut sample = 0;
        while sample < cells.len() {
            let cell = cells[sample];
            let (mut upper, mut lower) = ([[Vec4::ZERO; 2]; 2], [[Vec4::ZERO; 2]; 2]);
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
            let at = cell as usize - strip.first * size;
            add(&mut strip.texels[at..at + 2], &upper);
            match (at + size).checked_sub(strip.texels.len()) {
                None => add(&mut strip.texels[at + size..at + size + 2], &lower),
                Some(at) => add(&mut strip.below[at..at + 2], &lower),
            }
        }
    }
}

#[inline(always)]
fn add(texels: &mut [Texel], sums: &[[Vec4; 2]; 2]) {
    for (texel, sums) in texels.iter_mut().zip(sums) {
        for (half, sum) in texel.as_chunks_mut().0.iter_mut().zip(sums) {
            *half = (Vec4::from_array(*half) + sum).to_array();
        }
    }
}

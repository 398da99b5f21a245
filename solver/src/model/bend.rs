//! The textures that bend the normals, and the specular albedo: sampled together, and their gradients
//! gathered together.

use std::ops::Range;

use glam::{Mat4, Vec4};

use super::planes::{BLOCK, Planes, Row};
use super::samples::Samples;
use super::taps::Strip;
use crate::backend::BENT;
use crate::simd::widened;

/// Values of a texel's gradient: by d (3), by its blur (3), by the specular albedo, and one that fills up
/// two vectors.
pub const GRADIENT: usize = 8;

/// The textures d and blur(d), 3 channels each.
pub struct Bend {
    /// For the specular normal.
    pub sharp: Vec<f32>,
    /// For the diffuse normal.
    pub blurred: Vec<f32>,
}

impl Bend {
    /// Zeros, for textures of side `size`.
    pub fn new(size: usize) -> Self {
        let texture = || vec![0.0; 3 * size * size];
        Self { sharp: texture(), blurred: texture() }
    }

    /// d, its blur and the specular albedo at every sample.
    pub fn sample(&self, specular: &[f32], samples: &Samples) -> Planes {
        Planes::from_blocks(BENT, samples.len(), |block, rows| {
            rows.first_chunk_mut().into_iter().for_each(|rows| {
                self.sample_block(specular, samples, block, rows);
            });
        })
    }

    /// The same at the samples of a block.
    pub fn sample_block(
        &self,
        specular: &[f32],
        samples: &Samples,
        block: usize,
        rows: &mut [Row; BENT],
    ) {
        let [a, b, c, d, e, f, g] = rows;
        samples.taps.sample_block(&self.sharp, block, [a, b, c]);
        samples.taps.sample_block(&self.blurred, block, [d, e, f]);
        samples.taps.sample_block(specular, block, [g]);
    }
}

impl Strip<'_, GRADIENT> {
    /// Adds the gradients of some lanes of a block.
    pub fn add_bent(&mut self, block: usize, lanes: Range<usize>, rows: &[Row; BENT]) {
        let mut values = [[Vec4::ZERO; 2]; BLOCK];
        side_by_side(rows, &mut values);
        gather(self, block * BLOCK, lanes, &values);
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
        strip: &mut Strip<GRADIENT>,
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
fn add(texels: &mut [[f32; GRADIENT]], sums: &[[Vec4; 2]; 2]) {
    for (texel, sums) in texels.iter_mut().zip(sums) {
        for (half, sum) in texel.as_chunks_mut().0.iter_mut().zip(sums) {
            *half = (Vec4::from_array(*half) + sum).to_array();
        }
    }
}

//! The deviation textures packed with the specular albedo, sampled together; and gradients with respect to them.

use super::planes::{Planes, Row};
use super::taps::Taps;
use super::texels::TEXEL_VALUES;

/// Rows of a sample: d (3), specular albedo, blur(d) (3), padding to two vectors; or gradients with respect to them.
pub const ROWS: usize = 2 * TEXEL_VALUES;
/// The row of the specular albedo.
pub const SPECULAR: usize = 3;
/// The first row of blur(d).
pub const BLURRED: usize = TEXEL_VALUES;

/// The textures d and blur(d), 3 channels each.
pub struct DeviationTextures {
    /// d, of the specular normal.
    pub sharp: Vec<f32>,
    /// blur(d), of the diffuse normal.
    pub blurred: Vec<f32>,
}

/// [`DeviationTextures`] in texels of four values, which are read as whole vectors.
#[derive(Clone, Debug, PartialEq)]
pub struct PackedDeviations {
    /// d, and the specular albedo.
    pub sharp: Vec<f32>,
    /// Their blur; the last value is unused.
    pub blurred: Vec<f32>,
}

impl PackedDeviations {
    /// The values at every sample ([`ROWS`] rows).
    pub fn sample(&self, taps: &Taps) -> Planes {
        Planes::from_blocks(ROWS, taps.cells().len(), |block, out| {
            self.sample_block(taps, block, out);
        })
    }

    /// The values at the samples of a block.
    pub fn sample_block(&self, taps: &Taps, block: usize, out: &mut [Row]) {
        let (sharp, blurred) = out.split_at_mut(BLURRED);
        taps.sample_vectors_of(&self.sharp, block, sharp);
        taps.sample_vectors_of(&self.blurred, block, blurred);
    }
}

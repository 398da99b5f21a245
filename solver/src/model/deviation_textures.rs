//! The textures by which normals deviate from the mesh's, and the specular albedo, as samples see them; and
//! gradients by them.

use super::planes::{Planes, Row};
use super::taps::Taps;
use super::texels::CHANNELS;

/// Rows at a sample: d (3), specular albedo, blur(d) (3), and one that fills up two vectors; or gradients by
/// them.
pub const ROWS: usize = 2 * CHANNELS;
/// The row of the specular albedo.
pub const SPECULAR: usize = 3;
/// The first row of blur(d).
pub const BLURRED: usize = CHANNELS;

/// The textures d and blur(d), 3 channels each.
pub struct DeviationTextures {
    /// For the specular normal.
    pub sharp: Vec<f32>,
    /// For the diffuse normal.
    pub blurred: Vec<f32>,
}

/// [`DeviationTextures`] in texels of four values, which samples read as whole vectors.
#[derive(Clone, Debug, PartialEq)]
pub struct PackedDeviations {
    /// d, and the specular albedo.
    pub sharp: Vec<f32>,
    /// Their blur, of which the last value has no use.
    pub blurred: Vec<f32>,
}

impl PackedDeviations {
    /// At every sample ([`ROWS`] rows).
    pub fn sample(&self, taps: &Taps) -> Planes {
        Planes::from_blocks(ROWS, taps.cells().len(), |block, out| {
            self.sample_block(taps, block, out);
        })
    }

    /// At the samples of a block.
    pub fn sample_block(&self, taps: &Taps, block: usize, out: &mut [Row]) {
        let (sharp, blurred) = out.split_at_mut(BLURRED);
        taps.sample_vectors_of(&self.sharp, block, sharp);
        taps.sample_vectors_of(&self.blurred, block, blurred);
    }
}

//! The textures that bend the normals, and the specular albedo.

/// d (3 values), its blur (3), the specular albedo, and one that fills up two vectors; or gradients by
/// them.
pub type Texel = [f32; TEXEL];
/// Values of a texel.
pub const TEXEL: usize = 4 * VECTORS;
/// Vectors of a texel.
pub const VECTORS: usize = 2;

/// The textures d and blur(d), 3 channels each.
pub struct Bend {
    /// For the specular normal.
    pub sharp: Vec<f32>,
    /// For the diffuse normal.
    pub blurred: Vec<f32>,
}

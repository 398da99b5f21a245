//! The model: samples, three networks, shading, textures with their blur, and the albedo prior.

pub mod blur;
pub mod deviation;
pub mod deviation_textures;
mod gather;
pub mod height;
pub mod kept;
pub mod layer;
pub mod networks;
pub mod normals;
pub mod planes;
pub mod prior;
pub mod pyramid;
mod rows;
pub mod samples;
pub mod strips;
pub mod taps;
pub mod texels;
pub mod texture;

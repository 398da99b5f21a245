//! Decomposes pictures of a known mesh into reflectance maps (neural shading fields).
//!
//! A pixel is read once in [`capture`], becomes a sample of the G-buffer, meets its weights in
//! [`backend`], and its error ends in a texel of [`maps`].

pub mod atomic;
pub mod backend;
pub mod baselines;
pub mod capture;
pub mod config;
mod convolution;
pub mod error;
pub mod fill;
mod first_look;
pub mod gbuffer;
pub mod maps;
pub mod memory;
pub mod model;
pub mod obj;
pub mod optimise;
mod parallel;
pub mod picture;
pub mod projection;
pub mod semantic;
mod simd;
pub mod solution;
#[cfg(test)]
mod testing;
pub mod transport;

pub use backend::{Backend, BackendError, Choice};
pub use capture::{Camera, Capture, Mesh, View};
pub use config::Config;
pub use error::{CaptureError, ConfigError, MapsError, SolveError};
pub use gbuffer::mesh_normal_map;
pub use maps::Maps;
pub use optimise::checkpoint::Checkpoint;
pub use optimise::solve::{Options, Progress, solve_into, solve_on};
pub use solution::{Record, Solution, StageMaps, Timing, ViewLayers};

/// The instruction set that the processor backend uses on this machine.
pub fn simd_level() -> String {
    let levels = backend::cpu::Level::available();
    levels.last().map_or_else(String::new, ToString::to_string)
}

//! Decomposes pictures of a known mesh into reflectance maps (neural shading fields).
//!
//! A pixel is read once in [`capture`], becomes a sample of the G-buffer, meets its weights in
//! [`backend`], and its error ends in a texel of [`formats::Maps`].

pub mod backend;
pub mod baselines;
pub mod config;
mod convolution;
pub mod memory;
pub mod model;
pub mod optimise;
mod parallel;
pub mod semantic;
mod simd;
pub mod solution;
#[cfg(test)]
#[path = "../capture/src/testing.rs"]
mod testing;
pub mod transport;
mod view_weights;

pub use backend::{Backend, BackendError, Choice};
pub use config::{Config, ConfigError, expected_texture_size};
pub use optimise::checkpoint::Checkpoint;
pub use optimise::error::SolveError;
pub use optimise::progress::{LayerSink, Options, Progress};
pub use optimise::solve::{Extent, seconds_on_two_cores, solve_into, solve_on};
pub use solution::{Record, Solution, StageMaps, Timing, ViewLayers};

/// The instruction set that the processor backend uses on this machine.
pub fn simd_level() -> String {
    let levels = backend::cpu::Level::available();
    levels.last().map_or_else(String::new, ToString::to_string)
}

//! Decomposes pictures of a known mesh into reflectance maps.
//!
//! [`unshade`] is the default method, [`paper`] the published one (Neural Shading Fields). Each is a pipeline of
//! values: a stage takes what the stages before it returned, and returns a value that is stored for a resume.

pub mod backend;
pub mod baselines;
pub mod config;
mod convolution;
pub mod exposure;
pub mod fit;
mod maps;
pub mod memory;
pub mod model;
pub mod paper;
mod parallel;
mod run;
mod scene;
pub mod semantic;
mod simd;
pub mod solution;
mod solve;
#[cfg(test)]
mod test_scene;
#[cfg(test)]
#[path = "../capture/src/testing.rs"]
mod testing;
pub mod transport;
mod unshade;
mod view_weights;

pub use backend::{Backend, BackendError, Choice};
pub use config::{Config, ConfigError};
pub use maps::StageMaps;
pub use run::Extent;
pub use run::checkpoint::Checkpoint;
pub use run::error::SolveError;
pub use run::progress::{LayerSink, Options, Progress};
pub use solution::{Record, Solution, Timing, ViewLayers};
pub use solve::{seconds_on_two_cores, solve_into, solve_on};

/// The instruction set that the processor backend uses on this machine.
pub fn simd_level() -> String {
    let levels = backend::cpu::Level::available();
    levels.last().map_or_else(String::new, ToString::to_string)
}

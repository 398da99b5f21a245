//! Errors of a solve.

use capture::CaptureError;
use formats::maps::MapsError;

use crate::config::ConfigError;
use crate::memory::NotEnoughMemory;

/// The reason why a solve failed.
#[derive(Debug, thiserror::Error)]
pub enum SolveError {
    /// The configuration is out of range.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The published method and the baselines have no parts that could be held fixed.
    #[error(
        "only `unshade` can be given parts of the truth; choose a configuration with this base, and no baseline"
    )]
    GivenToOther,
    /// The method has one light that stands still, the capture has others.
    #[error("{lights}, but {method} assumes one light that stands still; use unshade")]
    SeveralLights {
        /// The lights of the capture.
        lights: &'static str,
        /// The method's name.
        method: &'static str,
    },
    /// A view cannot be compared with the others.
    #[error(
        "view {0}: its exposure is unknown and cannot be solved for, since no other view shows enough of the surface \
         that it shows; leave it out"
    )]
    Exposure(String),
    /// The capture shows nothing of the mesh.
    #[error(transparent)]
    Capture(#[from] CaptureError),
    /// The loss became NaN or infinite.
    #[error(
        "the loss of stage {stage} is {loss} at iteration {iteration}; {}",
        if *iteration > 1 {
            "lower that stage's rates"
        } else {
            "no rate has acted yet, so check the capture: cameras, masks and pictures"
        }
    )]
    NotFinite {
        /// The stage's name.
        stage: String,
        /// Iteration within the stage, from 1.
        iteration: usize,
        /// NaN or infinity.
        loss: f64,
    },
    /// The caller interrupted at a step. It never leaves a solve, which ends with maps of the current estimates.
    #[error("interrupted")]
    Interrupted,
    /// Not enough memory.
    #[error(transparent)]
    Memory(#[from] NotEnoughMemory),
    /// The maps cannot be written.
    #[error(transparent)]
    Maps(#[from] MapsError),
}

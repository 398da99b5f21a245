//! The errors of a benchmark.

use std::io;

/// An error of a benchmark; each message is one line.
#[derive(Debug, thiserror::Error)]
pub enum BenchError {
    /// A capture cannot be used.
    #[error(transparent)]
    Capture(#[from] capture::CaptureError),
    /// A configuration cannot be used.
    #[error(transparent)]
    Config(#[from] solver::ConfigError),
    /// A device cannot be opened, or failed.
    #[error(transparent)]
    Backend(#[from] solver::BackendError),
    /// A capture could not be solved.
    #[error(transparent)]
    Solve(#[from] solver::SolveError),
    /// PyTorch cannot take the steps.
    #[error(transparent)]
    Torch(#[from] super::torch::TorchError),
    /// The maps of a solve cannot be written.
    #[error(
        "the folder for temporary files cannot be used: {0}; make room, or name another in TMPDIR"
    )]
    Temporary(#[from] io::Error),
}

//! Why a measurement did not come to its end.

use std::io;

/// Each message is one line.
#[derive(Debug, thiserror::Error)]
pub enum BenchError {
    /// A capture that was to be solved cannot be used.
    #[error(transparent)]
    Capture(#[from] capture::CaptureError),
    /// A configuration cannot be used.
    #[error(transparent)]
    Config(#[from] solver::ConfigError),
    /// A device cannot be had, or gave up.
    #[error(transparent)]
    Backend(#[from] solver::BackendError),
    /// A capture could not be solved.
    #[error(transparent)]
    Solve(#[from] solver::SolveError),
    /// PyTorch's steps could not be taken.
    #[error(transparent)]
    Torch(#[from] super::torch::TorchError),
    /// There is no room for a solve's maps.
    #[error(
        "the folder for temporary files cannot be used: {0}; make room, or name another in TMPDIR"
    )]
    Temporary(#[from] io::Error),
}

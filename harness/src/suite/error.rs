//! How a suite or one of its stages can end badly.

use std::io;
use std::path::PathBuf;

use formats::atomic::FolderError;
use report::ReportError;
use scoring::compare::CompareError;
use scoring::score::ScoreError;

use super::scene::SceneError;
use crate::rerun_viewer::ViewerError;
use crate::synth::{InterpreterError, StageError};

/// How a run can end badly; each message is one line.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)]
pub enum RunError {
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Interpreter(#[from] InterpreterError),
    #[error(transparent)]
    Stage(StageError),
    #[error(transparent)]
    Capture(#[from] capture::CaptureError),
    #[error(transparent)]
    Config(#[from] solver::ConfigError),
    #[error(transparent)]
    Backend(#[from] solver::BackendError),
    #[error(transparent)]
    Solve(#[from] solver::SolveError),
    #[error(transparent)]
    Maps(#[from] formats::MapsError),
    #[error(transparent)]
    Score(#[from] ScoreError),
    #[error(transparent)]
    Check(#[from] scoring::check::CheckError),
    #[error(transparent)]
    Report(ReportError),
    #[error(transparent)]
    Compare(#[from] CompareError),
    #[error(transparent)]
    Study(#[from] scoring::study::StudyError),
    #[error(transparent)]
    Viewer(#[from] ViewerError),
    #[error(transparent)]
    View(#[from] view::ViewError),
    #[error(transparent)]
    Bench(#[from] bench::BenchError),
    #[error("{name} failed: {reason}; the others are in {}", report.display())]
    Methods { name: String, reason: String, report: PathBuf },
    #[error("method {name}: {reason}")]
    Program { name: String, reason: String },
    #[error("{0}: another run is using this folder; wait for it or choose another")]
    Busy(PathBuf),
    #[error(transparent)]
    Output(#[from] FolderError),
    #[error("{path}: {reason}", path = path.display())]
    File { path: PathBuf, reason: io::Error },
    #[error("{path}: {reason}", path = path.display())]
    ConfigFile { path: PathBuf, reason: solver::ConfigError },
    #[error("the run folder cannot be used: {0}; make room or choose another")]
    Folder(#[from] io::Error),
    #[error("{flag}: {reason}")]
    UnknownName { flag: &'static str, reason: String },
    #[error(transparent)]
    Seal(#[from] sealing::SealError),
    #[error("{0}")]
    Submission(String),
    #[error("{0}")]
    Argument(String),
    #[error("worker: {0}")]
    Worker(String),
    #[error("--keep: a run has no {name:?}; there are {known}")]
    Keep { name: String, known: String },
    #[error("{0}: is not a run's folder; name one that `unshade run` wrote")]
    NoRun(PathBuf),
    #[error("interrupted; run the same command to resume")]
    Interrupted,
    #[error(
        "interrupted in {place}; {} has the maps so far, run the same command to resume",
        maps.display()
    )]
    Stopped { place: String, maps: PathBuf },
}

impl RunError {
    /// Whether the user wanted it.
    pub fn is_interrupt(&self) -> bool {
        matches!(self, Self::Interrupted | Self::Stopped { .. })
    }

    /// Whether it is the fault of one method, so that the others can go on: not so for what the user
    /// wanted, and what a disk or a folder does to all.
    pub(super) fn is_of_method(&self) -> bool {
        let storage = |kind: &str| kind == "StorageError";
        match self {
            Self::Interrupted | Self::Stopped { .. } | Self::Folder(_) | Self::Busy(_) => false,
            Self::Worker(_) => false,
            Self::Output(FolderError::Io { .. } | FolderError::Space { .. }) => false,
            // A metric that fails is not a fault of the maps that it is given.
            Self::Stage(StageError::Input { kind, .. }) => !storage(kind) && kind != "MetricError",
            Self::Stage(StageError::Interpreter(_)) | Self::Interpreter(_) => false,
            _ => true,
        }
    }
}

impl From<StageError> for RunError {
    fn from(error: StageError) -> Self {
        match error {
            StageError::Interrupted => Self::Interrupted,
            error => Self::Stage(error),
        }
    }
}

impl From<ReportError> for RunError {
    fn from(error: ReportError) -> Self {
        match error {
            ReportError::Interrupted => Self::Interrupted,
            error => Self::Report(error),
        }
    }
}

//! Reasons why a study cannot be made.

use std::io;
use std::path::{Path, PathBuf};

use formats::atomic::FolderError;

use crate::run::RunFileError;
use crate::score::ScoreError;

/// An error of a study; each message is one line.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A file cannot be read or written.
    #[error("{path}: {reason}")]
    Io {
        /// The file.
        path: PathBuf,
        /// The operating system's error.
        reason: io::Error,
    },
    /// A file is not what it should be.
    #[error("{path}: cannot be understood: {reason}")]
    Text {
        /// The file.
        path: PathBuf,
        /// The parser's error, on one line.
        reason: String,
    },
    /// No run has a score.
    #[error("{0}: has no scores to study; run the suite to its end")]
    Empty(PathBuf),
    /// One case twice would count as two.
    #[error("{run}: {case}, {method}: is in another run given too; give each result once")]
    Twice {
        /// The run.
        run: PathBuf,
        /// The case.
        case: String,
        /// The method.
        method: String,
    },
    /// A run's manifest cannot be used.
    #[error(transparent)]
    Run(#[from] RunFileError),
    /// A scores file of a run is broken.
    #[error(transparent)]
    Scores(#[from] ScoreError),
    /// The folder must not be written where it was to be.
    #[error(transparent)]
    Folder(#[from] FolderError),
}

impl StudyError {
    pub(super) fn io(path: &Path, reason: io::Error) -> Self {
        Self::Io { path: path.to_path_buf(), reason }
    }

    pub(super) fn text(path: &Path, reason: impl ToString) -> Self {
        let reason = reason.to_string().trim().replace('\n', " ");
        Self::Text { path: path.to_path_buf(), reason }
    }
}

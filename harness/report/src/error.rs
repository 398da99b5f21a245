//! Reasons why a report cannot be written.

use std::io;
use std::path::{Path, PathBuf};

use formats::atomic::FolderError;
use formats::picture::PictureError;

use scoring::compare::CompareError;
use scoring::run::RunFileError;
use scoring::score::ScoreError;
use view::ViewError;

/// Reasons why a report cannot be written; each message is one line.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// A file or folder of the run cannot be read.
    #[error("{path}: cannot be read: {reason}")]
    Read {
        /// The file or folder.
        path: PathBuf,
        /// The operating system's error.
        reason: io::Error,
    },
    /// A file of the run is not what it should be.
    #[error("{path}: is not a valid file of a run: {reason}; run the suite again")]
    Json {
        /// The file.
        path: PathBuf,
        /// The parser's error.
        reason: String,
    },
    /// The run's manifest cannot be used.
    #[error(transparent)]
    Run(#[from] RunFileError),
    /// The scores of a method cannot be read.
    #[error(transparent)]
    Scores(#[from] ScoreError),
    /// The baseline cannot be made.
    #[error(transparent)]
    Baseline(#[from] CompareError),
    /// A picture of the run is broken, or one of the report cannot be written.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// Something of the report cannot be written.
    #[error("{path}: cannot be written: {reason}")]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// The operating system's error.
        reason: io::Error,
    },
    /// The viewer of the heads cannot be written.
    #[error(transparent)]
    View(#[from] ViewError),
    /// The report must not be written where it was to be.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// The user interrupted.
    #[error("interrupted; the same command makes the report anew")]
    Interrupted,
    /// A table's file has an unknown ending.
    #[error("{0}: cannot tell the format of the table from the name; end it in .md, .tex or .csv")]
    TableFormat(PathBuf),
    /// There is nothing to make a table of.
    #[error("{0}: nothing was scored yet; finish the run with `unshade run`")]
    NoScores(PathBuf),
    /// A figure is to be of what no run has.
    #[error("{what} {name:?}: not in {runs}; name one of {known}")]
    Unknown {
        /// `case` or `method`.
        what: &'static str,
        /// The name that was asked for.
        name: String,
        /// The runs' folders.
        runs: String,
        /// The names that there are.
        known: String,
    },
    /// The runs do not hold what a figure shows.
    #[error("{runs}: the figure needs {wanted}; there are {has}")]
    NoFigure {
        /// The runs' folders.
        runs: String,
        /// The data that the figure needs.
        wanted: String,
        /// The cases with their lights, and the methods.
        has: String,
    },
    /// A page could not be laid out.
    #[error("the report's page cannot be laid out: {0}")]
    Template(#[from] minijinja::Error),
}

impl ReportError {
    pub(super) fn read(path: &Path, reason: io::Error) -> Self {
        Self::Read { path: path.to_path_buf(), reason }
    }

    pub(super) fn write(path: &Path, reason: io::Error) -> Self {
        Self::Write { path: path.to_path_buf(), reason }
    }
}

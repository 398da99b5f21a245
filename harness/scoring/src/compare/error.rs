//! Reasons why a run cannot be compared.

use std::io;
use std::path::{Path, PathBuf};

use crate::metrics::MetricError;
use crate::run::RunFileError;
use crate::score::ScoreError;

/// An error of a comparison; each message is one line.
#[derive(Debug, thiserror::Error)]
pub enum CompareError {
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
    /// A baseline or a run without scores would pass whatever happens.
    #[error(
        "{0}: has no scores to compare; finish the run, or add a method whose results can be scored"
    )]
    Empty(PathBuf),
    /// A path does not name scores.
    #[error(
        "{0}: has no scores; name the folder of a finished run or its run.json, a baseline.json, or a file of \
         scores (unshade score writes one)"
    )]
    NotComparable(PathBuf),
    /// Pictures of what changed are made from a run's folder.
    #[error(
        "--pictures: {0} is not the folder of a run, which has the pictures; name the run's folder"
    )]
    NoPictures(PathBuf),
    /// A file of scores and the other side share nothing.
    #[error("{scores}: {clash}; compare the same method on the same capture")]
    NothingInCommon {
        /// The file of scores.
        scores: PathBuf,
        /// The contents of both sides, in words.
        clash: String,
    },
    /// Nothing of the two is the same.
    #[error(
        "the run is of the suite {run:?}, the baseline of {baseline:?}; compare with a baseline of the \
         run's suite (every report has one)"
    )]
    Suites {
        /// The run's suite.
        run: String,
        /// The baseline's.
        baseline: String,
    },
    /// Too few runs say nothing of a spread.
    #[error(
        "{runs} runs are too few to measure a spread; give at least {minimum} that differ in their seeds"
    )]
    FewRuns {
        /// The number of runs.
        runs: usize,
        /// The number that is needed.
        minimum: usize,
    },
    /// The spread on kept captures says nothing of others.
    #[error(
        "{case}: the run's capture is not the baseline's, and the tolerances were measured on captures \
         that are kept; keep them, or measure again with unshade calibrate --vary both"
    )]
    Captures {
        /// The case.
        case: String,
    },
    /// A branch has no baseline that can be found.
    #[error("--baseline-branch {branch}: {reason}")]
    Branch {
        /// As it was named.
        branch: String,
        /// The reason and the fix.
        reason: String,
    },
    /// A date that is none.
    #[error("--until {0}: is not a date; write YYYY-MM-DD")]
    Day(String),
    /// An acceptance of nothing.
    #[error("--accept {0}: no row that is worse or missing matches; * stands for any text")]
    NothingToAccept(String),
    /// A row has no tolerance.
    #[error("no rule of the tolerances matches {0}; add one, rows = \"*\" matches everything")]
    NoRule(String),
    /// A row's metric is not one of this version.
    #[error("{id}: {source}")]
    Metric {
        /// The row.
        id: String,
        /// The error of the metric.
        source: MetricError,
    },
    /// The run's manifest cannot be used.
    #[error(transparent)]
    Run(#[from] RunFileError),
    /// A scores file of the run is broken.
    #[error(transparent)]
    Scores(#[from] ScoreError),
    /// The verdicts cannot be written as XML.
    #[error("the JUnit file cannot be made: {0}")]
    Junit(#[from] quick_junit::SerializeError),
}

impl CompareError {
    /// An id as a message shows it: it may hold a line's end, a message is one line.
    pub(super) fn line(id: &str) -> String {
        id.replace(char::is_control, " ")
    }

    pub(super) fn io(path: &Path, reason: io::Error) -> Self {
        Self::Io { path: path.to_path_buf(), reason }
    }

    pub(super) fn text(path: &Path, reason: impl ToString) -> Self {
        let reason = reason.to_string().trim().replace('\n', " ");
        Self::Text { path: path.to_path_buf(), reason }
    }
}

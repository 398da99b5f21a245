//! Reasons why scores cannot be made.

use std::io;
use std::path::{Path, PathBuf};

use formats::atomic::FolderError;
use formats::picture::PictureError;

use crate::metrics::MetricError;

/// An error of scoring; each message is one line.
#[derive(Debug, thiserror::Error)]
pub enum ScoreError {
    /// The capture has neither a truth nor withheld photographs.
    #[error(
        "{0}: has no truth and no withheld photographs to score against; import it with --holdout, or \
         render one with `unshade synth`"
    )]
    NoTruth(PathBuf),
    /// A file that must be there is not.
    #[error("{path}: is missing; {fix}")]
    Missing {
        /// The file.
        path: PathBuf,
        /// The fix.
        fix: &'static str,
    },
    /// The maps folder has nothing to score.
    #[error(
        "{0}: has neither maps nor views to score; a solver leaves at least diffuse_albedo.exr"
    )]
    Nothing(PathBuf),
    /// A picture has another size than what it is compared with.
    #[error(
        "{path}: is {found_width}x{found_height}, expected {width}x{height}; write it in that size"
    )]
    Size {
        /// The file.
        path: PathBuf,
        /// The columns.
        found_width: usize,
        /// The rows.
        found_height: usize,
        /// Columns expected.
        width: usize,
        /// Rows expected.
        height: usize,
    },
    /// A folder must not be written where it was to be.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// A picture is broken.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// The capture is broken.
    #[error(transparent)]
    Capture(#[from] capture::CaptureError),
    /// The maps cannot be checked.
    #[error(transparent)]
    Check(#[from] crate::check::CheckError),
    /// A map is broken.
    #[error(transparent)]
    Maps(#[from] formats::MapsError),
    /// A metric cannot be computed.
    #[error("{subject}: {source}")]
    Metric {
        /// The subject, as in row ids.
        subject: String,
        /// The reason.
        source: MetricError,
    },
    /// A method relit in a light that the capture does not have.
    #[error(
        "{path}: is not a light of the capture; there are {known}, name the folder as one of them"
    )]
    Light {
        /// The folder.
        path: PathBuf,
        /// The lights that there are.
        known: String,
    },
    /// A run was interrupted, or is still running.
    #[error("{run}: is not finished, {file} is missing; the same `unshade run` resumes it")]
    Unfinished {
        /// The run's folder.
        run: PathBuf,
        /// The scores file below it.
        file: PathBuf,
    },
    /// A text file is not what it should be.
    #[error("{path}: cannot be understood: {reason}")]
    Text {
        /// The file.
        path: PathBuf,
        /// The parser's error.
        reason: String,
    },
    /// A file or folder cannot be read or written.
    #[error("{path}: {reason}")]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The operating system's error.
        reason: io::Error,
    },
}

impl ScoreError {
    pub(super) fn io(path: &Path, reason: io::Error) -> Self {
        Self::Io { path: path.to_path_buf(), reason }
    }

    pub(super) fn text(path: &Path, reason: impl ToString) -> Self {
        let reason = reason.to_string().trim().replace('\n', " ");
        Self::Text { path: path.to_path_buf(), reason }
    }

    /// Names the subject of a metric's error.
    pub(super) fn of(subject: &str) -> impl Fn(MetricError) -> Self {
        move |source| Self::Metric { subject: subject.to_owned(), source }
    }
}

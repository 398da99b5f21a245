//! Reasons why a page cannot be written.

use std::io;
use std::path::{Path, PathBuf};

use capture::CaptureError;
use formats::MapsError;
use formats::atomic::FolderError;
use formats::picture::PictureError;
use scoring::metrics::MetricError;

use crate::limits::MOST_METHODS;

/// Reasons why a page cannot be written; each message is one line.
#[derive(Debug, thiserror::Error)]
pub enum ViewError {
    /// The capture cannot be opened.
    #[error(transparent)]
    Capture(#[from] CaptureError),
    /// A maps folder cannot be read.
    #[error(transparent)]
    Maps(#[from] MapsError),
    /// A picture is faulty.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// The truth and a map cannot be compared.
    #[error("{path}: {reason}")]
    Compare {
        /// The maps' folder.
        path: PathBuf,
        /// The reason.
        reason: MetricError,
    },
    /// The page must not be written where it was to be.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// A folder cannot be listed.
    #[error("{path}: cannot be read: {reason}")]
    Read {
        /// The folder.
        path: PathBuf,
        /// The operating system's error.
        reason: io::Error,
    },
    /// A file of the page cannot be written.
    #[error("{path}: cannot be written: {reason}")]
    Write {
        /// The file.
        path: PathBuf,
        /// The operating system's error.
        reason: io::Error,
    },
    /// A folder holds nothing to be shown.
    #[error("{0}: has no diffuse_albedo.exr; name a folder of maps")]
    NoAlbedo(PathBuf),
    /// More methods than there are panes.
    #[error("{0} folders of maps are too many for one page; name at most {MOST_METHODS}")]
    TooMany(usize),
}

impl ViewError {
    pub(crate) fn write(path: &Path, reason: io::Error) -> Self {
        Self::Write { path: path.to_path_buf(), reason }
    }
}

//! Errors of a capture, each one line for the user: what is wrong, where, and the fix.

use std::path::PathBuf;

use formats::picture::PictureError;

/// A capture folder that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum CaptureError {
    /// A file is missing or unreadable.
    #[error("{path}: cannot be read: {reason}")]
    Read {
        /// The file.
        path: PathBuf,
        /// The operating system's error.
        reason: String,
    },
    /// `transforms.json` says something impossible.
    #[error("{path}: {reason}")]
    Transforms {
        /// The file.
        path: PathBuf,
        /// The fault and its fix.
        reason: String,
    },
    /// The mesh cannot carry textures.
    #[error("{path}: {reason}")]
    Mesh {
        /// The file.
        path: PathBuf,
        /// The fault and its fix.
        reason: String,
    },
    /// A mask or picture does not belong to its camera.
    #[error("{path}: {reason}")]
    Frame {
        /// The file.
        path: PathBuf,
        /// The fault and its fix.
        reason: String,
    },
    /// The mesh and the masks of the training views have no pixel in common.
    #[error(
        "{0}: no texel of the mesh is seen in any training view; check the camera matrices (camera \
         to world, looking down -z) and the masks"
    )]
    NothingVisible(PathBuf),
    /// The training views show the mesh without any light.
    #[error(
        "{0}: every training picture is black inside its mask; check their exposure and that the \
         masks belong to them"
    )]
    Black(PathBuf),
    /// The mesh is not where the cameras look.
    #[error(
        "{path}: the mesh covers {overlap:.2} of the masks (median of {views} views; .90 is \
         sound), so the cameras do not fit it; {fix}"
    )]
    Misplaced {
        /// `transforms.json`.
        path: PathBuf,
        /// Overlap of the mesh's silhouette with the masks, 0 to 1.
        overlap: f64,
        /// Views that were looked at.
        views: usize,
        /// The single change that fits, or the places to look at.
        fix: String,
    },
    /// A part of the truth cannot be read.
    #[error("{path}: {reason}")]
    Truth {
        /// The file or folder.
        path: PathBuf,
        /// The fault and its fix.
        reason: String,
    },
    /// A picture file is faulty.
    #[error(transparent)]
    Picture(#[from] PictureError),
}

//! Everything that can go wrong, each with one line for the user: what, where, and the mend.

use std::io;
use std::path::PathBuf;

use crate::atomic::FolderError;
use crate::memory::{Estimate, bytes};
use crate::picture::PictureError;

/// A capture folder that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum CaptureError {
    /// A file is missing or unreadable.
    #[error("{path}: cannot be read: {reason}")]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        reason: String,
    },
    /// `transforms.json` says something impossible.
    #[error("{path}: {reason}")]
    Transforms {
        /// The file.
        path: PathBuf,
        /// What is wrong, and the mend.
        reason: String,
    },
    /// The mesh cannot carry textures.
    #[error("{path}: {reason}")]
    Mesh {
        /// The file.
        path: PathBuf,
        /// What is wrong, and the mend.
        reason: String,
    },
    /// A mask or picture does not belong to its camera.
    #[error("{path}: {reason}")]
    Frame {
        /// The file.
        path: PathBuf,
        /// What is wrong, and the mend.
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
         sound), so the cameras do not fit it; {mend}"
    )]
    Misplaced {
        /// `transforms.json`.
        path: PathBuf,
        /// Overlap of the mesh's silhouette with the masks, 0 to 1.
        overlap: f64,
        /// Views that were looked at.
        views: usize,
        /// What single change fits, or where to look.
        mend: String,
    },
    /// A picture file is faulty.
    #[error(transparent)]
    Picture(#[from] PictureError),
}

/// A configuration that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum ConfigError {
    /// No preset has this name.
    #[error("no configuration is named {0:?}; the named ones are paper, unshade and fast")]
    UnknownPreset(String),
    /// The text is not TOML, has an unknown key, or a value of the wrong type.
    #[error("configuration: {0}")]
    Toml(String),
    /// A value is out of its range.
    #[error("configuration: {key} is {value}, but must be {range}")]
    Range {
        /// Dotted key.
        key: &'static str,
        /// What was given.
        value: String,
        /// What is allowed.
        range: &'static str,
    },
}

/// A maps folder that cannot be read or written.
#[derive(Debug, thiserror::Error)]
pub enum MapsError {
    /// The folder must not be written where it was to be.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// A file or the folder itself cannot be read or written.
    #[error("{path}: {source}")]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A picture file is faulty.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// A map is not square, or has another size than the others.
    #[error("{path}: {reason}")]
    Size {
        /// The file.
        path: PathBuf,
        /// What is wrong, and the mend.
        reason: String,
    },
}

/// A decomposition that did not come to its end.
#[derive(Debug, thiserror::Error)]
pub enum SolveError {
    /// The configuration is out of range.
    #[error(transparent)]
    Config(#[from] ConfigError),
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
    /// A step of a stage is told so when the progress callback asked to stop; a solve as a whole
    /// then ends with what it has.
    #[error("interrupted")]
    Interrupted,
    /// The machine has not the memory.
    #[error(
        "the solve needs {} of memory more ({estimate} in all), but {} are free; lower \
         fine_tuning.texture_size, take the pictures at half their size, or fewer views",
        bytes(*needed), bytes(*available)
    )]
    Memory {
        /// What was to be solved.
        estimate: Estimate,
        /// Bytes on top of what is taken already.
        needed: u64,
        /// Bytes that there are.
        available: u64,
    },
    /// The maps cannot be written.
    #[error(transparent)]
    Maps(#[from] MapsError),
}

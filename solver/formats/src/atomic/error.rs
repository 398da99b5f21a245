//! Errors of writing a folder.

use std::io;
use std::path::{Path, PathBuf};

/// Reasons why a folder cannot be written; each message is one line.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// The target holds something that unshade did not write.
    #[error(
        "{0}: exists and was not written by unshade, so it is not replaced; choose a new folder, or \
         remove it yourself"
    )]
    NotOurs(PathBuf),
    /// Somebody put a file into a folder of ours.
    #[error(
        "{folder}: holds {}, which unshade did not write, so the folder is not replaced; move it \
         away, or choose a new folder", file.display()
    )]
    Foreign {
        /// The folder.
        folder: PathBuf,
        /// The file, below the folder.
        file: PathBuf,
    },
    /// The target is where the user stands, or above.
    #[error("{0}: is the current folder or contains it; name another folder")]
    Current(PathBuf),
    /// The output would lie over an input.
    #[error(
        "{out}: {relation} the input {}, which would be overwritten; choose another folder",
        input.display()
    )]
    Input {
        /// The output.
        out: PathBuf,
        /// "is the same as", "contains" or "is inside".
        relation: &'static str,
        /// The input.
        input: PathBuf,
    },
    /// The disk has no room for what is to be written.
    #[error(
        "{path}: {needed} MB are needed there and {free} MB are free; make room, or choose another \
         folder"
    )]
    Space {
        /// The path.
        path: PathBuf,
        /// Megabytes that the output takes.
        needed: u64,
        /// Megabytes that there are.
        free: u64,
    },
    /// The system refuses.
    #[error("{path}: cannot be written: {reason}; make room or choose another folder")]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The operating system's error.
        reason: io::Error,
    },
}

impl FolderError {
    /// For `map_err`: names the place of a system's error.
    pub fn io(path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |reason| Self::Io { path: path.to_path_buf(), reason }
    }
}

//! Faults of picture files.

use std::path::PathBuf;

/// Faults of picture files.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// The file cannot be read or is not of its kind.
    #[error("{path}: cannot be read: {reason}")]
    Read {
        /// The file.
        path: PathBuf,
        /// The decoder's error.
        reason: String,
    },
    /// The file cannot be written.
    #[error("{path}: cannot be written: {reason}")]
    Write {
        /// The file.
        path: PathBuf,
        /// The encoder's error.
        reason: String,
    },
    /// A named channel is absent.
    #[error("{path}: has no channel {channel:?}; it has {present}")]
    MissingChannel {
        /// The file.
        path: PathBuf,
        /// The channel asked for.
        channel: String,
        /// The channels there are, comma separated.
        present: String,
    },
    /// The file is sound, but not what is meant here, or cannot be understood one way only.
    #[error("{path}: {reason}")]
    Refused {
        /// The file.
        path: PathBuf,
        /// The fault and its fix.
        reason: String,
    },
    /// A value is NaN or infinite.
    #[error("{path}: {value} at column {x}, row {y}, channel {channel}; fix or mask the pixel")]
    NotFinite {
        /// The file.
        path: PathBuf,
        /// NaN, inf or -inf.
        value: f32,
        /// Column from the left.
        x: usize,
        /// Row from the top.
        y: usize,
        /// Channel name.
        channel: String,
    },
}

//! What can be wrong with a picture file.

use std::path::PathBuf;

/// What can be wrong with a picture file.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// The file cannot be read or is not of its kind.
    #[error("{path}: cannot be read: {reason}")]
    Read {
        /// The file.
        path: PathBuf,
        /// What the decoder said.
        reason: String,
    },
    /// The file cannot be written.
    #[error("{path}: cannot be written: {reason}")]
    Write {
        /// The file.
        path: PathBuf,
        /// What the encoder said.
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
        /// What is wrong, and the mend.
        reason: String,
    },
    /// A value is NaN or infinite.
    #[error("{path}: {value} at column {x}, row {y}, channel {channel}; mend or mask the pixel")]
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

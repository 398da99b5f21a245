//! Sealed suites: what a secret makes (seeds, a signing key), and statements that it signs.

mod secret;
mod statement;

pub use secret::Secret;
pub use statement::{Statement, Verified, is_signed, verify, write_signed};

use std::io;
use std::path::{Path, PathBuf};

/// Faults of a secret or a signed folder; each message is one line.
#[derive(Debug, thiserror::Error)]
pub enum SealError {
    /// A file cannot be read or written.
    #[error("{path}: {reason}")]
    File {
        /// The file.
        path: PathBuf,
        /// The operating system's error.
        reason: io::Error,
    },
    /// The secret can be guessed.
    #[error(
        "{0}: a secret has 32 bytes or more, so that nobody guesses it; make one with \
         head -c 32 /dev/urandom > secret"
    )]
    Short(PathBuf),
    /// A file of a signed folder says something else than what such a file says.
    #[error("{path}: is no part of signed scores: {reason}")]
    Format {
        /// The file.
        path: PathBuf,
        /// The fault.
        reason: String,
    },
    /// Nobody signed the folder.
    #[error("{0}: is not signed; `unshade seal --score SUBMISSION` writes signed scores")]
    Unsigned(PathBuf),
    /// The signature is not that of the statement.
    #[error("{0}: the signature does not match; the statement was changed after it was signed")]
    Signature(PathBuf),
    /// Another key signed it.
    #[error(
        "{path}: is signed by {found}, not by {wanted}; trust the key of who sealed the suite alone"
    )]
    Key {
        /// The folder.
        path: PathBuf,
        /// Who signed.
        found: String,
        /// Who should have.
        wanted: String,
    },
    /// A file is not the one that was signed.
    #[error("{0}: is not the file that was signed; it was changed, or is missing")]
    Changed(PathBuf),
}

impl SealError {
    fn file(path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |reason| Self::File { path: path.to_path_buf(), reason }
    }

    fn format(path: &Path, reason: impl ToString) -> Self {
        Self::Format { path: path.to_path_buf(), reason: reason.to_string() }
    }
}

/// Bytes as lower-case hexadecimal digits.
fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn unhex<const N: usize>(text: &str) -> Option<[u8; N]> {
    let mut bytes = [0; N];
    if text.len() != 2 * N || !text.is_ascii() {
        return None;
    }
    for (at, byte) in bytes.iter_mut().enumerate() {
        *byte = u8::from_str_radix(text.get(2 * at..2 * at + 2)?, 16).ok()?;
    }
    Some(bytes)
}

//! What cannot be read.

/// What cannot be read, and where.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {reason}")]
pub struct ObjError {
    /// Line of the file, from 1.
    pub line: usize,
    /// What is wrong, and the mend.
    pub reason: String,
}

//! Faults of an OBJ file.

/// A fault of an OBJ file, with its line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {reason}")]
pub struct ObjError {
    /// Line of the file, from 1.
    pub line: usize,
    /// The fault and its fix.
    pub reason: String,
}

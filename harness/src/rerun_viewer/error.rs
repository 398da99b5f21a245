//! Why a solve is not shown.

/// A solve cannot be shown as it goes.
#[derive(Debug, thiserror::Error)]
#[error("--rerun: {0}")]
pub struct ViewerError(pub String);

//! A solve shown as it goes, where the Cargo feature `rerun` is on.

#[cfg(not(feature = "rerun"))]
mod absent;
mod error;
#[cfg(feature = "rerun")]
mod shown;

#[cfg(not(feature = "rerun"))]
pub use absent::RerunViewer;
pub use error::ViewerError;
#[cfg(feature = "rerun")]
pub use shown::RerunViewer;

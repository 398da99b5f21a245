//! The methods that are configured.

/// The method that a preset configures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Method {
    Unshade,
    Paper,
}

//! The two methods.

/// The method that a preset configures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Method {
    Unshade,
    Paper,
}

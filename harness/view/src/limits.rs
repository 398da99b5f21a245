//! Limits of a page.

/// Methods of a page, at most: one pane each beside the truth.
pub const MOST_METHODS: usize = 3;

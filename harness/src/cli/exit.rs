//! Exit codes.

pub(super) const DONE: u8 = 0;
pub(super) const CHECK_FAILED: u8 = 1;
pub(super) const BAD_INPUT: u8 = 2;
pub(super) const INTERRUPTED: u8 = 3;

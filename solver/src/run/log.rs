//! The log of a solve.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::solution::StageRecord;

/// Losses and times so far.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Log {
    /// Steps done.
    pub done: usize,
    /// Steps that turned out not to be needed.
    pub skipped: usize,
    pub stages: Vec<StageRecord>,
    pub seconds: Vec<(String, f64)>,
}

/// Where the caller stopped the solve.
#[derive(Clone, Debug)]
pub(super) struct Cut {
    pub stage: String,
    /// Steps of the stage that were done, of how many.
    pub step: usize,
    pub of: usize,
}

impl fmt::Display for Cut {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} at step {} of {}", self.stage, self.step, self.of)
    }
}

//! The log of a solve.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::solution::StageRecord;

/// The losses and times so far.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Log {
    /// The number of steps taken.
    pub done: usize,
    /// Planned steps that were not needed.
    pub skipped: usize,
    pub stages: Vec<StageRecord>,
    pub seconds: Vec<(String, f64)>,
}

/// The step at which the caller interrupted the solve.
#[derive(Clone, Debug)]
pub(super) struct Cut {
    pub stage: String,
    /// The finished steps of the stage, and their planned number.
    pub step: usize,
    pub of: usize,
}

impl fmt::Display for Cut {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} at step {} of {}", self.stage, self.step, self.of)
    }
}

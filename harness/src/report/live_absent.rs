//! Stands for `live.rs` where the Cargo feature `rerun` is off.

use capture::Capture;
use solver::{Progress, Solution};

use super::error::ReportError;

/// Where a solve is shown; there is none.
pub enum Live {}

impl Live {
    /// Says how to get it.
    pub fn open(_: &str, _: &Capture) -> Result<Self, ReportError> {
        let mend = "this program was built without the viewer; build it with \
                    `cargo build --release --features rerun`";
        Err(ReportError::Live(mend.to_owned()))
    }

    /// Not reached.
    pub fn step(&mut self, _: &Progress) {
        match *self {}
    }

    /// Not reached.
    pub fn solution(&self, _: &Solution) -> Result<(), ReportError> {
        match *self {}
    }
}

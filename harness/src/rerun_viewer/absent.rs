//! Stands for `shown.rs` where the Cargo feature `rerun` is off.

use capture::Capture;
use solver::{Progress, Solution};

use super::error::ViewerError;

/// Where a solve is shown; there is none.
pub enum RerunViewer {}

impl RerunViewer {
    /// Says how to get it.
    pub fn open(_: &str, _: &Capture) -> Result<Self, ViewerError> {
        let fix = "this program was built without the viewer; build it with \
                    `cargo build --release --features rerun`";
        Err(ViewerError(fix.to_owned()))
    }

    /// Not reached.
    pub fn step(&mut self, _: &Progress) {
        match *self {}
    }

    /// Not reached.
    pub fn solution(&self, _: &Solution) -> Result<(), ViewerError> {
        match *self {}
    }
}
